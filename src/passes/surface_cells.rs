//! How far away what stands before the camera is in each cell that marched media are interpolated over.

use super::{Pass, Recording, RenderError, local_media};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, media_froxels};

const NAME: &str = "surface_cells";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &[],
        writes: &[NAME],
        inputs: |facts| Fingerprint::of(&(&facts.scene.camera, facts.surface)),
        bytes: |facts| shape(facts).map_or(0, |shape| shape.texels() * ImageFormat::Rgba32Float.texel_bytes()),
    },
    record,
};

fn need(facts: &Facts) -> Need {
    match media_froxels(facts) {
        Ok([columns, rows, _]) => {
            Need::Needed(format!("froxels of media before surfaces, in {columns} x {rows} cells"))
        }
        Err(reason) => Need::NotNeeded(reason),
    }
}

fn shape(facts: &Facts) -> Option<ImageShape> {
    media_froxels(facts).ok().map(|[columns, rows, _]| ImageShape::D2(columns, rows))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Some(shape) = shape(recording.facts) else { return Ok(()) };
    recording.resources.image(NAME, shape, ImageFormat::Rgba32Float)?;
    let [columns, rows, _] = shape.extent();
    let surface = recording.surface();
    recording.dispatch(NAME, &[], &local_media::surface_images(&surface), Work::Workgroups([columns, rows, 1]))
}
