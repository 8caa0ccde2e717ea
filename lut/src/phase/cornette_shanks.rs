//! The phase function of Cornette & Shanks 1992 (Premože 2003, eq. 6): Draine's with α = 1.
//!
//! P = 3/(8π) (1 - g²)/(2 + g²) (1 + cos²θ) / (1 + g² - 2g cos θ)^(3/2), |g| < 1. It is Rayleigh's at g = 0. Its mean
//! cosine is 3g(4 + g²) / (5(2 + g²)), not g.

use std::f64::consts::PI;

use super::{draine, henyey_greenstein};

/// P(cos θ), 1/sr.
pub(super) fn value(g: f64, cos_theta: f64) -> f64 {
    let d = henyey_greenstein::squared_distance(g, cos_theta);
    3.0 / (8.0 * PI) * (1.0 - g) * (1.0 + g) / (2.0 + g * g) * (1.0 + cos_theta * cos_theta) / (d * d.sqrt())
}

/// cos θ at which the share `u` of the light lies further back.
pub(super) fn sample(g: f64, u: f64) -> f64 {
    draine::sample(g, 1.0, u)
}

/// χ_l in closed form.
pub(super) fn legendre_moment(g: f64, l: usize) -> f64 {
    draine::legendre_moment(g, 1.0, l)
}
