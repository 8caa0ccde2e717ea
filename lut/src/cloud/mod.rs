//! Clouds as a density in space: the definition that the real-time renderer and the reference share.
//!
//! [`CloudNoise`] holds tiles of bytes that a device makes alike to the last bit; [`CloudField`] is the chain of
//! linear interpolations and clamps that turns them into the density of a [`CloudLayer`] at a point of the map
//! ([`to_map`]) and an altitude. Bytes and chain together *define* the field.

mod bounds;
mod field;
mod fixed_noise;
mod form;
mod layer;
mod noise;
mod parameters;
mod plane;
mod sampling;

pub use bounds::CloudBounds;
pub use field::CloudField;
pub use form::{CloudDefaults, CloudKind};
pub use layer::CloudLayer;
pub(crate) use noise::noise_place;
pub use noise::{CURL_SIZE, CloudNoise, EROSION_SIZE, SHAPE_SIZE, WEATHER_SIZE, WeatherChannel};
pub use parameters::CloudParameters;
pub use plane::to_map;
