//! What was measured, in the form that choices are made from.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::PassTimes;
use crate::plan::{LadderStep, SceneKind, SceneTraits};

/// Errors of settings on scenes, and what settings take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredFront {
    /// Where and by which commit it was measured, in words.
    pub provenance: String,
    /// Milliseconds of each pass, by the name of the step of the ladder: a first picture with all of its tables, median over
    /// the scenes in which the pass ran.
    pub passes: BTreeMap<String, PassTimes>,
    /// Scene by scene.
    pub scenes: Vec<MeasuredScene>,
}

/// Errors on one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredScene {
    /// Its name.
    pub name: String,
    /// What decides about its errors.
    pub traits: SceneTraits,
    /// By the name of the step of the ladder: root mean square of the relative error, one standard error of the truth above what was
    /// measured.
    pub errors: BTreeMap<String, f64>,
    /// The same, one standard error below.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub least_errors: BTreeMap<String, f64>,
    /// The same, as measured; only a report knows it.
    #[serde(skip)]
    pub best_estimates: BTreeMap<String, f64>,
    /// By the name of the step of the ladder: all passes of a first picture, ms.
    pub milliseconds: BTreeMap<String, f64>,
}

impl MeasuredFront {
    /// What the program was built with.
    pub fn built_in() -> &'static Self {
        static FRONT: OnceLock<MeasuredFront> = OnceLock::new();
        // A test reads it, so that a program with a broken one is never built.
        FRONT.get_or_init(|| {
            serde_json::from_str(include_str!("measured_front.json")).unwrap_or_else(|_| MeasuredFront {
                provenance: String::new(),
                passes: BTreeMap::new(),
                scenes: Vec::new(),
            })
        })
    }

    /// The steps of the ladder that were measured.
    pub fn steps(&self) -> Vec<LadderStep> {
        self.passes.keys().filter_map(|name| LadderStep::from_name(name)).collect()
    }

    /// What a step took where it was measured, ms: the median over scenes of a kind; infinite where there are none.
    pub fn milliseconds(&self, kind: SceneKind, step: LadderStep) -> f64 {
        let name = step.to_string();
        let of_kind = self.scenes.iter().filter(|scene| scene.traits.kind == kind);
        let mut all: Vec<f64> = of_kind.filter_map(|scene| scene.milliseconds.get(&name).copied()).collect();
        all.sort_unstable_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(f64::INFINITY)
    }
}
