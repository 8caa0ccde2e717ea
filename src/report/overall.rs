//! One line for each settings over all scenes: whether a preset is worth its time on the whole.

use std::collections::BTreeMap;

use super::results::{Family, SceneResults};
use crate::plan::{Quality, SceneKind};

/// Settings over many scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct Overall {
    /// Their name; a preset's own, whatever treatment it chose.
    pub name: String,
    /// Whether they are a preset.
    pub is_preset: bool,
    /// Geometric mean of errors. Errors below 0.05 % count as that.
    pub error: f64,
    /// Geometric mean of times, ms.
    pub milliseconds: f64,
    /// What is faster and more accurate on the whole.
    pub dominated_by: Option<String>,
}

/// Errors that are smaller than this cannot be told apart by the truths.
const SMALLEST: f64 = 5e-4;

/// What was measured on every scene of clear air or terrain (`clouds` false) or among clouds.
pub fn overall(scenes: &[SceneResults], clouds: bool) -> Vec<Overall> {
    let those: Vec<_> = scenes.iter().filter(|scene| (scene.traits.kind == SceneKind::Clouds) == clouds).collect();
    let mut sums: BTreeMap<String, (f64, f64, usize)> = BTreeMap::new();
    for scene in &those {
        for point in scene.points.iter().filter(|point| point.family == Family::Ladder) {
            let logs = (point.error.rms.max(SMALLEST).ln(), point.milliseconds.median.max(1e-6).ln());
            for name in [Some(&point.name), point.preset.as_ref()].into_iter().flatten() {
                let sum = sums.entry(name.clone()).or_default();
                *sum = (sum.0 + logs.0, sum.1 + logs.1, sum.2 + 1);
            }
        }
    }
    let everywhere = sums.into_iter().filter(|(_, (_, _, count))| *count == those.len());
    let mut all: Vec<Overall> = everywhere
        .map(|(name, (error, time, count))| Overall {
            is_preset: name.parse::<Quality>().is_ok(),
            name,
            error: (error / count as f64).exp(),
            milliseconds: (time / count as f64).exp(),
            dominated_by: None,
        })
        .collect();
    all.sort_by(|a, b| a.milliseconds.total_cmp(&b.milliseconds));
    let marks: Vec<_> = all.iter().map(|row| better(&all, row)).collect();
    all.iter_mut().zip(marks).for_each(|(row, mark)| row.dominated_by = mark);
    all
}

fn better(all: &[Overall], row: &Overall) -> Option<String> {
    let beats = |other: &&Overall| other.milliseconds < row.milliseconds && other.error < row.error;
    all.iter().filter(beats).min_by(|a, b| a.error.total_cmp(&b.error)).map(|other| other.name.clone())
}
