//! Mean extinction of each cell of the clouds' grids.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts};

const NAME: &str = "cloud_density";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::need,
        reads: &["cloud_shape_volume", "cloud_erosion_volume", "cloud_weather_map", "cloud_curl_map"],
        writes: &["cloud_density_image"],
        inputs: clouds::field_inputs,
        bytes: |facts| shape(facts).texels() * ImageFormat::R32Float.texel_bytes(),
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    clouds::grid_shape(facts, 1)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("cloud_density_image", shape, ImageFormat::R32Float)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(shape.extent()))
}
