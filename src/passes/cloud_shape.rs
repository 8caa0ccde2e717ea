//! The tile of noise that the shapes of clouds are cut from.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Fingerprint};
use welkin_lut::cloud::SHAPE_SIZE;

const NAME: &str = "cloud_shape";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::noise_need,
        reads: &[],
        writes: &["cloud_shape_volume"],
        inputs: |_| Fingerprint::of(&()),
        bytes: |_| SHAPE.texels() * ImageFormat::Rgba8Unorm.texel_bytes(),
    },
    record,
};

const SHAPE: ImageShape = ImageShape::D3(SHAPE_SIZE as u32, SHAPE_SIZE as u32, SHAPE_SIZE as u32);

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    recording.resources.image("cloud_shape_volume", SHAPE, ImageFormat::Rgba8Unorm)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(SHAPE.extent()))
}
