//! What a host has drawn before the sky, as `compose` reads it.

use bytemuck::{Pod, Zeroable};

use super::colour::padded_columns;
use super::{DepthBuffer, Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Surface};

const NAME: &str = "host_surface";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: |facts| match facts.surface {
            Some(Surface::Given(_)) => Need::Needed("the host has drawn surfaces".to_owned()),
            _ => Need::NotNeeded("the host has drawn nothing".to_owned()),
        },
        reads: &[],
        writes: &["foreground_image"],
        inputs: |facts| Fingerprint::of(&facts.surface),
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

/// WGSL `HostSurface`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct HostSurfaceBlock {
    pub(super) to_radiance: [[f32; 4]; 3],
    pub(super) numerator_m: f32,
    pub(super) offset: f32,
    pub(super) slope: f32,
    pub(super) padding: f32,
}

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let Some(frame) = recording.resources.host_frame().cloned() else { return Ok(()) };
    let Some(depth) = frame.depth.as_ref() else { return Ok(()) };
    recording.resources.image("foreground_image", shape, ImageFormat::Rgba32Float)?;
    let [numerator_m, offset, slope] = depth.buffer.to_planar().map(|value| value as f32);
    let to_radiance = padded_columns(frame.colour_matrix(recording.facts.scene).inverse());
    recording
        .insert_parameters("host_surface", &HostSurfaceBlock { to_radiance, numerator_m, offset, slope, padding: 0.0 });
    let flags: &[&str] = match depth.buffer {
        DepthBuffer::Perspective { .. } => &[],
        DepthBuffer::Planar => &["PLANAR"],
        DepthBuffer::Distance => &["DISTANCE"],
    };
    let images = [("host_depth_image", &depth.image.image), ("host_colour_image", &frame.colour.image)];
    recording.dispatch(NAME, flags, &images, Work::Invocations(shape.extent()))
}
