//! Clouds along every pixel's ray, from any altitude.

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "clouds";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &[
            "cloud_shape_volume",
            "cloud_erosion_volume",
            "cloud_weather_map",
            "cloud_curl_map",
            "cloud_shape_bounds",
            "cloud_weather_bounds",
            "cloud_light_image",
            "ordinates_sunlight",
            "optical_depth_table",
            "multiple_scattering_table",
        ],
        writes: &["cloud_radiance_image", "cloud_air_image", "cloud_diffuse_image", "cloud_distance_image"],
        inputs: |facts| {
            let scene = facts.scene;
            let settings = (facts.settings.clouds, facts.settings.multiple_scattering_size);
            Fingerprint::of(&(
                &scene.camera,
                &facts.lights,
                &scene.planet,
                &scene.clouds,
                scene.time_s,
                settings,
                facts.outputs.capture,
            ))
        },
        bytes: |facts| {
            let capture = if facts.outputs.capture { ImageFormat::R32Float.texel_bytes() } else { 0 };
            shape(facts).texels() * (3 * ImageFormat::Rgba32Float.texel_bytes() + capture)
        },
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

/// Whether there are clouds: what all passes of clouds are asked.
pub(super) fn need(facts: &Facts) -> Need {
    if facts.clouds.is_empty() {
        return Need::NotNeeded("no clouds".to_owned());
    }
    let names: Vec<_> = facts.clouds.iter().map(|layer| layer.name.as_str()).collect();
    Need::Needed(format!("layers of clouds: {}", names.join(", ")))
}

/// What the field of density in the grids depends on besides its noise.
pub(super) fn field_inputs(facts: &Facts) -> Fingerprint {
    let scene = facts.scene;
    Fingerprint::of(&(&scene.clouds, scene.time_s, facts.settings.clouds))
}

/// The shape of so many fields on the clouds' grids.
pub(super) fn grid_shape(facts: &Facts, fields: u32) -> ImageShape {
    let settings = &facts.settings.clouds;
    let slices = settings.grid_slices * settings.grid_levels * facts.clouds.len() as u32;
    ImageShape::D3(settings.grid_size, settings.grid_size, fields * slices)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("cloud_radiance_image", shape, ImageFormat::Rgba32Float)?;
    recording.resources.image("cloud_air_image", shape, ImageFormat::Rgba32Float)?;
    recording.resources.image("cloud_diffuse_image", shape, ImageFormat::Rgba32Float)?;
    if recording.facts.outputs.capture {
        recording.resources.image("cloud_distance_image", shape, ImageFormat::R32Float)?;
    }
    recording.dispatch(NAME, &[], &[], Work::Invocations(shape.extent()))
}
