//! Whether choices keep what they promise, on scenes whose errors and times are known.

use std::collections::BTreeMap;

use super::error_model::{SAFETY, predicted_with};
use super::{Calibration, Choice, MeasuredFront, MeasuredScene};
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
    /// Of these, those whose chosen settings meet the target, the truth's standard error included.
    pub met: usize,
    /// Of these, those whose chosen settings meet it as measured.
    pub met_as_measured: usize,
    /// Of these, those whose chosen settings miss it by more than the truth's standard error.
    pub missed: usize,
    /// Price of each choice over the cheapest that meets the target, where one does; ascending.
    pub price_ratios: Vec<f64>,
}

impl TargetTrial {
    /// Of settings that are predicted from scenes like each. A scene that the front holds is left out of it for its own turn.
    pub fn of_predictions(front: &MeasuredFront, scenes: &[MeasuredScene], target: f64) -> Self {
        Self::with_safety(front, scenes, target, SAFETY)
    }

    pub(super) fn with_safety(front: &MeasuredFront, scenes: &[MeasuredScene], target: f64, safety: f64) -> Self {
        Self::of(scenes, target, |scene| {
            let mut others = front.clone();
            others.scenes.retain(|other| other.name != scene.name);
            let traits = &scene.traits;
            let predicted = |step| predicted_with(&others, traits, step, safety).is_some_and(|e| e <= target);
            let fitting = worth_choosing(scene).filter(|step| predicted(*step));
            let price = |step: &LadderStep| others.milliseconds(traits.kind, *step);
            fitting.min_by(|a, b| price(a).total_cmp(&price(b)))
        })
    }

    /// Of settings that something else chooses for each scene.
    pub fn of_choices(
        scenes: &[MeasuredScene],
        target: f64,
        choose: impl Fn(&MeasuredScene) -> Option<Choice>,
    ) -> Self {
        Self::of(scenes, target, |scene| choose(scene).map(|choice| choice.step))
    }

    fn of(scenes: &[MeasuredScene], target: f64, choose: impl Fn(&MeasuredScene) -> Option<LadderStep>) -> Self {
        let mut trial =
            Self { target, reachable: 0, chosen: 0, met: 0, met_as_measured: 0, missed: 0, price_ratios: Vec::new() };
        for scene in scenes {
            trial.add(scene, choose(scene));
        }
        trial.price_ratios.sort_unstable_by(f64::total_cmp);
        trial
    }

    fn add(&mut self, scene: &MeasuredScene, choice: Option<LadderStep>) {
        let of = |values: &BTreeMap<String, f64>, step: LadderStep| {
            values.get(&step.to_string()).copied().unwrap_or(f64::INFINITY)
        };
        let paid = |step: &LadderStep| of(&scene.milliseconds, *step);
        let meets = |step: &LadderStep| of(&scene.errors, *step) <= self.target;
        let best = worth_choosing(scene).filter(meets).min_by(|a, b| paid(a).total_cmp(&paid(b)));
        self.reachable += usize::from(best.is_some());
        let Some(choice) = choice else { return };
        self.chosen += 1;
        self.met += usize::from(meets(&choice));
        self.met_as_measured += usize::from(of(&scene.best_estimates, choice) <= self.target);
        self.missed += usize::from(of(&scene.least_errors, choice) > self.target);
        self.price_ratios.extend(best.map(|best| paid(&choice) / paid(&best)));
    }
}

/// The steps that were measured on a scene, but those that nobody should choose.
fn worth_choosing(scene: &MeasuredScene) -> impl Iterator<Item = LadderStep> + '_ {
    let measured = scene.errors.keys().filter_map(|name| LadderStep::from_name(name));
    measured.filter(|step| step.treatment != Treatment::IsotropicSeries)
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
