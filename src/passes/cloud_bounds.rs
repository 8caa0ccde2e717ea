//! The largest bytes of the clouds' noise around each block, for skipping empty space.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Fingerprint};
use welkin_lut::cloud::{SHAPE_BLOCKS, WEATHER_BLOCKS};

const NAME: &str = "cloud_bounds";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::need,
        reads: &["cloud_shape_volume", "cloud_weather_map"],
        writes: &["cloud_shape_bounds", "cloud_weather_bounds"],
        inputs: |_| Fingerprint::of(&()),
        bytes: |_| (SHAPE.texels() + WEATHER.texels()) * ImageFormat::Rgba8Unorm.texel_bytes(),
    },
    record,
};

const SHAPE: ImageShape = ImageShape::D3(SHAPE_BLOCKS as u32, SHAPE_BLOCKS as u32, SHAPE_BLOCKS as u32);
const WEATHER: ImageShape = ImageShape::D2(WEATHER_BLOCKS as u32, WEATHER_BLOCKS as u32);

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    recording.resources.image("cloud_shape_bounds", SHAPE, ImageFormat::Rgba8Unorm)?;
    recording.resources.image("cloud_weather_bounds", WEATHER, ImageFormat::Rgba8Unorm)?;
    let blocks = SHAPE.texels().max(WEATHER.texels()) as u32;
    recording.dispatch(NAME, &[], &[], Work::Invocations([blocks, 1, 1]))
}
