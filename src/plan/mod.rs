//! What a scene calls for: a pure function from facts and history to a [`Plan`]. Knows nothing of Vulkan.

mod bake;
mod cloud_settings;
mod declaration;
mod disc;
mod facts;
mod faint;
mod ladder;
mod multiple_scattering;
mod scene_traits;
mod sequence;
mod settings;
mod skipping;
mod volume_settings;

use std::collections::BTreeMap;

pub use bake::bake_settings;
pub use cloud_settings::{CloudScattering, CloudSettings};
pub use declaration::{Declaration, Fingerprint, Need};
pub use facts::{ConstituentGroups, Facts, Outputs, SpectralPart, Surface, Viewpoint};
pub use ladder::{LadderStep, Rung};
pub use multiple_scattering::{MultipleScattering, Treatment, error_in_shadow, expected_ringing};
pub use scene_traits::{SceneKind, SceneTraits};
pub use sequence::{Moment, Sequence, follows, pixel_of_block};
use serde::Serialize;
pub use settings::{Directions, Quality, Settings, SourceGrid, TableFormat};
pub use skipping::Skipping;
pub use volume_settings::VolumeSettings;

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
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedPass {
    /// The stem of its files.
    pub name: &'static str,
    /// What becomes of it.
    pub decision: Decision,
    /// Why, in words and numbers.
    pub reason: String,
    /// Bytes that its results occupy; 0 when skipped.
    pub bytes: u64,
    fingerprint: Option<Fingerprint>,
}

/// All passes in order.
#[derive(Debug, Clone, PartialEq, Eq)]
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

    /// Remembers what a plan's passes have computed.
    pub fn record(&mut self, plan: &Plan) {
        for pass in &plan.passes {
            match pass.fingerprint {
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
        let mut passes = Vec::with_capacity(declarations.len());
        for declaration in declarations {
            let pass = match (declaration.need)(facts) {
                Need::NotNeeded(reason) => skipped(declaration, reason),
                Need::Needed(reason) => {
                    let read: Vec<_> = declaration.reads.iter().map(|name| written.get(name)).collect();
                    let fingerprint = Fingerprint::of(&((declaration.inputs)(facts), read));
                    written.extend(declaration.writes.iter().map(|name| (*name, fingerprint)));
                    needed(declaration, facts, history, reason, fingerprint)
                }
            };
            passes.push(pass);
        }
        Self { passes }
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
    history: &History,
    reason: String,
    fingerprint: Fingerprint,
) -> PlannedPass {
    let (decision, reason) = match history.results.get(declaration.name) {
        Some(before) if *before == fingerprint => {
            (Decision::Reuse, "nothing that it depends on has changed".to_owned())
        }
        _ => (Decision::Run, reason),
    };
    let bytes = (declaration.bytes)(facts);
    PlannedPass { name: declaration.name, decision, reason, bytes, fingerprint: Some(fingerprint) }
}
