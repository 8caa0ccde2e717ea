//! Optical depth of the air between the camera and what stands before it, and the light that this air gives off by
//! itself, for every zenith angle and distance.

use super::aerial_perspective::before_surfaces;
use super::{Pass, Recording, RenderError, table_format, view_emission, view_optical_depth};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "aerial_optical_depth";

/// Rows between two rows of the froxels: transmittance varies most of all with the zenith angle, and rows are cheap.
const ROWS_PER_FROXEL_ROW: u32 = 4;
/// Slices between two slices of the froxels.
const SLICES_PER_FROXEL_SLICE: u32 = 2;

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        // The same air as that of the table of optical depth, though nothing is read from it.
        reads: &["optical_depth_table", "emission_field"],
        writes: &["froxel_optical_depth", "froxel_emission"],
        inputs: |facts| {
            let sampling = (facts.settings.froxel_size, facts.settings.sky_view_size);
            Fingerprint::of(&(facts.observer_altitude_m(), sampling, &facts.emitters, facts.orders))
        },
        bytes: |facts| {
            let exact = ImageFormat::Rgba32Float.texel_bytes();
            let emission = if facts.emitters.is_empty() { 0 } else { exact };
            shape(facts).texels() * (table_format(facts).texel_bytes() + emission)
        },
    },
    record,
};

/// Slices, and elevations of each half of the view sphere.
fn shape(facts: &Facts) -> ImageShape {
    let [_, elevations, slices] = facts.settings.froxel_size;
    let rows = ROWS_PER_FROXEL_ROW * (elevations - 1) + 1;
    ImageShape::D2(SLICES_PER_FROXEL_SLICE * (slices - 1) + 1, 2 * rows)
}

fn need(facts: &Facts) -> Need {
    before_surfaces(view_optical_depth::need(facts), facts)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let [_, rows, _] = shape.extent();
    let table = recording.resources.image("froxel_optical_depth", shape, table_format(recording.facts))?;
    let mut images = vec![("froxel_optical_depth_image", &table)];
    let emission = match recording.facts.emitters.is_empty() {
        true => None,
        false => Some(recording.resources.image("froxel_emission", shape, ImageFormat::Rgba32Float)?),
    };
    images.extend(emission.iter().map(|image| ("froxel_emission_image", image)));
    let flags = if emission.is_some() { view_emission::flags(recording) } else { Vec::new() };
    recording.dispatch(NAME, &flags, &images, Work::Invocations([2, rows / 2, 1]))
}
