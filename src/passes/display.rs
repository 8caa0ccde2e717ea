//! An 8-bit picture of the frame.

use bytemuck::{Pod, Zeroable};

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};
use crate::scene::ToneMap;

const NAME: &str = "display";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["radiance_image"],
        writes: &["picture_image"],
        inputs: |facts| Fingerprint::of(&facts.scene.display),
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba8Unorm.texel_bytes(),
    },
    record,
};

/// WGSL `Display`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct DisplayBlock {
    exposure: [f32; 3],
    padding: f32,
}

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn need(facts: &Facts) -> Need {
    if !facts.outputs.picture {
        return Need::NotNeeded("no 8-bit picture is asked for".to_owned());
    }
    Need::Needed(format!("exposure {} EV", facts.scene.display.exposure_ev))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let scene = recording.facts.scene;
    let exposure = crate::output::display::exposure(scene).map(|factor| factor as f32);
    recording.insert_parameters("display", &DisplayBlock { exposure, padding: 0.0 });
    recording.resources.image("picture_image", shape, ImageFormat::Rgba8Unorm)?;
    let flags: &[&str] = match scene.display.tone_map {
        ToneMap::Filmic => &["FILMIC"],
        ToneMap::None => &[],
    };
    recording.dispatch(NAME, flags, &[], Work::Invocations(shape.extent()))
}
