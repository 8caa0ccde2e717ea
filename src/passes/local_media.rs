//! The march through the sum of all media where a scene has fog, local volumes or local lights: of every pixel, or of those between which
//! `media_interpolation` fills the others, and then also up to several distances before what a host has drawn.

use super::{Pass, Recording, RenderError, clouds, joined, media_interpolation, volume_light};
use crate::gpu::{GpuImage, ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, media_froxels};

const NAME: &str = "local_media";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: volume_light::need,
        reads: &READS,
        writes: &WRITES,
        inputs,
        bytes: |facts| {
            let froxels = froxel_shape(facts).map_or(0, |shape| shape.texels());
            (4 * shape(facts).texels() + froxels) * ImageFormat::Rgba32Float.texel_bytes()
        },
    },
    record,
};

/// What a ray is marched through.
pub(super) const MARCH_READS: [&str; 14] =
    joined(clouds::MARCH_READS, ["volume_light_image", "volume_sky_image", "cluster_masks", "lamp_froxels"]);

/// The same and what it meets.
const READS: [&str; 16] = joined(MARCH_READS, ["terrain_image", "surface_cells"]);

/// What is known of each pixel.
const IMAGES: [&str; 4] =
    ["media_radiance_image", "media_transmittance_image", "media_beam_image", "media_diffuse_image"];

/// What is known before places on the lattice's rays.
const FROXELS: &str = "media_froxels";

/// All that it writes.
pub(super) const WRITES: [&str; 5] = [IMAGES[0], IMAGES[1], IMAGES[2], IMAGES[3], FROXELS];

pub(super) fn inputs(facts: &Facts) -> Fingerprint {
    Fingerprint::of(&(march_inputs(facts), facts.surface))
}

/// What a march depends on besides what it reads, whatever stands before the camera.
pub(super) fn march_inputs(facts: &Facts) -> Fingerprint {
    let scene = facts.scene;
    let settings = (facts.settings.clouds, facts.settings.volumes, facts.settings.multiple_scattering_size);
    let media = (&facts.volumes, &facts.local_lights, &scene.clouds, scene.time_s);
    Fingerprint::of(&(&scene.camera, &facts.lights, &scene.planet, media, settings))
}

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn froxel_shape(facts: &Facts) -> Option<ImageShape> {
    media_froxels(facts).ok().map(|[columns, rows, layers]| ImageShape::D3(columns, rows, layers))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    if let Some(froxels) = froxel_shape(recording.facts) {
        recording.resources.image(FROXELS, froxels, ImageFormat::Rgba32Float)?;
    }
    for name in IMAGES {
        recording.resources.image(name, shape, ImageFormat::Rgba32Float)?;
    }
    let work = match media_interpolation::cells(recording.facts) {
        // Nothing is listed: the pixels of the lattice.
        Some([columns, rows]) => {
            media_interpolation::empty_list(recording, [columns, rows])?;
            Work::Invocations([columns, rows, 2])
        }
        None => Work::Invocations(shape.extent()),
    };
    march(recording, work)
}

/// Marches pixels.
pub(super) fn march(recording: &mut Recording, work: Work) -> Result<(), RenderError> {
    let surface = recording.surface();
    recording.dispatch(NAME, &[], &surface_images(&surface), work)
}

/// What stands before the camera, under the name that shaders have for it.
pub(super) fn surface_images(surface: &Option<GpuImage>) -> Vec<(&'static str, &GpuImage)> {
    surface.iter().map(|image| ("surface_image", image)).collect()
}
