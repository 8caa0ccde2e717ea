//! What the user asks for: a validated [`Scene`] in SI units and `f64`.

mod camera;
mod direction;
mod light;

pub use camera::{Camera, Display, ToneMap};
pub use direction::Direction;
pub use light::{DirectionalLight, EnvironmentLight, Light, PointLight};

use welkin_lut::{Medium, Planet};

/// Everything that determines a picture, checked: no stage after this one meets an impossible number.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What it is called in reports, by default the file's stem.
    pub name: String,
    /// The solid sphere and the shell of air around it.
    pub planet: Planet,
    /// What the air is made of.
    pub medium: Medium,
    /// What shines; an empty list is darkness.
    pub lights: Vec<Light>,
    /// Where the picture is taken from, and its size.
    pub camera: Camera,
    /// How radiance becomes a PNG; does not touch the EXR.
    pub display: Display,
}
