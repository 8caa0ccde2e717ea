//! Parameter blocks: what the shaders read of a scene, laid out as they declare it. The one place where f64 becomes f32.

mod atmosphere;
mod camera;
mod observer;
mod quadrature;

pub use atmosphere::{atmosphere_block, legendre_moments, lobe_count};
pub use camera::CameraBlock;
pub use observer::observer_block;
pub use quadrature::{GaussNodeBlock, cosine_nodes, gauss_nodes};

use welkin_lut::Bands;

/// Narrows one value for each band.
fn vec3(bands: Bands) -> [f32; 3] {
    bands.map(|value| value as f32)
}
