//! The march through the sum of all media where a scene has fog, local volumes or local lights.

use super::{Pass, Recording, RenderError, volume_light};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Surface};

const NAME: &str = "local_media";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: volume_light::need,
        reads: &[
            "cloud_shape_volume",
            "cloud_erosion_volume",
            "cloud_weather_map",
            "cloud_curl_map",
            "cloud_gaps",
            "cloud_light_image",
            "cloud_cover_image",
            "ordinates_sunlight",
            "optical_depth_table",
            "multiple_scattering_table",
            "volume_light_image",
            "volume_sky_image",
            "cluster_masks",
            "lamp_froxels",
            "terrain_image",
        ],
        writes: &["media_radiance_image", "media_transmittance_image", "media_beam_image", "media_diffuse_image"],
        inputs: |facts| {
            let scene = facts.scene;
            let settings = (facts.settings.clouds, facts.settings.volumes, facts.settings.multiple_scattering_size);
            let media = (&facts.volumes, &facts.local_lights, &scene.clouds, scene.time_s);
            Fingerprint::of(&(&scene.camera, &facts.lights, &scene.planet, media, settings, facts.surface))
        },
        bytes: |facts| 4 * shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    for name in PASS.declaration.writes {
        recording.resources.image(name, shape, ImageFormat::Rgba32Float)?;
    }
    let surface = match recording.facts.surface {
        Some(Surface::Terrain) => recording.resources.existing_image("terrain_image").cloned(),
        Some(Surface::Given(_)) => recording.resources.existing_image("foreground_image").cloned(),
        Some(Surface::Rays) | None => None,
    };
    let images: Vec<_> = surface.iter().map(|image| ("surface_image", image)).collect();
    recording.dispatch(NAME, &[], &images, Work::Invocations(shape.extent()))
}
