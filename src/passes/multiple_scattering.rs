//! When the passes that compute multiply scattered light are needed: those of one treatment at a time.

use crate::plan::{Facts, Need, Treatment};
use crate::probe::Orders;

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
