//! What a scene file may say: the types that both the reader and the JSON schema are made from.

mod clouds;
mod light;
mod medium;
mod moon;
pub mod number;
mod per_band;
mod spectrum;
mod terrain;
mod volumes;

pub use clouds::CloudFile;
pub use light::{FlashFile, LightsFile, SunFile, WhenFile};
pub use medium::{ConstituentChange, ConstituentFile, MediumFile, PhaseFile, ProfileFile};
pub use moon::MoonFile;
pub use per_band::PerBand;
pub use spectrum::{ChannelsFile, SpectrumFile, WhiteFile, listed};
pub use terrain::TerrainFile;
pub use volumes::{FogFile, FogProfileFile, GridFile, NoiseFile, VolumeFile, VolumeShapeFile};

use schemars::JsonSchema;
use serde::Deserialize;

use super::Preset;
use number::{Altitude, Azimuth, Elevation, Exposure, FieldOfView, Fraction, Length, Number, Pixels, Time};

/// A welkin scene: a planet with its air, what shines on it, and a camera.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// What the scene is called in reports; by default the file's name without its ending.
    pub name: Option<String>,
    /// Seconds since the start: wind has carried clouds and fog and they have changed; by default 0.
    pub time_s: Option<Number<Time>>,
    /// The planet, air and sun that everything below is a change to.
    pub preset: Preset,
    /// What differs from the preset's planet.
    #[serde(default)]
    pub planet: PlanetFile,
    /// What differs from the preset's air.
    pub medium: Option<MediumFile>,
    /// Layers of clouds.
    #[serde(default)]
    pub clouds: Vec<CloudFile>,
    /// Banks of fog over the ground.
    #[serde(default)]
    pub fog: Vec<FogFile>,
    /// Boxes and ellipsoids of smoke, mist or glowing gas.
    #[serde(default)]
    pub volumes: Vec<VolumeFile>,
    /// The sun.
    pub sun: SunFile,
    /// The moon; by default none shines.
    pub moon: Option<MoonFile>,
    /// Lights besides the sun.
    #[serde(default)]
    pub light: LightsFile,
    /// Hills and mountains on the planet; without it the ground is smooth.
    pub terrain: Option<TerrainFile>,
    /// Where the picture is taken from.
    pub camera: CameraFile,
    /// Which wavelengths are computed, and the colours they become; by default the three bands.
    pub spectrum: Option<SpectrumFile>,
    /// How radiance becomes a picture; does not touch an EXR file.
    #[serde(default)]
    pub display: DisplayFile,
}

/// What differs from the preset's planet.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlanetFile {
    /// Distance from the centre to the ground, m.
    pub radius_m: Option<Number<Length>>,
    /// Altitude of the top of the atmosphere above the ground, m.
    pub atmosphere_height_m: Option<Number<Length>>,
    /// Lambertian reflectance of the ground.
    pub ground_albedo: Option<PerBand<Fraction>>,
}

/// A pinhole camera.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraFile {
    /// Height above the ground, m.
    pub altitude_m: Number<Altitude>,
    /// Where the centre of the picture looks: angle above the horizontal, degrees.
    pub elevation_deg: Number<Elevation>,
    /// Where the centre of the picture looks: angle from north towards east, degrees.
    pub azimuth_deg: Number<Azimuth>,
    /// Angle between the picture's lower and upper edge, degrees; by default 60.
    pub vertical_field_of_view_deg: Option<Number<FieldOfView>>,
    /// Width of the picture, pixels; by default 1280.
    pub width: Option<Pixels>,
    /// Height of the picture, pixels; by default 720.
    pub height: Option<Pixels>,
}

/// How radiance becomes a picture.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplayFile {
    /// Radiance is multiplied by two to this power; by default 0.
    pub exposure_ev: Option<Number<Exposure>>,
    /// The curve that brings radiance into the range of a screen; by default "filmic".
    pub tone_map: Option<ToneMapFile>,
}

/// Curves from radiance to the range of a screen.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ToneMapFile {
    /// Clip at 1.
    None,
    /// A soft shoulder that keeps hue towards white.
    Filmic,
}

/// The JSON schema of a scene file, for editors.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(SceneFile).to_value()
}
