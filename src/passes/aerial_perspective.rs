//! The air between the camera and what stands before it, for every direction, distance and light.

use super::{Pass, Recording, RenderError, sky_view};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Surface};

const NAME: &str = "aerial_perspective";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["optical_depth_table", "multiple_scattering_table"],
        writes: &["froxel_light"],
        inputs: |facts| {
            // The rows' mapping is that of the sky view.
            let sampling = (facts.settings.froxel_size, facts.settings.sky_view_size);
            Fingerprint::of(&(facts.observer_altitude_m(), sampling)).following(sky_view::elevations(facts))
        },
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba16Float.texel_bytes(),
    },
    record,
};

/// Azimuths of each light, elevations of each half of the view sphere, slices of each layer of the sky view.
fn shape(facts: &Facts) -> ImageShape {
    let [azimuths, elevations, slices] = facts.settings.froxel_size;
    ImageShape::D3(azimuths * facts.light_slots(), 2 * elevations, slices * (1 + facts.groups.scatterer_count))
}

fn need(facts: &Facts) -> Need {
    before_surfaces(sky_view::need(facts), facts)
}

/// The need of what only surfaces and a host's froxels call for, where the sky behind them has one.
pub(super) fn before_surfaces(sky: Need, facts: &Facts) -> Need {
    match (sky, facts.surface) {
        (Need::Needed(_), None) if facts.froxels.is_some() => {
            Need::Needed("the host asks for the air before what light passes through".to_owned())
        }
        (Need::Needed(_), None) => Need::NotNeeded(match &facts.out_of_view.terrain {
            Some(reason) => reason.clone(),
            None => "nothing stands between the camera and the ground".to_owned(),
        }),
        (Need::Needed(_), Some(surface)) => Need::Needed(match surface {
            Surface::Terrain => "mountains stand in the air".to_owned(),
            Surface::Given(_) => "the host's surfaces stand in the air".to_owned(),
            Surface::Rays => "rays end in the air".to_owned(),
        }),
        (not_needed, _) => not_needed,
    }
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let [width, height, _] = shape.extent();
    let froxels = recording.resources.image("froxel_light", shape, ImageFormat::Rgba16Float)?;
    recording.dispatch(NAME, &[], &[("froxel_light_image", &froxels)], Work::Invocations([width, height, 1]))
}
