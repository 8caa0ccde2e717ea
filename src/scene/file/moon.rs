//! The moon of a scene file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::WhenFile;
use super::number::{AngularRadius, Azimuth, Elevation, Light, Number, PhaseAngle};
use super::per_band::PerBand;

/// The moon: where it stands. Its phase and light follow from the sun.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoonFile {
    /// Angle of the centre above the horizontal, degrees; with `azimuth_deg` in place of `when`.
    pub elevation_deg: Option<Number<Elevation>>,
    /// Angle from north towards east, degrees.
    pub azimuth_deg: Option<Number<Azimuth>>,
    /// Date, time and place on Earth, in place of the two angles; by default the sun's.
    pub when: Option<WhenFile>,
    /// Angle between sun and observer as the moon sees them, degrees: 0 is full, 180 new. By default from the directions
    /// of both.
    pub phase_angle_deg: Option<Number<PhaseAngle>>,
    /// Irradiance normal to the beam above the atmosphere, W/(m² nm); by default from phase, distance and the sun's.
    pub irradiance: Option<PerBand<Light>>,
    /// Angular radius of the disc, degrees; by default from its distance.
    pub angular_radius_deg: Option<Number<AngularRadius>>,
    /// Whether light from the Earth shows its dark part; by default true.
    pub earthshine: Option<bool>,
}
