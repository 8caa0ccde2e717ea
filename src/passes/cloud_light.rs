//! Optical depth of clouds from each cell of their grids to each light.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts};

const NAME: &str = "cloud_light";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::need,
        reads: &["cloud_density_image"],
        writes: &["cloud_light_image"],
        inputs: clouds::directions_inputs,
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba16Float.texel_bytes(),
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    clouds::grid_shape(facts, facts.light_slots())
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("cloud_light_image", shape, ImageFormat::Rgba16Float)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(shape.extent()))
}
