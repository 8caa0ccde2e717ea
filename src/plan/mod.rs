//! What a scene calls for: a pure function from facts and history to a [`Plan`]. Knows nothing of Vulkan.

mod bake;
mod cloud_settings;
mod constituent_groups;
mod declaration;
mod disc;
mod facts;
mod faint;
mod froxel_grid;
mod ladder;
mod lag;
mod lattice;
mod lights;
mod multiple_scattering;
mod named_settings;
mod scene_traits;
mod seen_volumes;
mod sequence;
mod settings;
mod skipping;
mod thick;
mod thin;
mod view;
mod volume_settings;

use std::collections::BTreeMap;

pub use bake::bake_settings;
pub use cloud_settings::{CloudScattering, CloudSettings};
pub use constituent_groups::ConstituentGroups;
pub use declaration::{Declaration, Fingerprint, Need};
pub use facts::{Facts, Outputs, SpectralPart, Surface, Viewpoint};
pub use froxel_grid::FroxelGrid;
pub use ladder::{LadderStep, Rung, UnknownRung};
pub use lag::elevation_slack_rad;
pub use lattice::{lattice_cell, media_cell, media_froxels};
pub use multiple_scattering::{MultipleScattering, Treatment, error_in_shadow, expected_ringing};
pub use named_settings::NamedSettings;
pub use scene_traits::{SceneKind, SceneTraits};
pub use sequence::{Moment, Sequence, follows, light_in_clouds_moved, pixel_of_block};
use serde::Serialize;
pub use settings::{Directions, Quadrature, Quality, Settings, TableFormat, UnknownQuality};
pub use skipping::Skipping;
pub use view::{OutOfView, SeenAltitudes};
pub use volume_settings::VolumeSettings;
pub use welkin_lut::bake::SourceGrid;

/// Why a scene cannot be planned.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// The real-time renderer cannot do it, the reference can.
    #[error("{what}, which the gpu backend cannot render yet; use --backend reference")]
    Unsupported {
        /// What the scene asks for.
        what: String,
    },
}

/// What becomes of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Decision {
    /// It is computed.
    Run,
    /// What it computed before still holds.
    Reuse,
    /// The picture is the same without it.
    Skip,
}

/// A pass with its decision.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPass {
    /// The stem of its files.
    pub name: &'static str,
    /// What becomes of it.
    pub decision: Decision,
    /// Why, in words and numbers.
    pub reason: String,
    /// Bytes that its results occupy; 0 when skipped.
    pub bytes: u64,
    /// Of its results; none where it is skipped and has freed them.
    fingerprint: Option<Fingerprint>,
}

/// All passes in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// In the order in which they run.
    pub passes: Vec<PlannedPass>,
}

/// What has been computed so far, and from what.
#[derive(Debug, Clone, Default)]
pub struct History {
    results: BTreeMap<&'static str, Fingerprint>,
}

impl History {
    /// A pass's result was overwritten.
    pub fn forget(&mut self, pass: &str) {
        self.results.remove(pass);
    }

    /// Results of these passes are being overwritten: until the plan is recorded they are nothing.
    pub fn begin(&mut self, plan: &Plan) {
        let running = plan.passes.iter().filter(|pass| pass.decision != Decision::Reuse);
        running.for_each(|pass| self.forget(pass.name));
    }

    /// The result that is refreshed before it must be: the one that lags most, once it lags by half of what it may, and
    /// only in a frame in which none must be. So results that lag behind the same light are computed in different frames.
    fn next_to_refresh(&self, facts: &Facts, declarations: &[Declaration]) -> Option<&'static str> {
        let lag = |declaration: &Declaration| {
            let before = self.results.get(declaration.name)?;
            Some((declaration.name, before.lag_of_values(&(declaration.inputs)(facts))?))
        };
        let lags: Vec<_> = declarations.iter().filter_map(lag).collect();
        if lags.iter().any(|(_, lag)| *lag > 1.0) {
            return None;
        }
        let most = lags.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        (most.1 > 0.5).then_some(most.0)
    }

    /// Remembers what a plan's passes have computed.
    pub fn record(&mut self, plan: &Plan) {
        for pass in &plan.passes {
            match pass.fingerprint.clone() {
                Some(fingerprint) => self.results.insert(pass.name, fingerprint),
                // A skipped pass has freed its results.
                None => self.results.remove(pass.name),
            };
        }
    }
}

