//! The integrals that the sky seen from the camera's altitude is made of, for every direction and light.

use super::{Pass, Recording, RenderError, table_format, view_optical_depth};
use crate::gpu::{DeviceKind, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need, elevation_slack_rad};

const NAME: &str = "sky_view";

/// Columns that one invocation fills where there are few invocations: their rays pass the same air.
pub(super) const FAN_COUNT: u32 = 4;

/// Beside the edge of the planet's shadow light goes out within a few kilometres, and the edge runs aslant through the
/// table's columns: where it is in view there are so many times more of them.
const COLUMNS_AT_EDGE_OF_SHADOW: u32 = 2;

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["optical_depth_table", "view_optical_depth_table", "multiple_scattering_table"],
        writes: &["sky_view_table"],
        inputs: |facts| {
            // Azimuths in the table count from the light, so only elevations matter, and a disc's width where it does.
            let disc = |light| facts.is_wide(light).then_some((light.angular_radius_rad, light.limb_darkening));
            let discs: Vec<_> = facts.lights.iter().map(|light| disc(light)).collect();
            let settings = &facts.settings;
            let sampling = (settings.nodes_per_leg, settings.quadrature, size(facts));
            let observer = (facts.observer_altitude_m(), facts.is_in_shadow(), facts.sees_edge_of_shadow());
            Fingerprint::of(&(discs, observer, sampling)).following(elevations(facts))
        },
        bytes: |facts| shape(facts).texels() * table_format(facts).texel_bytes(),
    },
    record,
};

/// Elevations of the lights, with how far tables may lag behind them.
pub(super) fn elevations(facts: &Facts) -> impl Iterator<Item = (f64, f64)> {
    let share = facts.settings.skipping.lag_share;
    facts.lights.iter().map(move |light| (light.direction.elevation_rad, elevation_slack_rad(light, share)))
}

/// Azimuths and elevations of each half.
fn size(facts: &Facts) -> [u32; 2] {
    let [columns, rows] = facts.settings.sky_view_size;
    // What columns there are stay where they are: nothing pops.
    let between = if facts.sees_edge_of_shadow() { COLUMNS_AT_EDGE_OF_SHADOW - 1 } else { 0 };
    [columns + between * (columns - 1), rows]
}

fn shape(facts: &Facts) -> ImageShape {
    let [width, height] = size(facts);
    ImageShape::D2Array(width, height, facts.sky_view_layers())
}

pub(super) fn need(facts: &Facts) -> Need {
    if let Need::NotNeeded(reason) = view_optical_depth::need(facts) {
        return Need::NotNeeded(reason);
    }
    if facts.lights.is_empty() {
        let why = if facts.left_out.is_empty() { "no directional light shines" } else { &facts.left_out.join("; ") };
        return Need::NotNeeded(why.to_owned());
    }
    if facts.scatterers().is_empty() {
        return Need::NotNeeded("no constituent scatters".to_owned());
    }
    let wide: Vec<_> = facts.lights.iter().filter(|light| facts.is_wide(light)).map(|l| l.name.as_str()).collect();
    let averaged = match wide.is_empty() {
        true => String::new(),
        false => format!("; light is averaged over the disc of {}, which stands low", wide.join(", ")),
    };
    let left_out: String = facts.left_out.iter().map(|reason| format!("; {reason}")).collect();
    Need::Needed(format!("{}{averaged}{left_out}", view_optical_depth::seen_from(facts)))
}

/// A GPU wants more invocations than it has columns; a processor wants less work.
fn in_fans(recording: &Recording) -> bool {
    recording.resources.gpu.info().kind == DeviceKind::Cpu
}

pub(super) fn flags(recording: &Recording) -> Vec<&'static str> {
    in_fans(recording).then_some("FANS").into_iter().collect()
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let [width, height, _] = shape.extent();
    let table = recording.resources.image("sky_view_table", shape, table_format(recording.facts))?;
    let halves = 2 * recording.facts.light_slots();
    let columns = if in_fans(recording) { FAN_COUNT } else { 1 };
    let work = Work::Invocations([width.div_ceil(columns), height, halves]);
    recording.dispatch(NAME, &flags(recording), &[("sky_view_image", &table)], work)
}
