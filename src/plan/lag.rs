//! How far tables may lag behind a moving light.
//!
//! In a sequence of frames the sun moves by less than anyone could see, and tables that depend on its elevation would still
//! be computed for each. They may lag where light in no pixel is off by more than a share meanwhile. Directions to the
//! light, phase functions, azimuths and the ground's own angle to the light are those of the moment in every frame: only
//! what the tables hold is late.

use crate::scene::DirectionalLight;

/// By how much light in a pixel is off, relatively, for each degree that tables lag: the largest over scenes, altitudes and
/// views at an elevation in degrees, measured by `cargo run --release --example light_slopes`.
const ERRORS_PER_DEG: [(f64, f64); 14] = [
    (0.0, 5.14),
    (1.0, 4.39),
    (2.0, 6.87),
    (3.0, 3.47),
    (5.0, 0.917),
    (7.0, 1.12),
    (10.0, 0.764),
    (15.0, 0.324),
    (20.0, 0.109),
    (30.0, 0.0296),
    (45.0, 0.0224),
    (60.0, 0.0409),
    (75.0, 0.0663),
    (89.0, 0.0148),
];

/// How much steeper it may be between the elevations, in other scenes and from other places.
const SAFETY: f64 = 2.0;

/// How far a light's elevation may move before tables are off by a share, rad; an infinite share lets them lag for ever.
/// Nothing else may lag behind a light below the lowest elevation that was measured: there the planet's shadow wanders
/// through the picture.
pub fn elevation_slack_rad(light: &DirectionalLight, share: f64) -> f64 {
    if share == f64::INFINITY {
        return share;
    }
    let elevation_deg = light.direction.elevation_rad.to_degrees();
    let above = ERRORS_PER_DEG.partition_point(|&(measured_deg, _)| measured_deg <= elevation_deg);
    let Some(&(_, below_error)) = above.checked_sub(1).and_then(|below| ERRORS_PER_DEG.get(below)) else { return 0.0 };
    let above_error = ERRORS_PER_DEG.get(above).map_or(below_error, |&(_, error)| error);
    (share / (SAFETY * below_error.max(above_error))).to_radians()
}
