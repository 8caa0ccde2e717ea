//! The tile of noise that eats into the edges of clouds.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Fingerprint};
use welkin_lut::cloud::EROSION_SIZE;

const NAME: &str = "cloud_erosion";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::noise_need,
        reads: &[],
        writes: &["cloud_erosion_volume"],
        inputs: |_| Fingerprint::of(&()),
        bytes: |_| SHAPE.texels() * ImageFormat::Rgba8Unorm.texel_bytes(),
    },
    record,
};

const SHAPE: ImageShape = ImageShape::D3(EROSION_SIZE as u32, EROSION_SIZE as u32, EROSION_SIZE as u32);

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    recording.resources.image("cloud_erosion_volume", SHAPE, ImageFormat::Rgba8Unorm)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(SHAPE.extent()))
}
