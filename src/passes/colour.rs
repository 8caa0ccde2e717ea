//! From three wavelengths at a time to linear colour.

use bytemuck::{Pod, Zeroable};
use glam::DMat3;

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "colour";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["radiance_image", "transmittance_image"],
        writes: &["colour_image", "colour_transmittance_image"],
        inputs: |facts| Fingerprint::of(&facts.part),
        bytes: |facts| {
            let images = 1 + u64::from(facts.outputs.capture);
            images * shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes()
        },
    },
    record,
};

/// WGSL `Share`: three columns, each with its padding.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShareBlock {
    to_colour: [[f32; 4]; 3],
}

/// A matrix as a uniform buffer holds it: columns of four.
pub fn padded_columns(matrix: DMat3) -> [[f32; 4]; 3] {
    matrix.to_cols_array_2d().map(|[x, y, z]| [x as f32, y as f32, z as f32, 0.0])
}

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn need(facts: &Facts) -> Need {
    match &facts.part {
        Some(part) => Need::Needed(format!("{} groups of three wavelengths add up to the colour", part.count)),
        None => Need::NotNeeded("three wavelengths are one group, which needs no sum".to_owned()),
    }
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Some(part) = recording.facts.part else { return Ok(()) };
    let mut sums = vec![("radiance_image", "colour_image", part.colour.radiance)];
    if recording.facts.outputs.capture {
        sums.push(("transmittance_image", "colour_transmittance_image", part.colour.transmittance));
    }
    let flags: &[&str] = if part.index == 0 { &["FIRST"] } else { &[] };
    for (seen, sum, matrix) in sums {
        let Some(seen) = recording.resources.existing_image(seen).cloned() else { continue };
        let sum = recording.resources.image(sum, shape(recording.facts), ImageFormat::Rgba32Float)?;
        recording.insert_parameters("share", &ShareBlock { to_colour: padded_columns(matrix) });
        let images = [("seen_image", &seen), ("colour_image", &sum)];
        recording.dispatch(NAME, flags, &images, Work::Invocations(shape(recording.facts).extent()))?;
    }
    Ok(())
}
