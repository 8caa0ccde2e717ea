//! Light scattered once, or reflected once by the ground, as spherical harmonics at every altitude and sun.

use super::{Pass, Recording, RenderError, multiple_scattering, table_format};
use crate::gpu::{ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Treatment};

const NAME: &str = "first_order";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["optical_depth_table"],
        writes: &["first_order"],
        inputs,
        bytes: |facts| shape(facts).texels() * table_format(facts).texel_bytes(),
    },
    record,
};

/// The table's shape: a layer for each coefficient and one for irradiance.
pub(super) fn shape(facts: &Facts) -> ImageShape {
    let [width, height] = facts.settings.multiple_scattering_size;
    ImageShape::D2Array(width, height, facts.coefficient_count() + 1)
}

/// One workgroup per texel.
pub(super) fn work(facts: &Facts) -> Work<'static> {
    let [width, height] = facts.settings.multiple_scattering_size;
    Work::Workgroups([width, height, 1])
}

/// What all of the multiply scattered field depends on besides optical depth.
pub(super) fn inputs(facts: &Facts) -> Fingerprint {
    let settings = &facts.settings;
    let quadrature = (settings.nodes_per_leg, settings.quadrature, settings.directions);
    let sampling = (quadrature, facts.degree_count(), settings.multiple_scattering_size);
    Fingerprint::of(&(facts.scene.planet.ground_albedo, settings.orders, sampling))
}

pub(super) fn need(facts: &Facts) -> Need {
    multiple_scattering::need(facts, Treatment::Harmonics)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    recording.resources.image("first_order", shape(recording.facts), table_format(recording.facts))?;
    recording.dispatch(NAME, &[], &[], work(recording.facts))
}
