//! What error settings have on a scene that was not measured: that on scenes like it.

use super::MeasuredFront;
use crate::plan::{LadderStep, SceneTraits};

/// Within this distance ([`SceneTraits::distance`]) scenes tell much of each other, beyond twice of it hardly anything.
const KINSHIP: f64 = 0.5;

/// How many standard deviations of ln(error) among scenes that are alike a prediction lies above their mean. The least with
/// which 95 % of choices among the built-in scenes keep their target when the scene itself is left out; where errors are
/// spread normally 1.65 would do, but a few neighbours do not show their whole spread.
pub(super) const SAFETY: f64 = 2.0;

/// Least standard deviation of ln(error): a single neighbour would show none.
const LEAST_SPREAD: f64 = 0.15;

/// An error that settings hardly ever exceed on scenes like this one; none where no scene of its kind was measured with
/// them.
///
/// The mean of ln(error) over the measured scenes, each weighted by a Gauss curve of its distance, and above it
/// twice their weighted standard deviation.
pub fn predicted_error(front: &MeasuredFront, scene: &SceneTraits, step: LadderStep) -> Option<f64> {
    predicted_with(front, scene, step, SAFETY)
}

/// The same with another number of standard deviations.
pub(super) fn predicted_with(front: &MeasuredFront, scene: &SceneTraits, step: LadderStep, safety: f64) -> Option<f64> {
    let name = step.to_string();
    let measured = front.scenes.iter().filter_map(|other| {
        let distance = scene.distance(&other.traits)?;
        Some((distance, other.errors.get(&name)?.max(f64::MIN_POSITIVE).ln()))
    });
    let measured: Vec<(f64, f64)> = measured.collect();
    // Weights relative to the nearest scene's, so that far from all of them some are left.
    let nearest = measured.iter().map(|(distance, _)| *distance).fold(f64::INFINITY, f64::min);
    let weight = |distance: f64| (0.5 * (nearest * nearest - distance * distance) / (KINSHIP * KINSHIP)).exp();
    let total: f64 = measured.iter().map(|(distance, _)| weight(*distance)).sum();
    if measured.is_empty() {
        return None;
    }
    let mean = measured.iter().map(|(distance, log)| weight(*distance) * log).sum::<f64>() / total;
    let variance = measured.iter().map(|(distance, log)| weight(*distance) * (log - mean).powi(2)).sum::<f64>() / total;
    Some((mean + safety * variance.sqrt().max(LEAST_SPREAD)).exp())
}
