//! Linear radiance of every pixel.

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Surface};

const NAME: &str = "compose";

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
            "cloud_radiance_image",
            "cloud_air_image",
            "cloud_diffuse_image",
            "froxel_optical_depth",
            "froxel_emission",
            "froxel_light",
            "media_radiance_image",
            "media_transmittance_image",
            "terrain_image",
        ],
        writes: &["radiance_image", "transmittance_image", "distance_image"],
        inputs: |facts| {
            let scene = facts.scene;
            let lights = (&facts.lights, &facts.faint_discs);
            Fingerprint::of(&(&scene.camera, lights, &scene.planet, facts.outputs.capture, facts.surface))
        },
        bytes: |facts| {
            let pixels = shape(facts).texels();
            let capture = ImageFormat::Rgba32Float.texel_bytes() + ImageFormat::R32Float.texel_bytes();
            pixels * (ImageFormat::Rgba32Float.texel_bytes() + if facts.outputs.capture { capture } else { 0 })
        },
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn need(facts: &Facts) -> Need {
    let camera = &facts.scene.camera;
    Need::Needed(format!("{} x {} pixels", camera.width, camera.height))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("radiance_image", shape, ImageFormat::Rgba32Float)?;
    if recording.facts.outputs.capture {
        recording.resources.image("transmittance_image", shape, ImageFormat::Rgba32Float)?;
        recording.resources.image("distance_image", shape, ImageFormat::R32Float)?;
    }
    let surface = match recording.facts.surface {
        Some(Surface::Terrain) => recording.resources.existing_image("terrain_image").cloned(),
        Some(Surface::Given(_)) => recording.resources.existing_image("foreground_image").cloned(),
        Some(Surface::Rays) | None => None,
    };
    let images: Vec<_> = surface.iter().map(|image| ("surface_image", image)).collect();
    recording.dispatch(NAME, &[], &images, Work::Invocations(shape.extent()))
}
