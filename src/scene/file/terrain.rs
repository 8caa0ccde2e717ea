//! What a scene file may say of hills and mountains.

use schemars::JsonSchema;
use serde::Deserialize;

use super::PerBand;
use super::number::{Altitude, Fraction, Number, TerrainLength};

/// Hills and mountains out to the horizon.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TerrainFile {
    /// No point is higher than this above the planet's ground, m; at most half of the wavelength.
    pub height_m: Number<TerrainLength>,
    /// Distance between the largest hills, m.
    pub wavelength_m: Number<TerrainLength>,
    /// Which of all such terrains; by default 0.
    #[serde(default)]
    pub seed: u32,
    /// Where in it the camera stands: east and north, m; by default [0, 0].
    pub position_m: Option<[Number<Altitude>; 2]>,
    /// Lambertian reflectance; by default the planet's.
    pub albedo: Option<PerBand<Fraction>>,
    /// Altitude above which snow lies where it is not steep, m; by default there is none.
    pub snow_line_m: Option<Number<Altitude>>,
    /// Lambertian reflectance of snow; by default 0.8.
    pub snow_albedo: Option<PerBand<Fraction>>,
}
