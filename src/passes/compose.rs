//! Linear radiance of every pixel.

use super::display::pre_exposure;
use super::{Pass, Recording, RenderError};
use crate::gpu::{GpuImage, ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, lattice_cell};

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
            "exact_cells",
        ],
        writes: &["radiance_image", "transmittance_image", "distance_image"],
        inputs,
        bytes: |facts| {
            let pixels = shape(facts).texels();
            let capture = ImageFormat::Rgba32Float.texel_bytes() + ImageFormat::R32Float.texel_bytes();
            pixels * (radiance_format(facts).texel_bytes() + if facts.outputs.capture { capture } else { 0 })
        },
    },
    record,
};

/// What a pixel depends on besides what passes leave.
pub(super) fn inputs(facts: &Facts) -> Fingerprint {
    let scene = facts.scene;
    let lights = (&facts.lights, &facts.faint_discs);
    let request = (facts.outputs.capture, facts.surface, facts.settings.lattice_tolerance.to_bits());
    let kept_as = (facts.for_screen, pre_exposure(facts).to_bits());
    Fingerprint::of(&(&scene.camera, lights, &scene.planet, request, kept_as))
}

fn radiance_format(facts: &Facts) -> ImageFormat {
    if facts.for_screen { ImageFormat::Rgba16Float } else { ImageFormat::Rgba32Float }
}

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(facts.scene.camera.width, facts.scene.camera.height)
}

fn need(facts: &Facts) -> Need {
    let camera = &facts.scene.camera;
    let size = format!("{} x {} pixels", camera.width, camera.height);
    Need::Needed(match lattice_cell(facts) {
        Ok(_) => format!("those of {size} that cannot be interpolated"),
        Err(_) => size,
    })
}

/// The images of a frame.
pub(super) struct Images {
    pub(super) shape: ImageShape,
    /// What stands before the camera.
    pub(super) surface: Option<GpuImage>,
}

/// Makes the images that pixels are written to.
pub(super) fn images(recording: &mut Recording) -> Result<Images, RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("radiance_image", shape, radiance_format(recording.facts))?;
    if recording.facts.outputs.capture {
        recording.resources.image("transmittance_image", shape, ImageFormat::Rgba32Float)?;
        recording.resources.image("distance_image", shape, ImageFormat::R32Float)?;
    }
    let surface = recording.surface();
    Ok(Images { shape, surface })
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let images = images(recording)?;
    let surface: Vec<_> = images.surface.iter().map(|image| ("surface_image", image)).collect();
    let listed = lattice_cell(recording.facts).ok().and(recording.resources.existing_buffer("exact_cells").cloned());
    let work = match &listed {
        Some(cells) => Work::Counted(cells),
        None => Work::Invocations(images.shape.extent()),
    };
    recording.dispatch(NAME, &[], &surface, work)
}
