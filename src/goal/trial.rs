//! Whether choices keep what they promise, on scenes whose errors and times are known.

use super::error_model::{SAFETY, predicted_with};
use super::{Calibration, MeasuredFront, MeasuredScene};
use crate::plan::{LadderStep, Treatment};

/// How choices for one target fared.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetTrial {
    /// The error that was asked for.
    pub target: f64,
    /// Scenes in which some measured settings meet it.
    pub reachable: usize,
    /// Of all scenes, those for which settings were chosen.
    pub chosen: usize,
    /// Of these, those whose chosen settings meet the target.
    pub met: usize,
    /// Price of each choice over the cheapest that meets the target, where one does; ascending.
    pub price_ratios: Vec<f64>,
}

impl TargetTrial {
    /// Of scenes that the front does not hold; those that it does are left out of the front for their own turn.
    pub fn new(front: &MeasuredFront, scenes: &[MeasuredScene], target: f64) -> Self {
        Self::with_safety(front, scenes, target, SAFETY)
    }

    pub(super) fn with_safety(front: &MeasuredFront, scenes: &[MeasuredScene], target: f64, safety: f64) -> Self {
        let mut trial = Self { target, reachable: 0, chosen: 0, met: 0, price_ratios: Vec::new() };
        for scene in scenes {
            let mut others = front.clone();
            others.scenes.retain(|other| other.name != scene.name);
            trial.add(&others, scene, safety);
        }
        trial.price_ratios.sort_unstable_by(f64::total_cmp);
        trial
    }

    fn add(&mut self, front: &MeasuredFront, scene: &MeasuredScene, safety: f64) {
        let of = |values: &std::collections::BTreeMap<String, f64>, step: LadderStep| {
            values.get(&step.to_string()).copied().unwrap_or(f64::INFINITY)
        };
        let steps: Vec<_> = front.steps().into_iter().filter(|s| s.treatment != Treatment::IsotropicSeries).collect();
        let cheapest = |fits: &dyn Fn(LadderStep) -> bool, price: &dyn Fn(LadderStep) -> f64| {
            let fitting = steps.iter().copied().filter(|step| fits(*step));
            fitting.min_by(|a, b| price(*a).total_cmp(&price(*b)))
        };
        let paid = |step| of(&scene.milliseconds, step);
        let meets = |step| of(&scene.errors, step) <= self.target;
        let predicted = |step| predicted_with(front, &scene.traits, step, safety).is_some_and(|e| e <= self.target);
        let best = cheapest(&meets, &paid);
        self.reachable += usize::from(best.is_some());
        let Some(choice) = cheapest(&predicted, &|step| front.milliseconds(scene.traits.kind, step)) else { return };
        self.chosen += 1;
        self.met += usize::from(meets(choice));
        self.price_ratios.extend(best.map(|best| paid(choice) / paid(best)));
    }
}

/// Predicted over measured time of every step but those that the prediction starts from, as if each scene's own times at
/// [`super::CALIBRATION_STEPS`] had been measured on the device; ascending. `calibrations` belong to `scenes`.
pub fn time_ratios(front: &MeasuredFront, scenes: &[MeasuredScene], calibrations: &[Calibration]) -> Vec<f64> {
    let mut ratios = Vec::new();
    for (scene, calibration) in scenes.iter().zip(calibrations) {
        for step in front.steps() {
            let name = step.to_string();
            let known = calibration.passes.contains_key(&name);
            if let (false, Some(measured)) = (known, scene.milliseconds.get(&name)) {
                ratios.extend(calibration.predicted_ms(front, step).map(|predicted| predicted / measured));
            }
        }
    }
    ratios.sort_unstable_by(f64::total_cmp);
    ratios
}
