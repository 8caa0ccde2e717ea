//! The source function of light scattered once, or reflected once by the ground, at every altitude and sun.

use super::{Pass, Recording, RenderError, multiple_scattering, table_format};
use crate::gpu::{ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, Treatment};

const NAME: &str = "first_source";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["optical_depth_table"],
        writes: &["first_source"],
        inputs,
        bytes: |facts| shape(facts).texels() * table_format(facts).texel_bytes(),
    },
    record,
};

/// The table's shape: tiles by azimuth and zenith angle, and one row more for moments; a layer for each profile.
pub(super) fn shape(facts: &Facts) -> ImageShape {
    let ([width, height], [columns, rows]) = (facts.settings.source_size, facts.source_grid().tiles());
    ImageShape::D2Array(width * columns, height * rows, facts.profile_group_count())
}

/// One workgroup per texel of a tile.
pub(super) fn work(facts: &Facts) -> Work<'static> {
    let [width, height] = facts.settings.source_size;
    Work::Workgroups([width, height, 1])
}

/// What the source function depends on besides optical depth.
pub(super) fn inputs(facts: &Facts) -> Fingerprint {
    let settings = &facts.settings;
    let sampling = (
        (settings.nodes_per_leg, settings.quadrature),
        facts.source_grid(),
        settings.source_size,
        settings.source_orders,
    );
    Fingerprint::of(&(facts.scene.planet.ground_albedo, sampling))
}

pub(super) fn need(facts: &Facts) -> Need {
    multiple_scattering::need(facts, Treatment::SourceFunction)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    recording.resources.image("first_source", shape(recording.facts), table_format(recording.facts))?;
    recording.dispatch(NAME, &[], &[], work(recording.facts))
}
