//! When the passes that compute multiply scattered light are needed: those of one treatment at a time.

use crate::gpu::ImageShape;
use crate::plan::{Facts, Need, Treatment};
use crate::probe::Orders;

/// The shape of what is bound where the last order of light, which nobody reads, would go: by its size the shaders know that they
/// are to close the series. Sides are powers of two, and layers several, where those of the table are: llvmpipe would else compile
/// the shader again.
pub(super) fn no_order(table: ImageShape) -> ImageShape {
    let [width, height, _] = table.extent();
    let side = |of_table: u32| if of_table.is_power_of_two() { 1 } else { 3 };
    ImageShape::D2Array(side(width), side(height), table.layers().min(2))
}

/// Whether a scene calls for multiply scattered light, and by this treatment.
pub(super) fn need(facts: &Facts, treatment: Treatment) -> Need {
    let not_needed = |reason: &str| Need::NotNeeded(reason.to_owned());
    if facts.lights.is_empty() {
        return not_needed("no directional light shines");
    }
    if facts.scatterers().is_empty() {
        return not_needed("no constituent scatters");
    }
    if facts.orders == Orders::Single {
        return not_needed("only single scattering is asked for");
    }
    if let Some(reason) = facts.thin_air() {
        return not_needed(reason);
    }
    let (chosen, reason) = (facts.treatment.words(), &facts.treatment_reason);
    if facts.treatment != treatment {
        return Need::NotNeeded(format!("multiply scattered light comes from {chosen}"));
    }
    Need::Needed(format!("{} constituents scatter; {chosen}: {reason}", facts.scatterers().len()))
}
