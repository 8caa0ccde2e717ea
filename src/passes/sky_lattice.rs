//! The sky between whose directions pixels are interpolated.

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, lattice_cell};

const NAME: &str = "sky_lattice";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &[
            "optical_depth_table",
            "multiple_scattering_table",
            "view_optical_depth_table",
            "sky_view_table",
            "view_emission_table",
        ],
        writes: &["sky_lattice"],
        inputs: |facts| {
            let scene = facts.scene;
            let lights = (&facts.lights, &facts.faint_discs);
            let transmittance = (facts.has_overlay(), facts.outputs.capture);
            Fingerprint::of(&(&scene.camera, lights, &scene.planet, transmittance))
        },
        bytes: |facts| shape(facts, lattice_cell(facts).unwrap_or(1)).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

/// Layers for what a node holds, of corners and of centres: `NODE_LAYERS` in `lattice.wgsl`.
fn shape(facts: &Facts, cell: u32) -> ImageShape {
    let camera = &facts.scene.camera;
    let smooth = if facts.has_overlay() { 5 } else { 1 + u32::from(facts.outputs.capture) };
    let single = if facts.is_lit() { facts.light_slots() * facts.groups.scatterer_count } else { 0 };
    // Corners are one more than cells.
    let nodes = |pixels: u32| pixels.div_ceil(cell) + 1;
    ImageShape::D2Array(nodes(camera.width), nodes(camera.height), 2 * (smooth + single))
}

fn need(facts: &Facts) -> Need {
    match lattice_cell(facts) {
        Ok(cell) => {
            let percent = 100.0 * facts.settings.lattice_tolerance;
            Need::Needed(format!(
                "cells of {cell} x {cell} pixels, interpolated where that errs by less than {percent} %"
            ))
        }
        Err(reason) => Need::NotNeeded(reason),
    }
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Ok(cell) = lattice_cell(recording.facts) else { return Ok(()) };
    let shape = shape(recording.facts, cell);
    let [width, height, _] = shape.extent();
    let lattice = recording.resources.image("sky_lattice", shape, ImageFormat::Rgba32Float)?;
    recording.dispatch(NAME, &[], &[("sky_lattice_image", &lattice)], Work::Invocations([width, height, 2]))
}
