//! How the light in clouds follows them from frame to frame.
//!
//! In a sequence of frames it is relaxed from where it was, by a few sweeps, and only once what it was solved for has moved
//! by a stated share of a cell or angle. So it is never later than that, but for what a few sweeps leave of the small
//! change: `tests/cloud_pictures.rs` bounds both. Once nothing moves any more it settles: as many sweeps
//! follow, some a frame, as a frame that stands alone has.

use super::Start;
use crate::plan::{Facts, Sequence};

/// How far clouds may drift, or change, before their extinction is looked up again, in their smallest cells: half a texel.
const DRIFT_CELLS: f64 = 0.25;

/// How far the light may turn before its depths are followed again, rad.
const TURN_RAD: f64 = 0.25 * std::f64::consts::PI / 180.0;

/// From one frame to the next, the farthest drift in cells after which the light before is a start.
const WARM_CELLS: f64 = 1.0;

/// How much of the light is computed in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Relaxation {
    pub start: Start,
    pub sweeps: u32,
    /// Of frames after a movement, the number of this one until the light has settled.
    settling: Option<u32>,
}

impl Relaxation {
    /// In a frame.
    pub fn of(facts: &Facts) -> Self {
        let (sweeps, warm) = (facts.settings.clouds.sweeps, facts.settings.clouds.warm_sweeps.max(1));
        match following(facts) {
            Some(Sequence { settling: Some(frames), .. }) => {
                Self { start: Start::Warm, sweeps: warm, settling: Some(frames.min(sweeps.div_ceil(warm))) }
            }
            _ => Self { start: Start::Cold, sweeps, settling: None },
        }
    }
}

/// Where the frame stands, if the light of the one before is a start for its own.
fn following(facts: &Facts) -> Option<Sequence> {
    let sequence = facts.sequence?;
    let elapsed_s = (facts.scene.time_s - sequence.before?.time_s).abs();
    (elapsed_s * fastest_m_per_s(facts) <= WARM_CELLS * cell_m(facts)).then_some(sequence)
}

/// Whether something moves, so that what follows it may be a little late.
fn is_moving(facts: &Facts) -> bool {
    following(facts).is_some_and(|sequence| sequence.settling == Some(0))
}

fn cell_m(facts: &Facts) -> f64 {
    f64::from(facts.settings.clouds.ordinate_cell_m)
}

/// How fast clouds drift or change, whichever is faster.
fn fastest_m_per_s(facts: &Facts) -> f64 {
    let speed = |layer: &&welkin_lut::cloud::CloudLayer| {
        let [east, north] = layer.wind_m_per_s;
        east.hypot(north).max(layer.evolution_m_per_s.abs())
    };
    facts.clouds.iter().map(speed).fold(0.0, f64::max)
}

/// The clouds' time, which their extinction may lag behind.
pub fn time(facts: &Facts) -> [(f64, f64); 1] {
    let slack_s = if is_moving(facts) { DRIFT_CELLS * cell_m(facts) / fastest_m_per_s(facts).max(1e-9) } else { 0.0 };
    [(facts.scene.time_s, slack_s)]
}

/// The angles of the light whose field is solved, which it may lag behind.
pub fn angles(facts: &Facts) -> Option<[(f64, f64); 2]> {
    let light = facts.lights.get(super::light(facts))?;
    let slack_rad = if is_moving(facts) { TURN_RAD } else { 0.0 };
    // The azimuth's circle is smaller than the horizon.
    let circle = light.direction.elevation_rad.cos().max(1e-3);
    Some([(light.direction.elevation_rad, slack_rad), (light.direction.azimuth_rad, slack_rad / circle)])
}
