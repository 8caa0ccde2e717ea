//! Where clouds are and how high they reach, and the flow that twists their edges.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Fingerprint};
use welkin_lut::cloud::{CURL_SIZE, WEATHER_SIZE};

const NAME: &str = "cloud_weather";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::need,
        reads: &[],
        writes: &["cloud_weather_map", "cloud_curl_map"],
        inputs: |_| Fingerprint::of(&()),
        bytes: |_| (WEATHER.texels() + CURL.texels()) * ImageFormat::Rgba8Unorm.texel_bytes(),
    },
    record,
};

const WEATHER: ImageShape = ImageShape::D2(WEATHER_SIZE as u32, WEATHER_SIZE as u32);
const CURL: ImageShape = ImageShape::D2(CURL_SIZE as u32, CURL_SIZE as u32);

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    recording.resources.image("cloud_weather_map", WEATHER, ImageFormat::Rgba8Unorm)?;
    recording.resources.image("cloud_curl_map", CURL, ImageFormat::Rgba8Unorm)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(WEATHER.extent()))
}