impl Plan {
    /// The plans of a scene's groups of wavelengths as one. A pass runs where it runs for any group; the groups share the
    /// bytes of the passes named, and each has its own of the others.
    pub fn of_groups(plans: &[Self], shared: &[&str]) -> Self {
        let mut passes = plans.last().map(|plan| plan.passes.clone()).unwrap_or_default();
        for pass in &mut passes {
            let same = |plan: &Self| plan.passes.iter().find(|other| other.name == pass.name).cloned();
            let all: Vec<_> = plans.iter().filter_map(same).collect();
            if let Some(running) = all.iter().find(|other| other.decision == Decision::Run) {
                (pass.decision, pass.reason) = (Decision::Run, running.reason.clone());
            }
            let own = !shared.contains(&pass.name);
            pass.bytes = if own { all.iter().map(|other| other.bytes).sum() } else { pass.bytes };
        }
        Self { passes }
    }

    /// Decides for each declared pass, in order, whether it runs.
    pub fn new(facts: &Facts, history: &History, declarations: &[Declaration]) -> Self {
        let mut written: BTreeMap<&str, Fingerprint> = BTreeMap::new();
        let refreshed = history.next_to_refresh(facts, declarations);
        let mut passes = Vec::with_capacity(declarations.len());
        for declaration in declarations {
            let pass = match (declaration.need)(facts) {
                Need::NotNeeded(reason) => skipped(declaration, reason),
                Need::Needed(reason) => {
                    let read: Vec<_> = declaration.reads.iter().map(|name| written.get(name)).collect();
                    let fingerprint = (declaration.inputs)(facts).reading(&read);
                    let before = history.results.get(declaration.name).filter(|_| refreshed != Some(declaration.name));
                    let pass = needed(declaration, facts, before, reason, fingerprint);
                    let result = pass.fingerprint.iter().cloned();
                    written
                        .extend(result.flat_map(|of| declaration.writes.iter().map(move |name| (*name, of.clone()))));
                    pass
                }
            };
            passes.push(pass);
        }
        if facts.out_of_view.is_any() {
            let untouched =
                |declaration: &Declaration| !declaration.writes.iter().any(|name| written.contains_key(name));
            let skipped = |pass: &PlannedPass| pass.decision == Decision::Skip;
            for (pass, _) in passes.iter_mut().zip(declarations).filter(|(pass, of)| skipped(pass) && untouched(of)) {
                pass.fingerprint = history.results.get(pass.name).cloned();
            }
        }
        Self { passes }
    }

    /// Whether a skipped pass keeps its results, as the next picture may show what this one does not.
    pub fn keeps(&self, name: &str) -> bool {
        let kept = |pass: &&PlannedPass| pass.decision == Decision::Skip && pass.fingerprint.is_some();
        self.passes.iter().filter(kept).any(|pass| pass.name == name)
    }

    /// The decision about a pass, if it is part of the plan.
    pub fn decision(&self, name: &str) -> Option<Decision> {
        self.passes.iter().find(|pass| pass.name == name).map(|pass| pass.decision)
    }
}

fn skipped(declaration: &Declaration, reason: String) -> PlannedPass {
    PlannedPass { name: declaration.name, decision: Decision::Skip, reason, bytes: 0, fingerprint: None }
}

fn needed(
    declaration: &Declaration,
    facts: &Facts,
    before: Option<&Fingerprint>,
    reason: String,
    fingerprint: Fingerprint,
) -> PlannedPass {
    let lag = before.and_then(|before| before.lag_behind(&fingerprint));
    let (decision, reason, fingerprint) = match (lag, before) {
        (Some(0.0), Some(before)) => {
            (Decision::Reuse, "nothing that it depends on has changed".to_owned(), before.clone())
        }
        (Some(lag), Some(before)) if lag <= 1.0 => {
            let reason = format!("it lags behind the light by {:.0} % of what does not show", 100.0 * lag);
            (Decision::Reuse, reason, before.clone())
        }
        _ => (Decision::Run, reason, fingerprint),
    };
    let bytes = (declaration.bytes)(facts);
    PlannedPass { name: declaration.name, decision, reason, bytes, fingerprint: Some(fingerprint) }
}
