//! Light of local lights far from a place, for froxels before the camera.

use super::blocks::local_light_count;
use super::local_clusters::TILE;
use super::{Pass, Recording, RenderError, volume_light};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "lamp_froxels";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["cloud_shape_volume", "cloud_erosion_volume", "cloud_weather_map", "cloud_curl_map", "cluster_masks"],
        writes: &["lamp_froxels"],
        inputs: |facts| {
            let scene = facts.scene;
            let clouds = (&scene.clouds, facts.cloud_scattering());
            let media = (&facts.volumes, &facts.local_lights, scene.time_s, clouds);
            Fingerprint::of(&(&facts.scene.camera, media, facts.scene.planet.radius_m, facts.settings.volumes))
        },
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

/// From so many lights on froxels are cheaper than every light in every step.
const FEWEST_LIGHTS: u32 = 8;
/// Slices of distance: WGSL `SLICES`.
const SLICES: u32 = 42;

/// Whether a scene has so many lights that froxels hold the light of those that are far.
pub fn are_there(facts: &Facts) -> bool {
    local_light_count(facts) >= FEWEST_LIGHTS
}

fn need(facts: &Facts) -> Need {
    match volume_light::need(facts) {
        Need::Needed(_) if !are_there(facts) => {
            Need::NotNeeded(format!("local lights: {}; each is looked at in every step", local_light_count(facts)))
        }
        need => need,
    }
}

fn shape(facts: &Facts) -> ImageShape {
    let camera = &facts.scene.camera;
    let [columns, rows] = [camera.width, camera.height].map(|pixels| pixels.div_ceil(TILE) + 1);
    ImageShape::D3(columns, rows, SLICES * (facts.fog_count() + 1))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image(NAME, shape, ImageFormat::Rgba32Float)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(shape.extent()))
}
