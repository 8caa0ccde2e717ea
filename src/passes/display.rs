//! A picture of the frame for a screen.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::colour::padded_columns;
use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, ScreenEncoding, Work};
use crate::output::display;
use crate::plan::{Declaration, Facts, Fingerprint, Need};
use crate::scene::ToneMap;

const NAME: &str = "display";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["radiance_image", "colour_image"],
        writes: &["picture_image"],
        inputs: |facts| Fingerprint::of(&(facts.scene.display, display::exposed_bands(facts.scene))),
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba8Unorm.texel_bytes(),
    },
    record,
};

/// WGSL `Display`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct DisplayBlock {
    to_srgb: [[f32; 4]; 3],
}

/// Exposures of half floats lie this many stops apart, so that a slightly other exposure does not change every pixel.
const PRE_EXPOSURE_STEP_EV: f64 = 4.0;

/// What radiance is multiplied with before it is kept for a screen alone: white then lies between 1 and 16, 12 to 16 stops
/// below the largest half float and 14 to 18 above the smallest with all its digits; 1 where all digits are kept (pre-exposure:
/// Lagarde & de Rousiers 2014, section 5.1).
pub(super) fn pre_exposure(facts: &Facts) -> f64 {
    if !facts.for_screen {
        return 1.0;
    }
    let to_srgb = display::exposed_bands(facts.scene);
    let whitest = (to_srgb * DVec3::ONE).max_element();
    (PRE_EXPOSURE_STEP_EV * (whitest.log2() / PRE_EXPOSURE_STEP_EV).ceil()).exp2()
}

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn need(facts: &Facts) -> Need {
    if !facts.outputs.picture {
        return Need::NotNeeded("no 8-bit picture is asked for".to_owned());
    }
    if facts.part.is_some_and(|part| !part.is_last()) {
        return Need::NotNeeded("the picture is not whole before the last group of wavelengths".to_owned());
    }
    Need::Needed(format!("exposure {} EV", facts.scene.display.exposure_ev))
}

pub(super) fn flags(recording: &Recording) -> Vec<&'static str> {
    let mut flags = match recording.resources.screen {
        ScreenEncoding::Srgb => Vec::new(),
        ScreenEncoding::ExtendedLinear => vec!["HDR"],
        ScreenEncoding::Hdr10 => vec!["HDR", "PQ"],
    };
    flags.extend((recording.facts.scene.display.tone_map == ToneMap::Filmic).then_some("FILMIC"));
    flags
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let scene = recording.facts.scene;
    let (to_srgb, seen) = match recording.facts.part {
        None => (display::exposed_bands(scene) / pre_exposure(recording.facts), "radiance_image"),
        Some(_) => (display::exposed_srgb(scene), "colour_image"),
    };
    let Some(seen) = recording.resources.existing_image(seen).cloned() else { return Ok(()) };
    recording.insert_parameters("display", &DisplayBlock { to_srgb: padded_columns(to_srgb) });
    let format = recording.resources.screen.image_format();
    recording.resources.image("picture_image", shape, format)?;
    recording.dispatch(NAME, &flags(recording), &[("radiance_image", &seen)], Work::Invocations(shape.extent()))
}
