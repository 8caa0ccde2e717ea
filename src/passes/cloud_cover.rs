//! What layers of clouds leave of light around each column of their grids.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts};

const NAME: &str = "cloud_cover";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::need,
        reads: &["cloud_light_image"],
        writes: &["cloud_cover_image"],
        inputs: clouds::directions_inputs,
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba16Float.texel_bytes(),
    },
    record,
};

/// One slice for each layer of each level.
fn shape(facts: &Facts) -> ImageShape {
    let settings = &facts.settings.clouds;
    ImageShape::D3(settings.grid_size, settings.grid_size, settings.grid_levels * facts.clouds.len() as u32)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("cloud_cover_image", shape, ImageFormat::Rgba16Float)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(shape.extent()))
}
