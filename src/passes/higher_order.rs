//! Light of the second and all later orders, one order after the other, and the sum of all.

use super::first_order::{inputs, need, shape, work};
use super::multiple_scattering::no_order;
use super::{Pass, Recording, RenderError, table_format};
use crate::plan::Declaration;

const NAME: &str = "higher_order";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["first_order", "optical_depth_table"],
        writes: &["multiple_scattering_table"],
        inputs,
        bytes: |facts| shape(facts).texels() * table_format(facts).texel_bytes(),
    },
    record,
};

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let format = table_format(recording.facts);
    let mut order = recording.resources.image("first_order", shape, format)?;
    let mut sum = order.clone();
    let last = recording.facts.settings.orders;
    for n in 2..last {
        let next = recording.resources.gpu.image(&format!("order_{n}"), shape, format)?;
        let next_sum = recording.resources.gpu.image(&format!("sum_{n}"), shape, format)?;
        let images = [("previous_order", &order), ("previous_sum", &sum), ("order", &next), ("sum", &next_sum)];
        recording.dispatch(NAME, &[], &images, work(recording.facts))?;
        (order, sum) = (next, next_sum);
    }
    let table = recording.resources.image("multiple_scattering_table", shape, format)?;
    let none = recording.resources.gpu.image("no_order", no_order(shape), format)?;
    let images = [("previous_order", &order), ("previous_sum", &sum), ("order", &none), ("sum", &table)];
    recording.dispatch(NAME, &[], &images, work(recording.facts))
}
