//! The `medium` of a scene file: a list that stands alone, or changes to the preset's.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use super::number::{Altitude, Asymmetry, Coefficient, DropletDiameter, Fraction, Length, Number};
use super::per_band::PerBand;

/// What the air is made of.
#[derive(Debug, Clone, JsonSchema)]
#[schemars(untagged)]
pub enum MediumFile {
    /// `[[medium]]`: every constituent, in place of the preset's.
    Complete(Vec<ConstituentFile>),
    /// `[medium.NAME]`: what differs from the preset's constituent of that name, or one more constituent.
    Changes(BTreeMap<String, ConstituentChange>),
}

/// One kind of matter in the air.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConstituentFile {
    /// What it is called in messages and tables.
    pub name: String,
    /// Scattering coefficient at density 1, 1/m; by default 0.
    pub scattering_per_m: Option<PerBand<Coefficient>>,
    /// Absorption coefficient at density 1, 1/m; by default 0.
    pub absorption_per_m: Option<PerBand<Coefficient>>,
    /// Radiance emitted per metre at density 1, W/(m² sr nm) per m; by default 0.
    pub emission_per_m: Option<PerBand<Coefficient>>,
    /// How density varies with altitude.
    pub profile: ProfileFile,
    /// How scattered light is spread over directions; required where anything is scattered.
    pub phase: Option<PhaseFile>,
}

/// What differs from a preset's constituent.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConstituentChange {
    /// Factor on all of its coefficients: 5 is five times as dense, 0 leaves it out. By default 1.
    pub density_factor: Option<Number<Coefficient>>,
    /// Scattering coefficient at density 1, 1/m.
    pub scattering_per_m: Option<PerBand<Coefficient>>,
    /// Absorption coefficient at density 1, 1/m.
    pub absorption_per_m: Option<PerBand<Coefficient>>,
    /// Radiance emitted per metre at density 1, W/(m² sr nm) per m.
    pub emission_per_m: Option<PerBand<Coefficient>>,
    /// How density varies with altitude; required for a constituent that the preset lacks.
    pub profile: Option<ProfileFile>,
    /// How scattered light is spread over directions; required where a new constituent scatters.
    pub phase: Option<PhaseFile>,
}

/// How density varies with altitude.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum ProfileFile {
    /// exp(-h / scale height): gases and haze.
    Exponential {
        /// The altitude over which density falls by e, m.
        scale_height_m: Number<Length>,
    },
    /// A triangle over altitude: the ozone layer.
    Tent {
        /// Altitude of full density, m.
        centre_m: Number<Altitude>,
        /// Distance from the centre at which density reaches zero, m.
        half_width_m: Number<Length>,
    },
    /// 1 between two altitudes, 0 elsewhere.
    Layer {
        /// Lower boundary, m.
        bottom_m: Number<Altitude>,
        /// Upper boundary, m; must lie above the lower one.
        top_m: Number<Altitude>,
    },
}

/// How scattered light is spread over directions.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum PhaseFile {
    /// The same in all directions.
    Isotropic,
    /// Molecules.
    Rayleigh,
    /// Henyey and Greenstein 1941.
    HenyeyGreenstein {
        /// Mean cosine.
        g: Number<Asymmetry>,
    },
    /// Two lobes of Henyey and Greenstein, Kattawar 1975.
    DoubleHenyeyGreenstein {
        /// Share of the first lobe.
        weight: Number<Fraction>,
        /// Mean cosine of the first lobe.
        g1: Number<Asymmetry>,
        /// Mean cosine of the second lobe.
        g2: Number<Asymmetry>,
    },
    /// Blasi, Le Saëc and Schlick 1993.
    Schlick {
        /// Asymmetry parameter, forward above 0; the mean cosine is smaller.
        k: Number<Asymmetry>,
    },
    /// Cornette and Shanks 1992.
    CornetteShanks {
        /// Asymmetry parameter; the mean cosine is larger.
        g: Number<Asymmetry>,
    },
    /// Draine 2003.
    Draine {
        /// Asymmetry parameter.
        g: Number<Asymmetry>,
        /// Strength of the 1 + alpha cos² term.
        alpha: Number<Coefficient>,
    },
    /// Water droplets by size, Jendersie and d'Eon 2023.
    HenyeyGreensteinDraine {
        /// Diameter of the droplets, µm.
        droplet_diameter_um: Number<DropletDiameter>,
    },
    /// A table in a CSV file, for instance from Mie theory.
    Table {
        /// The file, relative to the scene file, with columns `theta_deg` or `cos_theta`, and `phase_per_sr`.
        file: PathBuf,
    },
}

struct MediumVisitor;

impl<'de> Visitor<'de> for MediumVisitor {
    type Value = MediumFile;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("[[medium]] for a complete list of constituents or [medium.NAME] for changes to the preset's")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<MediumFile, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(seq)).map(MediumFile::Complete)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MediumFile, A::Error> {
        Deserialize::deserialize(MapAccessDeserializer::new(map)).map(MediumFile::Changes)
    }
}

// By hand, because serde's untagged enums forget where in the file a value stands.
impl<'de> Deserialize<'de> for MediumFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(MediumVisitor)
    }
}
