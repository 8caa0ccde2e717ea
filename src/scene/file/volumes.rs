//! The `[[fog]]` and `[[volumes]]` of a scene file.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::medium::PhaseFile;
use super::number::{Altitude, Azimuth, Coefficient, Fraction, Number, Speed, VolumeLength};
use super::per_band::PerBand;

/// A bank of fog, all around the planet.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FogFile {
    /// What it is called in messages and tables; by default "fog".
    pub name: Option<String>,
    /// Extinction where the fog is densest, 1/m.
    pub extinction_per_m: PerBand<Coefficient>,
    /// Share of the extinction that is scattering; by default 1.
    pub albedo: Option<PerBand<Fraction>>,
    /// How scattered light is spread over directions; by default droplets of 16 µm.
    pub phase: Option<PhaseFile>,
    /// Altitude below which there is none, m; by default 0, the ground.
    pub bottom_m: Option<Number<Altitude>>,
    /// How density varies above it.
    pub profile: FogProfileFile,
    /// Billows; by default none.
    pub noise: Option<NoiseFile>,
}

/// How fog's density varies with altitude.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum FogProfileFile {
    /// exp(-h / scale height) above the bottom; cut off after eight scale heights.
    Exponential {
        /// The altitude over which density falls by e, m.
        scale_height_m: Number<VolumeLength>,
    },
    /// 1 from the bottom to a top.
    Layer {
        /// Altitude of the top, m; above the bottom.
        top_m: Number<Altitude>,
        /// Share of the thickness, from the top down, over which density rises to 1; by default 0.
        edge: Option<Number<Fraction>>,
    },
}

/// Billows in the density.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NoiseFile {
    /// Size of the largest billows, m.
    pub size_m: Number<VolumeLength>,
    /// What the noise takes of the density at most; by default 1.
    pub strength: Option<Number<Fraction>>,
    /// Wind that carries the billows, towards east and north, m/s; by default calm.
    pub wind_m_per_s: Option<[Number<Speed>; 2]>,
    /// Speed at which shapes change as if the noise rose, m/s; by default 0.
    pub evolution_m_per_s: Option<Number<Speed>>,
    /// Another seed is another place in the noise; by default 0.
    #[serde(default)]
    pub seed: u32,
}

/// A box or an ellipsoid filled with matter.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VolumeFile {
    /// What it is called in messages and tables.
    pub name: String,
    /// Its form.
    pub shape: VolumeShapeFile,
    /// Its middle, [east, north, up] from the ground below the camera, m.
    pub centre_m: [Number<Altitude>; 3],
    /// Its edges or diameters, [east, north, up] before it is turned, m.
    pub size_m: [Number<VolumeLength>; 3],
    /// Turn about the vertical, clockwise seen from above, degrees; by default 0.
    pub turn_deg: Option<Number<Azimuth>>,
    /// Share of the half size over which density rises from the surface inwards; by default 0, a sharp surface.
    pub edge: Option<Number<Fraction>>,
    /// Scattering coefficient at density 1, 1/m; by default 0.
    pub scattering_per_m: Option<PerBand<Coefficient>>,
    /// Absorption coefficient at density 1, 1/m; by default 0.
    pub absorption_per_m: Option<PerBand<Coefficient>>,
    /// Radiance emitted per metre at density 1, W/(m² sr nm) per m; by default 0.
    pub emission_per_m: Option<PerBand<Coefficient>>,
    /// How scattered light is spread over directions; required where anything is scattered.
    pub phase: Option<PhaseFile>,
    /// Billows; by default none.
    pub noise: Option<NoiseFile>,
    /// Density from a file; by default 1 everywhere.
    pub grid: Option<GridFile>,
}

/// Forms of volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VolumeShapeFile {
    /// A box with upright edges.
    Box,
    /// An ellipsoid with an upright axis.
    Ellipsoid,
}

/// Density from a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridFile {
    /// A NumPy array file (`.npy`) of three axes [up, north, east] in C order, f4 or f8; relative to the scene file.
    pub file: PathBuf,
}
