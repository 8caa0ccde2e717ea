//! What the air's own emission adds to every view ray from the camera's altitude.

use super::view_optical_depth::{seen_from, shape};
use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};
use crate::probe::Orders;

const NAME: &str = "view_emission";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["optical_depth_table", "emission_field"],
        writes: &["view_emission_table"],
        inputs: |facts| {
            let scene = facts.scene;
            let view = (facts.observer_altitude_m(), facts.settings.sky_view_size[1]);
            Fingerprint::of(&(&facts.emitters, &scene.planet, facts.orders, view))
        },
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

fn need(facts: &Facts) -> Need {
    if facts.emitters.is_empty() {
        return Need::NotNeeded("no constituent emits".to_owned());
    }
    Need::Needed(seen_from(facts))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    recording.resources.image("view_emission_table", shape, ImageFormat::Rgba32Float)?;
    let flags = flags(recording);
    recording.dispatch(NAME, &flags, &[], Work::Invocations(shape.extent()))
}

/// Which emission counts along a view ray.
pub(super) fn flags(recording: &Recording) -> Vec<&'static str> {
    // Emission that reaches the eye unscattered has no place among light that was scattered once.
    let all = recording.facts.orders == Orders::All;
    let scattered = recording.resources.existing_image("emission_field").is_some();
    [("EMITTED", all), ("RESCATTERED", scattered)].into_iter().filter_map(|(flag, set)| set.then_some(flag)).collect()
}
