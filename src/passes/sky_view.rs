//! The integrals that the sky seen from the camera's altitude is made of, for every direction and light.

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Viewpoint};

const NAME: &str = "sky_view";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["optical_depth_table", "multiple_scattering_table"],
        writes: &["sky_view_table"],
        inputs: |facts| {
            // Azimuths in the table count from the light, so only elevations matter.
            let elevations: Vec<_> = facts.lights.iter().map(|light| light.direction.elevation_rad).collect();
            let settings = &facts.settings;
            Fingerprint::of(&(elevations, facts.observer_altitude_m(), settings.nodes_per_leg, settings.sky_view_size))
        },
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    let [width, height] = facts.settings.sky_view_size;
    ImageShape::D2Array(width, height, facts.sky_view_layers())
}

pub(super) fn need(facts: &Facts) -> Need {
    if !facts.has_air() {
        return Need::NotNeeded("vacuum: no constituent absorbs or scatters".to_owned());
    }
    let place = if facts.viewpoint == Viewpoint::InSpace { "from space" } else { "from within" };
    let altitude_m = facts.scene.camera.altitude_m;
    if altitude_m < 0.0 {
        return Need::Needed(format!("the camera is {} m below the ground: the air is seen from there", -altitude_m));
    }
    Need::Needed(format!("the air is seen {place}, {altitude_m} m above the ground"))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let [width, height, _] = shape.extent();
    let table = recording.resources.image("sky_view_table", shape, ImageFormat::Rgba32Float)?;
    let halves = 2 * recording.facts.light_slots();
    recording.dispatch(NAME, &[], &[("sky_view_image", &table)], Work::Invocations([width, height, halves]))
}
