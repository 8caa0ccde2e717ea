//! The `[[clouds]]` of a scene file.

use schemars::JsonSchema;
use serde::Deserialize;
use welkin_lut::cloud::CloudKind;

use super::medium::PhaseFile;
use super::number::{Altitude, DropRadius, Fraction, Number, Speed, WaterContent};
use super::per_band::PerBand;

/// A layer of clouds. What is left out is typical of its kind.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CloudFile {
    /// What it is called in messages and tables; by default its kind.
    pub name: Option<String>,
    /// What its clouds look like.
    pub kind: CloudKindFile,
    /// Altitude of the base, m.
    pub base_m: Option<Number<Altitude>>,
    /// Altitude of the highest tops, m; not below the base.
    pub top_m: Option<Number<Altitude>>,
    /// Share of the weather map on which clouds may form.
    pub coverage: Option<Number<Fraction>>,
    /// Liquid or frozen water in the densest part, g/m³.
    pub water_g_per_m3: Option<Number<WaterContent>>,
    /// Effective radius of the droplets or crystals, µm. Extinction is 3/2 of the water over density and radius.
    pub effective_radius_um: Option<Number<DropRadius>>,
    /// Share of the extinction that is scattering; by default 1.
    pub albedo: Option<PerBand<Fraction>>,
    /// How scattered light is spread over directions; by default the Mie fit for droplets of the layer's radius.
    pub phase: Option<PhaseFile>,
    /// Wind that carries the layer, towards east and north, m/s; by default calm.
    pub wind_m_per_s: Option<[Number<Speed>; 2]>,
    /// Speed at which shapes change as if the noise rose, m/s.
    pub evolution_m_per_s: Option<Number<Speed>>,
    /// Another seed is another sky; by default 0.
    #[serde(default)]
    pub seed: u32,
}

/// Kinds of clouds.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CloudKindFile {
    /// A low grey sheet.
    Stratus,
    /// A low sheet of rolls and patches.
    Stratocumulus,
    /// Separate heaps of fair weather.
    Cumulus,
    /// Towers.
    Congestus,
    /// A thunderstorm with its anvil.
    Cumulonimbus,
    /// High streaks of ice.
    Cirrus,
}

impl From<CloudKindFile> for CloudKind {
    fn from(kind: CloudKindFile) -> Self {
        match kind {
            CloudKindFile::Stratus => Self::Stratus,
            CloudKindFile::Stratocumulus => Self::Stratocumulus,
            CloudKindFile::Cumulus => Self::Cumulus,
            CloudKindFile::Congestus => Self::Congestus,
            CloudKindFile::Cumulonimbus => Self::Cumulonimbus,
            CloudKindFile::Cirrus => Self::Cirrus,
        }
    }
}
