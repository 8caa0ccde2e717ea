//! What clouds, fog and volumes send and leave up to each slice of a host's froxels.

use super::{Pass, Recording, RenderError, local_media};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "froxel_media";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &local_media::MARCH_READS,
        writes: &IMAGES,
        inputs: |facts| Fingerprint::of(&(facts.froxels, local_media::march_inputs(facts))),
        bytes: |facts| shape(facts).map_or(0, |shape| 4 * shape.texels() * ImageFormat::Rgba32Float.texel_bytes()),
    },
    record,
};

/// As those of all media, for each froxel.
const IMAGES: [&str; 4] =
    ["froxel_media_radiance", "froxel_media_transmittance", "froxel_media_beam", "froxel_media_diffuse"];

fn need(facts: &Facts) -> Need {
    match facts.froxels {
        None => Need::NotNeeded("the host asks for no froxels".to_owned()),
        Some(_) if !facts.has_overlay() => Need::NotNeeded("nothing stands in the air".to_owned()),
        Some(_) => Need::Needed("clouds or local media before what light passes through".to_owned()),
    }
}

fn shape(facts: &Facts) -> Option<ImageShape> {
    let [columns, rows, slices] = facts.froxels?.size;
    Some(ImageShape::D3(columns, rows, slices))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Some(shape) = shape(recording.facts) else { return Ok(()) };
    for name in IMAGES {
        recording.resources.image(name, shape, ImageFormat::Rgba32Float)?;
    }
    let [columns, rows, _] = shape.extent();
    recording.dispatch(NAME, &[], &[], Work::Invocations([columns, rows, 1]))
}
