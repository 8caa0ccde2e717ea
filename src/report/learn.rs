//! What choices are made from later, out of a study.

use std::collections::BTreeMap;

use super::results::{Family, Point, Provenance, SceneResults, Study};
use crate::goal::{MeasuredFront, MeasuredScene, PassTimes};

/// The steps of the ladder of a study: the random scenes' errors and times, and of the other scenes those of kinds that no
/// random scene is of.
///
/// An error is one standard error above what was measured: where the truth is not known better, settings are not taken to
/// be. Passes' times are medians over scenes.
pub fn learn(study: &Study) -> MeasuredFront {
    let random = |scene: &SceneResults| study.scenes.iter().any(|other| other.random && same_kind(scene, other));
    let scenes: Vec<&SceneResults> = study.scenes.iter().filter(|scene| scene.random || !random(scene)).collect();
    let mut passes: BTreeMap<String, BTreeMap<String, Vec<f64>>> = BTreeMap::new();
    for point in scenes.iter().flat_map(|scene| steps(scene)) {
        for (pass, spread) in &point.passes {
            passes.entry(point.name.clone()).or_default().entry(pass.clone()).or_default().push(spread.median);
        }
    }
    MeasuredFront {
        provenance: provenance(&study.provenance),
        passes: passes.into_iter().map(|(step, passes)| (step, medians(passes))).collect(),
        scenes: scenes.into_iter().map(measured).collect(),
    }
}

fn same_kind(a: &SceneResults, b: &SceneResults) -> bool {
    a.traits.kind == b.traits.kind
}

/// The points that are steps of the ladder.
pub(super) fn steps(scene: &SceneResults) -> impl Iterator<Item = &Point> {
    scene.points.iter().filter(|point| point.family == Family::Ladder)
}

/// A scene as choices know it.
pub(super) fn measured(scene: &SceneResults) -> MeasuredScene {
    let by_name = |of: &dyn Fn(&Point) -> f64| steps(scene).map(|point| (point.name.clone(), of(point))).collect();
    MeasuredScene {
        name: scene.scene.clone(),
        traits: scene.traits,
        errors: by_name(&|point| four_digits(point.error.high)),
        least_errors: by_name(&|point| four_digits(point.error.low)),
        best_estimates: by_name(&|point| four_digits(point.error.rms)),
        milliseconds: by_name(&|point| four_digits(point.milliseconds.median)),
    }
}

fn medians(passes: BTreeMap<String, Vec<f64>>) -> PassTimes {
    let median = |mut times: Vec<f64>| {
        times.sort_unstable_by(f64::total_cmp);
        four_digits(times[times.len() / 2])
    };
    passes.into_iter().map(|(pass, times)| (pass, median(times))).collect()
}

/// More would only make the file longer.
fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

fn provenance(of: &Provenance) -> String {
    let Provenance { version, commit, device, driver, machine, load } = of;
    format!("welkin {version} ({commit}) on {device}, {driver}; {machine}. {load}")
}
