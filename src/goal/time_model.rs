//! What settings take on a device: what a few of them took there, and how all of them compare where all were measured.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::MeasuredFront;
use crate::plan::{LadderStep, Quality, Rung, Treatment};

/// Milliseconds of passes, by name.
pub type PassTimes = BTreeMap<String, f64>;

/// Steps that are measured on a device: two of each treatment, whose ratio says how its passes grow there.
pub const CALIBRATION_STEPS: [(Quality, Treatment); 4] = [
    (Quality::Low, Treatment::Harmonics),
    (Quality::Medium, Treatment::Harmonics),
    (Quality::Low, Treatment::SourceFunction),
    (Quality::Medium, Treatment::SourceFunction),
];

/// What pass times grow by may exceed what they grew by where the front was measured by this power at most, so that noise
/// in two short times is not carried to long ones.
const LARGEST_POWER: f64 = 1.5;

/// Times of a few steps on one device, for one scene.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Calibration {
    /// By the name of the step of the ladder.
    pub passes: BTreeMap<String, PassTimes>,
}

/// Of all passes, ms.
pub fn total_ms(passes: &PassTimes) -> f64 {
    passes.values().sum()
}

impl Calibration {
    /// Adds what a step took.
    pub fn add(&mut self, step: LadderStep, passes: PassTimes) {
        self.passes.insert(step.to_string(), passes);
    }

    /// What a step takes on the device, ms; none where its treatment was not measured there or nowhere at all.
    ///
    /// For each pass t = t_low · r^p, where r is how much longer than at `low` it took where the front was measured, and p
    /// the power by which `medium` is longer on this device: 1 where time goes as the work, less where a device has units
    /// to spare.
    pub fn predicted_ms(&self, front: &MeasuredFront, step: LadderStep) -> Option<f64> {
        let at = |quality| LadderStep { rung: Rung::of(quality), treatment: step.treatment }.to_string();
        let [low, medium] = [at(Quality::Low), at(Quality::Medium)];
        let (here_low, here_medium) = (self.passes.get(&low)?, self.passes.get(&medium)?);
        let there = |name: &str, pass: &str| front.passes.get(name).and_then(|times| times.get(pass)).copied();
        let name = step.to_string();
        front.passes.get(&name)?;
        let predicted = here_low.iter().map(|(pass, low_ms)| {
            let Some((there_low, there_step)) = there(&low, pass).zip(there(&name, pass)) else { return *low_ms };
            let ratio = |a: f64, b: f64| (a.max(f64::MIN_POSITIVE) / b.max(f64::MIN_POSITIVE)).max(1e-3);
            let medium_there = there(&medium, pass).map_or(1.0, |there_medium| ratio(there_medium, there_low)).ln();
            let medium_here = here_medium.get(pass).map_or(1.0, |medium_ms| ratio(*medium_ms, *low_ms)).ln();
            // Passes that do the same work at both say nothing of how they grow.
            let power = if medium_there > 0.2 { (medium_here / medium_there).clamp(0.0, LARGEST_POWER) } else { 1.0 };
            low_ms * ratio(there_step, there_low).powf(power)
        });
        Some(predicted.sum())
    }
}
