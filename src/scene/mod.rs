//! What the user asks for: a validated [`Scene`] in SI units and `f64`.

mod assemble;
mod camera;
mod clouds;
mod direction;
mod effect;
mod error;
mod file;
mod light;
mod lit_sphere;
mod locate;
mod lunar_photometry;
mod medium;
mod moon;
mod moon_position;
mod npy;
mod preset;
mod read;
mod spectrum;
mod sun_position;
mod terrain;
mod volumes;

pub use camera::{Camera, Display, ToneMap};
pub use direction::Direction;
pub use effect::Effect;
pub use error::{InvalidField, SceneError};
pub use file::schema;
pub use light::{Cone, DirectionalLight, EnvironmentLight, Flash, Light, PointLight};
pub use lit_sphere::LitSphere;
pub use locate::Place;
pub use preset::{Preset, PresetSun};
pub use read::SpectrumRequest;
pub use spectrum::{CANDELA_PER_M2, GroupColour, Spectrum, WavelengthGroup, White};
pub use sun_position::{SunPositionError, sun_direction};
pub use terrain::Terrain;

use welkin_lut::cloud::CloudLayer;
use welkin_lut::volume::Volume;
use welkin_lut::{Medium, Planet};

/// Everything that determines a picture, checked: no stage after this one meets an impossible number.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What it is called in reports, by default the file's stem.
    pub name: String,
    /// The solid sphere and the shell of air around it.
    pub planet: Planet,
    /// What the air is made of, in the bands at 680, 550 and 440 nm.
    pub medium: Medium,
    /// Layers of clouds, which may overlap.
    pub clouds: Vec<CloudLayer>,
    /// Fog and local volumes, which may overlap each other and the clouds; their order has no meaning.
    pub volumes: Vec<Volume>,
    /// Seconds since the start: how far wind has carried clouds and fog, and they have changed.
    pub time_s: f64,
    /// What shines; an empty list is darkness.
    pub lights: Vec<Light>,
    /// Hills and mountains; none where the ground is smooth.
    pub terrain: Option<Terrain>,
    /// Where the picture is taken from, and its size.
    pub camera: Camera,
    /// Which wavelengths are computed, and the colours they become.
    pub spectrum: Spectrum,
    /// How radiance becomes a PNG; does not touch the EXR.
    pub display: Display,
}

/// What is wrong with a field, before anyone has looked up where it stands.
struct Problem {
    /// The field's path, as in `medium[0].profile.layer.top_m`.
    field: String,
    /// What is wrong, with the value and what is allowed.
    message: String,
}

impl Problem {
    fn new(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self { field: field.into(), message: message.into() }
    }
}
