//! What a report has measured, as it is written to JSON.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use welkin_lut::spectrum::Channels;

use super::{Deviation, SlabResults};
use crate::plan::SceneTraits;

/// All that was measured, and on what.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Study {
    /// Where the numbers come from.
    pub provenance: Provenance,
    /// Scene by scene.
    pub scenes: Vec<SceneResults>,
    /// The families of methods on homogeneous slabs.
    pub slabs: Vec<SlabResults>,
    /// Scenes that were not measured, with the reason.
    pub left_out: Vec<LeftOut>,
}

/// Where numbers come from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// Version of the program.
    pub version: String,
    /// Commit of its source as it stood when the report began, as far as it is known.
    pub commit: String,
    /// The Vulkan device.
    pub device: String,
    /// Its driver with version.
    pub driver: String,
    /// Processor and number of its cores.
    pub machine: String,
    /// What else the machine had to do, or that nobody knows.
    pub load: String,
}

/// A scene that is not in the results.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LeftOut {
    /// Its name.
    pub scene: String,
    /// Why.
    pub reason: String,
}

/// One scene.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SceneResults {
    /// Its name.
    pub scene: String,
    /// Whether it was drawn at random for the model of errors; else it is a file's.
    pub random: bool,
    /// What decides about its errors.
    pub traits: SceneTraits,
    /// Width of the picture that was timed, pixels.
    pub width: u32,
    /// Its height, pixels.
    pub height: u32,
    /// Walks of the truth for each of its pixels.
    pub truth_walks: u64,
    /// All settings and solvers that were measured.
    pub points: Vec<Point>,
    /// What the pictures' channels hold; not for files.
    #[serde(skip)]
    pub channels: Channels,
    /// Cells of the pictures by steps of the ladder, of a scene drawn at random; not for files.
    #[serde(skip)]
    pub pictures: BTreeMap<String, Vec<[f32; 3]>>,
}

/// What made a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Family {
    /// The device, with settings of a rung.
    Ladder,
    /// The device, with one group of a preset's settings taken from the preset beside it.
    Variation,
    /// A solver of the reference, on the CPU.
    Reference,
}

/// Settings or a solver, with error and time.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Point {
    /// Its name.
    pub name: String,
    /// What made the picture.
    pub family: Family,
    /// The preset that does the same to this scene.
    pub preset: Option<String>,
    /// How far it is from the truth.
    pub error: Deviation,
    /// Time of all passes of a first picture, on the device; of solvers the time of all cores, brought to as many pixels.
    pub milliseconds: Spread,
    /// Of each pass; empty for solvers.
    pub passes: BTreeMap<String, Spread>,
    /// What is faster and more accurate at once, if anything is.
    pub dominated_by: Option<String>,
}

/// Repeated measurements of one time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Spread {
    /// Half were shorter.
    pub median: f64,
    /// A quarter were shorter.
    pub first_quartile: f64,
    /// Three quarters were shorter.
    pub third_quartile: f64,
    /// How many there were.
    pub runs: usize,
}

impl Spread {
    /// Of at least one value.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let quantile = |share: f64| {
            let place = share * (sorted.len().max(1) - 1) as f64;
            let (low, high) = (place.floor() as usize, place.ceil() as usize);
            let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
            at(low) + (at(high) - at(low)) * place.fract()
        };
        Self {
            median: quantile(0.5),
            first_quartile: quantile(0.25),
            third_quartile: quantile(0.75),
            runs: values.len(),
        }
    }
}

/// The JSON schema of a study.
pub fn results_schema() -> serde_json::Value {
    schemars::schema_for!(Study).to_value()
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn median_and_quartiles_are_those_of_the_textbook() {
        let spread = Spread::of(&[5.0, 1.0, 2.0, 4.0, 3.0]);
        assert_eq!((spread.first_quartile, spread.median, spread.third_quartile, spread.runs), (2.0, 3.0, 4.0, 5));
        assert_eq!(Spread::of(&[1.0, 2.0]).median, 1.5);
        assert_eq!(Spread::of(&[7.0]).third_quartile, 7.0);
    }
}
