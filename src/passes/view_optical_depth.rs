//! Optical depth of the air along every view ray from the camera's altitude.

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Viewpoint};

const NAME: &str = "view_optical_depth";

/// Rows between two rows of the sky view: transmittance is what an engine multiplies everything by, and rows are cheap.
const ROWS_PER_SKY_VIEW_ROW: u32 = 16;

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        // The same air as that of the table of optical depth, though nothing is read from it.
        reads: &["optical_depth_table"],
        writes: &["view_optical_depth_table"],
        inputs: |facts| {
            let settings = &facts.settings;
            Fingerprint::of(&(facts.observer_altitude_m(), settings.sky_view_size[1], settings.optical_depth_panels))
        },
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

/// Two columns, for the sky's half and the ground's. Every row of the sky view is one of its rows.
pub(super) fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(2, ROWS_PER_SKY_VIEW_ROW * (facts.settings.sky_view_size[1] - 1) + 1)
}

pub(super) fn need(facts: &Facts) -> Need {
    if !facts.has_air() {
        let vacuum = || "vacuum: no constituent absorbs or scatters".to_owned();
        return Need::NotNeeded(facts.out_of_view.air.clone().unwrap_or_else(vacuum));
    }
    Need::Needed(seen_from(facts))
}

/// Where the air is seen from, in words.
pub(super) fn seen_from(facts: &Facts) -> String {
    let place = if facts.viewpoint == Viewpoint::InSpace { "from space" } else { "from within" };
    let altitude_m = facts.scene.camera.altitude_m;
    if altitude_m < 0.0 {
        return format!("the camera is {} m below the ground: the air is seen from there", -altitude_m);
    }
    format!("the air is seen {place}, {altitude_m} m above the ground")
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("view_optical_depth_table", shape, ImageFormat::Rgba32Float)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(shape.extent()))
}
