//! Clouds along every pixel's ray, from any altitude.

use super::{Pass, Recording, RenderError, joined};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "clouds";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: need_alone,
        reads: &READS,
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
                facts.surface,
                facts.keeps_cloud_distance(),
                facts.follows_clouds(),
                facts.sequence.filter(|_| facts.cloud_block() > 1),
            ))
        },
        bytes: |facts| {
            let distance = if facts.keeps_cloud_distance() { ImageFormat::R32Float.texel_bytes() } else { 0 };
            let images: u64 = images(facts).iter().map(|(_, format)| format.texel_bytes()).sum();
            marched_shape(facts).texels() * (images + distance)
        },
    },
    record,
};

/// What a march through clouds reads.
pub(super) const MARCH_READS: [&str; 10] = [
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
];

/// The same up to hills.
const READS: [&str; 11] = joined(MARCH_READS, ["terrain_image"]);

/// How frames that follow each other keep what clouds leave of other light: shares of it, which half floats hold well enough for
/// frames that go by.
pub(super) const FOLLOWED_SHARES: ImageFormat = ImageFormat::Rgba16Float;

/// What is marched into, and its format: by the names of whole pictures, and of those of which a frame marches some pixels.
fn images(facts: &Facts) -> [([&'static str; 2], ImageFormat); 3] {
    let shares = if facts.follows_clouds() { FOLLOWED_SHARES } else { ImageFormat::Rgba32Float };
    [
        (["cloud_radiance_image", "cloud_radiance_samples"], ImageFormat::Rgba32Float),
        (["cloud_air_image", "cloud_air_samples"], shares),
        (["cloud_diffuse_image", "cloud_diffuse_samples"], shares),
    ]
}
const DISTANCE: [&str; 2] = ["cloud_distance_image", "cloud_distance_samples"];

/// All pixels of the picture.
pub(super) fn whole_shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

/// One pixel of each block.
fn marched_shape(facts: &Facts) -> ImageShape {
    let [width, height] = [facts.scene.camera.width, facts.scene.camera.height];
    let block = facts.cloud_block();
    ImageShape::D2(width.div_ceil(block), height.div_ceil(block))
}

/// Among fog, volumes and local lights all media are marched together.
fn need_alone(facts: &Facts) -> Need {
    match need(facts) {
        Need::Needed(_) if facts.has_local_media() => Need::NotNeeded("marched together with local media".to_owned()),
        need => need,
    }
}

/// Whether anything is made from the clouds' noise: they themselves, or billows of fog and volumes.
pub(super) fn noise_need(facts: &Facts) -> Need {
    if facts.clouds.is_empty() && facts.has_volume_noise() {
        return Need::Needed("billows of fog or volumes".to_owned());
    }
    need(facts)
}

/// Whether there are clouds: what all passes of clouds are asked.
pub(super) fn need(facts: &Facts) -> Need {
    if facts.clouds.is_empty() {
        return Need::NotNeeded(facts.out_of_view.clouds.clone().unwrap_or_else(|| "no clouds".to_owned()));
    }
    let names: Vec<_> = facts.clouds.iter().map(|layer| layer.name.as_str()).collect();
    Need::Needed(format!("layers of clouds: {}", names.join(", ")))
}

/// What the field of density in the grids depends on besides its noise.
pub(super) fn field_inputs(facts: &Facts) -> Fingerprint {
    Fingerprint::of(&(layers_inputs(facts), facts.scene.time_s))
}

/// The same at any time.
pub(super) fn layers_inputs(facts: &Facts) -> Fingerprint {
    Fingerprint::of(&(&facts.scene.clouds, facts.settings.clouds))
}

/// What light on the grids depends on besides their field.
pub(super) fn directions_inputs(facts: &Facts) -> Fingerprint {
    let directions: Vec<_> = facts.lights.iter().map(|light| light.direction).collect();
    Fingerprint::of(&(directions, facts.scene.planet.radius_m))
}

/// The shape of so many fields on the clouds' grids.
pub(super) fn grid_shape(facts: &Facts, fields: u32) -> ImageShape {
    let settings = &facts.settings.clouds;
    let slices = settings.grid_slices * settings.grid_levels * facts.clouds.len() as u32;
    ImageShape::D3(settings.grid_size, settings.grid_size, fields * slices)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let facts = recording.facts;
    let shape = marched_shape(facts);
    let is_whole = facts.cloud_block() == 1;
    let name = |[image, samples]: [&'static str; 2]| if is_whole { image } else { samples };
    let images = images(facts);
    let mut written = Vec::new();
    for (names, format) in images {
        written.push((names[0], recording.resources.image(name(names), shape, format)?));
    }
    if facts.keeps_cloud_distance() {
        written.push((DISTANCE[0], recording.resources.image(name(DISTANCE), shape, ImageFormat::R32Float)?));
    }
    if is_whole {
        let names = images.iter().map(|(names, _)| names).chain([&DISTANCE]);
        names.for_each(|[_, samples]| recording.resources.release(samples));
    }
    let surface = recording.surface();
    written.extend(surface.map(|surface| ("surface_image", surface)));
    let bound: Vec<_> = written.iter().map(|(name, image)| (*name, image)).collect();
    recording.dispatch(NAME, &[], &bound, Work::Invocations(shape.extent()))
}
