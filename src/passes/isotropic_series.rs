//! Multiply scattered light as a geometric series of isotropic orders, the method of Hillaire 2020.

use super::first_order::{inputs, shape};
use super::{Pass, Recording, RenderError, multiple_scattering, table_format};
use crate::gpu::Work;
use crate::plan::{Declaration, Treatment};

const NAME: &str = "isotropic_series";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: |facts| multiple_scattering::need(facts, Treatment::IsotropicSeries),
        reads: &["optical_depth_table"],
        writes: &["multiple_scattering_table"],
        inputs,
        bytes: |facts| shape(facts).texels() * table_format(facts).texel_bytes(),
    },
    record,
};

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let table = recording.resources.image("multiple_scattering_table", shape, table_format(recording.facts))?;
    let [width, height, _] = shape.extent();
    let cosines = recording.facts.settings.directions.cosines();
    recording.dispatch(NAME, &[], &[("isotropic_series", &table)], Work::Invocations([width, cosines, height]))
}
