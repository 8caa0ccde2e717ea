//! One line for each settings over all scenes: whether a preset is worth its time on the whole.

use std::collections::BTreeMap;

use super::results::{Family, SceneResults, Study};
use crate::plan::{Quality, SceneKind};

/// Settings over many scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct Overall {
    /// Their name; a preset's own, whatever treatment it chose.
    pub name: String,
    /// Whether they are a preset.
    pub is_preset: bool,
    /// Whether they are a preset's but for one group.
    pub is_variation: bool,
    /// Geometric mean of errors. Errors below 0.05 % count as that.
    pub error: f64,
    /// Geometric mean of times, ms.
    pub milliseconds: f64,
    /// What is faster and more accurate on the whole.
    pub dominated_by: Option<String>,
}

/// Errors that are smaller than this cannot be told apart by the truths.
const SMALLEST: f64 = 5e-4;

/// Settings over all scenes, by what a table of them is called: steps and presets, then what differs from a preset in one group.
/// Tables without rows are left out; *faster and more accurate* is of all rows of both.
pub fn tables(study: &Study) -> Vec<(String, Vec<Overall>)> {
    let mut tables = Vec::new();
    for (clouds, scenes) in [(false, "scenes without clouds"), (true, "scenes with clouds")] {
        let (variations, steps) = overall(&study.scenes, clouds).into_iter().partition(|row| row.is_variation);
        tables.push((format!("All {scenes}"), steps));
        tables.push((format!("One group of settings from another preset, all {scenes}"), variations));
    }
    tables.retain(|(_, rows): &(_, Vec<_>)| !rows.is_empty());
    tables
}

/// What was measured on every scene of clear air or terrain (`clouds` false) or among clouds.
pub fn overall(scenes: &[SceneResults], clouds: bool) -> Vec<Overall> {
    let those: Vec<_> = scenes.iter().filter(|scene| (scene.traits.kind == SceneKind::Clouds) == clouds).collect();
    let mut sums: BTreeMap<String, (f64, f64, usize, bool)> = BTreeMap::new();
    for scene in &those {
        for point in scene.points.iter().filter(|point| point.family != Family::Reference) {
            let logs = (point.error.rms.max(SMALLEST).ln(), point.milliseconds.median.max(1e-6).ln());
            for name in [Some(&point.name), point.preset.as_ref()].into_iter().flatten() {
                let sum = sums.entry(name.clone()).or_default();
                *sum = (sum.0 + logs.0, sum.1 + logs.1, sum.2 + 1, point.family == Family::Variation);
            }
        }
    }
    let everywhere = sums.into_iter().filter(|(_, (_, _, count, _))| *count == those.len());
    let mut all: Vec<Overall> = everywhere
        .map(|(name, (error, time, count, is_variation))| Overall {
            is_preset: name.parse::<Quality>().is_ok(),
            is_variation,
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

#[cfg(test)]
mod tests {
    use super::super::front::tests::point;
    use super::super::results::Point;
    use super::*;
    use crate::plan::SceneTraits;
    use crate::scene::Scene;

    fn scene(name: &str, points: Vec<Point>) -> SceneResults {
        let text = "preset = \"earth\"\nsun.elevation_deg = 50\nsun.azimuth_deg = 0\n\
                    camera = { altitude_m = 2, elevation_deg = 0, azimuth_deg = 0, width = 8, height = 8 }\n";
        let scene = Scene::parse(text, std::path::Path::new("scene.toml")).unwrap();
        SceneResults {
            scene: name.to_owned(),
            random: false,
            traits: SceneTraits::of(&scene),
            width: 8,
            height: 8,
            truth_walks: 8,
            points,
            channels: scene.spectrum.channels,
            pictures: BTreeMap::new(),
        }
    }

    #[test]
    fn one_group_of_settings_stands_in_a_table_of_its_own_and_may_beat_a_preset() {
        let points = |scale: f64| {
            vec![
                Point {
                    preset: Some("high".to_owned()),
                    ..point("high harmonics", 20.0, 0.01 * scale, Family::Ladder)
                },
                point("high, but orders of medium", 15.0, 0.009 * scale, Family::Variation),
                point("path tracer, 4 walks", 5.0, 0.001, Family::Reference),
            ]
        };
        // Measured on one of the two only.
        let mut more = points(4.0);
        more.push(point("low, but texels of medium", 1.0, 0.01, Family::Variation));
        let rows = overall(&[scene("noon", points(1.0)), scene("dusk", more)], false);
        let names: Vec<_> = rows.iter().map(|row| (row.name.as_str(), row.is_preset, row.is_variation)).collect();
        let expected =
            [("high, but orders of medium", false, true), ("high", true, false), ("high harmonics", false, false)];
        assert_eq!(names, expected);
        assert!((rows[1].error - 0.02).abs() < 1e-12, "the geometric mean of 1 and 4 % is {}", rows[1].error);
        assert_eq!(rows[1].dominated_by.as_deref(), Some("high, but orders of medium"));
        assert_eq!(rows[0].dominated_by, None);
    }
}
