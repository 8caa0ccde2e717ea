//! Whether settings that are chosen for an error or a time keep their promise, on the random scenes of a study.

use std::fmt::Write as _;

use super::learn::{self, steps};
use super::results::{SceneResults, Study};
use crate::goal::{CALIBRATION_STEPS, Calibration, MeasuredFront, MeasuredScene, TargetTrial, time_ratios};
use crate::plan::{LadderStep, Rung};

/// The errors that are asked for.
const TARGETS: [f64; 5] = [0.005, 0.01, 0.02, 0.05, 0.1];
/// What a choice may cost beside the cheapest settings that would have done.
const FRUGAL: f64 = 1.5;
/// How far a predicted time may be off.
const NEAR: f64 = 0.2;

/// A section of Markdown; nothing where no random scene was measured. Choices are made from what the program was built
/// with; a scene that it knows already is left out of that for its own turn.
pub fn goal_tables(study: &Study) -> String {
    let random: Vec<&SceneResults> = study.scenes.iter().filter(|scene| scene.random).collect();
    let scenes: Vec<MeasuredScene> = random.iter().map(|scene| learn::measured(scene)).collect();
    let front = MeasuredFront::built_in();
    if scenes.is_empty() || front.scenes.is_empty() {
        return String::new();
    }
    let new = scenes.iter().filter(|scene| front.scenes.iter().all(|known| known.name != scene.name)).count();
    let mut text = format!(
        "\n## Settings for an error\n\n`--target-error` on {} random scenes, {new} of them unknown to the model. *Met*: the \
         error of the chosen settings, a standard error of the truth included, is within the target. *Price*: time over \
         that of the cheapest settings that would have met it.\n\n\
         | target % | reachable | chosen | met | price: median | at most {FRUGAL} | most |\n|---|---|---|---|---|---|---|\n",
        scenes.len()
    );
    for trial in TARGETS.map(|target| TargetTrial::new(front, &scenes, target)) {
        let ratios = &trial.price_ratios;
        let frugal = ratios.iter().filter(|ratio| **ratio <= FRUGAL).count();
        let at = |share: f64| ratios.get((share * ratios.len().saturating_sub(1) as f64).round() as usize);
        let number = |ratio: Option<&f64>| ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.2}"));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {frugal} | {} |",
            100.0 * trial.target,
            trial.reachable,
            trial.chosen,
            trial.met,
            number(at(0.5)),
            number(at(1.0)),
        );
    }
    let calibrations: Vec<Calibration> = random.iter().map(|scene| calibration(scene)).collect();
    let ratios = time_ratios(front, &scenes, &calibrations);
    let near = ratios.iter().filter(|ratio| (*ratio - 1.0).abs() <= NEAR).count();
    let _ = writeln!(
        text,
        "\nTimes of {} pictures, predicted from what {} others of the same scene took: {near} are within {} %; predicted \
         over measured is {} at the tenth part, {} in the median and {} at the nine tenths.",
        ratios.len(),
        CALIBRATION_STEPS.len(),
        100.0 * NEAR,
        quantile(&ratios, 0.1),
        quantile(&ratios, 0.5),
        quantile(&ratios, 0.9),
    );
    text
}

fn quantile(sorted: &[f64], share: f64) -> String {
    let place = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
    sorted.get(place).map_or("-".to_owned(), |ratio| format!("{ratio:.2}"))
}

/// What a device would be measured by, had it this scene to render.
fn calibration(scene: &SceneResults) -> Calibration {
    let mut calibration = Calibration::default();
    for (quality, treatment) in CALIBRATION_STEPS {
        let step = LadderStep { rung: Rung::of(quality), treatment };
        if let Some(point) = steps(scene).find(|point| point.name == step.to_string()) {
            calibration.add(step, point.passes.iter().map(|(pass, time)| (pass.clone(), time.median)).collect());
        }
    }
    calibration
}
