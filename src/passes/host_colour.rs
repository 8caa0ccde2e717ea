//! Linear radiance into the image of a host.

use bytemuck::{Pod, Zeroable};

use super::colour::padded_columns;
use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Fingerprint, Need};

const NAME: &str = "host_colour";

/// The pass. The host's image is another one, or holds something else, in every frame.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: |_| Need::Needed("the host's picture".to_owned()),
        reads: &["radiance_image"],
        writes: &[],
        inputs: |_| Fingerprint::of(&()),
        bytes: |_| 0,
    },
    record,
};

/// WGSL `HostColour`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct HostColourBlock {
    from_radiance: [[f32; 4]; 3],
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Some(frame) = recording.resources.host_frame().cloned() else { return Ok(()) };
    let Some(radiance) = recording.resources.existing_image("radiance_image").cloned() else { return Ok(()) };
    let from_radiance = padded_columns(frame.colour_matrix(recording.facts.scene));
    recording.insert_parameters("host_colour", &HostColourBlock { from_radiance });
    let target = &frame.colour.image;
    let flags: &[&str] = if target.format() == ImageFormat::Rgba16Float { &["HALF"] } else { &[] };
    let images = [("radiance_image", &radiance), ("host_target_image", target)];
    let ImageShape::D2(width, height) = target.shape() else { return Ok(()) };
    recording.dispatch(NAME, flags, &images, Work::Invocations([width, height, 1]))
}
