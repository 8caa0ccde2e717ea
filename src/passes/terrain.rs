//! Mountains before the sky: their distance and the light that they send.

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Surface};

const NAME: &str = "terrain";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &[
            "optical_depth_table",
            "multiple_scattering_table",
            "cloud_light_image",
            "cloud_cover_image",
            "cloud_shape_volume",
            "cloud_erosion_volume",
            "cloud_weather_map",
            "cloud_curl_map",
            "volume_sky_image",
            "cluster_masks",
        ],
        writes: &["terrain_image"],
        inputs: |facts| {
            let scene = facts.scene;
            let media = (&facts.volumes, &facts.local_lights, &scene.clouds, scene.time_s);
            Fingerprint::of(&(&scene.terrain, &scene.camera, &facts.lights, &scene.planet, media))
        },
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn need(facts: &Facts) -> Need {
    let Some(terrain) = &facts.scene.terrain else {
        return Need::NotNeeded("the ground is smooth".to_owned());
    };
    if let Some(reason) = &facts.out_of_view.terrain {
        return Need::NotNeeded(reason.clone());
    }
    if facts.surface != Some(Surface::Terrain) {
        return Need::NotNeeded("the host's surfaces stand in place of the mountains".to_owned());
    }
    let (height_m, altitude_m) = (terrain.field.height_m, facts.scene.camera.altitude_m);
    let ground_m = terrain.height_below_camera_m();
    Need::Needed(match altitude_m < ground_m {
        true => format!(
            "the camera at {altitude_m} m is inside a mountain: one sees what one sees standing on it, {ground_m:.0} m high"
        ),
        false => format!("mountains up to {height_m} m; the camera is {:.0} m above the ground", altitude_m - ground_m),
    })
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("terrain_image", shape, ImageFormat::Rgba32Float)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(shape.extent()))
}
