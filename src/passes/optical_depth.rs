//! Optical depth to the top of the atmosphere, for every altitude and direction above the horizon.

use super::{Pass, Recording, RenderError, table_format};
use crate::gpu::{ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "optical_depth";

/// Layers have optical depths in closed form, and kinks that no table could hold.
pub(super) const FLAGS: [&str; 1] = ["OMIT_LAYERS"];

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &[],
        writes: &["optical_depth_table"],
        inputs: |facts| {
            let planet = &facts.scene.planet;
            let settings = &facts.settings;
            let medium = &facts.constituents;
            Fingerprint::of(&(
                medium,
                planet.radius_m,
                planet.atmosphere_height_m,
                settings.optical_depth_size,
                settings.optical_depth_panels,
                settings.table_format,
            ))
        },
        bytes: |facts| shape(facts).texels() * table_format(facts).texel_bytes(),
    },
    record,
};

fn shape(facts: &Facts) -> ImageShape {
    let [width, height] = facts.settings.optical_depth_size;
    ImageShape::D2(width, height)
}

fn need(facts: &Facts) -> Need {
    if !facts.has_air() {
        let vacuum = || "vacuum: no constituent absorbs or scatters".to_owned();
        return Need::NotNeeded(facts.out_of_view.air.clone().unwrap_or_else(vacuum));
    }
    Need::Needed(format!("{} constituents weaken the light", facts.constituents.len()))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("optical_depth_table", shape, table_format(recording.facts))?;
    recording.dispatch(NAME, &FLAGS, &[], Work::Invocations(shape.extent()))
}
