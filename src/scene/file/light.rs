//! The lights of a scene file.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::value::Datetime;

use super::number::{Altitude, AngularRadius, Azimuth, ConeAngle, Duration, Elevation, Light, Longitude, Number, Time};
use super::per_band::PerBand;

/// The sun: where it stands, and what differs from the preset's.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SunFile {
    /// Angle of the centre above the horizontal, degrees; with `azimuth_deg` in place of `when`.
    pub elevation_deg: Option<Number<Elevation>>,
    /// Angle from north towards east, degrees.
    pub azimuth_deg: Option<Number<Azimuth>>,
    /// Date, time and place on Earth, in place of the two angles.
    pub when: Option<WhenFile>,
    /// Irradiance normal to the beam above the atmosphere, W/(m² nm); by default the preset's.
    pub irradiance: Option<PerBand<Light>>,
    /// Angular radius of the disc, degrees; by default the preset's. 0 is a parallel beam without a disc.
    pub angular_radius_deg: Option<Number<AngularRadius>>,
    /// Whether the disc darkens towards its edge; by default the preset's.
    pub limb_darkening: Option<bool>,
}

/// Date, time and place on Earth, from which the sun's position follows (without refraction).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WhenFile {
    /// RFC 3339 date and time with its offset from UTC, unquoted: 2026-06-21T12:00:00+02:00.
    #[schemars(with = "String", extend("format" = "date-time"))]
    pub date_time: Datetime,
    /// Latitude, degrees, north positive.
    pub latitude_deg: Number<Elevation>,
    /// Longitude, degrees, east positive.
    pub longitude_deg: Number<Longitude>,
}

/// Lights besides the sun.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LightsFile {
    /// Discs at infinity: a moon, a second sun.
    #[serde(default)]
    pub directional: Vec<DirectionalFile>,
    /// Points that shine equally in all directions.
    #[serde(default)]
    pub point: Vec<PointFile>,
    /// Points that shine into a cone.
    #[serde(default)]
    pub spot: Vec<SpotFile>,
    /// Uniform radiance from the surrounding space.
    pub environment: Option<EnvironmentFile>,
}

/// A disc at infinity.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectionalFile {
    /// What it is called in reports.
    pub name: String,
    /// Angle of the centre above the horizontal, degrees.
    pub elevation_deg: Number<Elevation>,
    /// Angle from north towards east, degrees.
    pub azimuth_deg: Number<Azimuth>,
    /// Irradiance normal to the beam above the atmosphere, W/(m² nm).
    pub irradiance: PerBand<Light>,
    /// Angular radius of the disc, degrees; by default 0, a parallel beam without a disc.
    pub angular_radius_deg: Option<Number<AngularRadius>>,
    /// Whether the disc darkens towards its edge; by default false.
    #[serde(default)]
    pub limb_darkening: bool,
}

/// A point that shines equally in all directions.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointFile {
    /// What it is called in reports.
    pub name: String,
    /// Position [east, north, up] from the ground below the camera, m.
    pub position_m: [Number<Altitude>; 3],
    /// Radiant intensity, W/(sr nm).
    pub intensity: PerBand<Light>,
    /// When it shines, for a moment; by default always.
    pub flash: Option<FlashFile>,
}

/// Light that comes at once and fades.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlashFile {
    /// When it is brightest, s of the scene's time.
    pub start_s: Number<Time>,
    /// In which time it fades to 1/e, s.
    pub decay_s: Number<Duration>,
}

/// A point that shines into a cone.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpotFile {
    /// What it is called in reports.
    pub name: String,
    /// Position [east, north, up] from the ground below the camera, m.
    pub position_m: [Number<Altitude>; 3],
    /// Radiant intensity along the cone's axis, W/(sr nm).
    pub intensity: PerBand<Light>,
    /// Where the axis points: angle above the horizontal, degrees; -90 is straight down.
    pub elevation_deg: Number<Elevation>,
    /// Where the axis points: angle from north towards east, degrees; by default 0.
    pub azimuth_deg: Option<Number<Azimuth>>,
    /// Angle from the axis up to which it shines in full, degrees.
    pub inner_deg: Number<ConeAngle>,
    /// Angle from the axis beyond which it does not shine, degrees; above `inner_deg`.
    pub outer_deg: Number<ConeAngle>,
    /// When it shines, for a moment; by default always.
    pub flash: Option<FlashFile>,
}

/// Uniform surroundings.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentFile {
    /// Radiance from every direction of space, W/(m² sr nm).
    pub radiance: PerBand<Light>,
}
