//! Isotropic scattering: every direction alike (Premože 2003, eq. 1).

use std::f64::consts::PI;

/// 1/4π, 1/sr.
pub(super) fn value() -> f64 {
    0.25 / PI
}

/// cos θ at which the share `u` of the light lies further back.
pub(super) fn sample(u: f64) -> f64 {
    2.0 * u - 1.0
}
