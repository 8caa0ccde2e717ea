//! Two Henyey-Greenstein lobes (Kattawar 1975; Premože 2003, eq. 3, where f = 1 - weight).
//!
//! P = w P_HG(g₁) + (1 - w) P_HG(g₂), 0 ≤ w ≤ 1; usually g₁ > 0 and g₂ < 0.

use super::henyey_greenstein;

/// P(cos θ), 1/sr.
pub(super) fn value(weight: f64, g1: f64, g2: f64, cos_theta: f64) -> f64 {
    weight * henyey_greenstein::value(g1, cos_theta) + (1.0 - weight) * henyey_greenstein::value(g2, cos_theta)
}

/// Draws a lobe with the lower or upper part of `u`, then cos θ with what is left of it.
pub(super) fn sample(weight: f64, g1: f64, g2: f64, u: f64) -> f64 {
    if u < weight {
        henyey_greenstein::sample(g1, u / weight)
    } else {
        henyey_greenstein::sample(g2, (u - weight) / (1.0 - weight))
    }
}

/// The lobes' moments, weighted.
pub(super) fn legendre_moment(weight: f64, g1: f64, g2: f64, l: usize) -> f64 {
    weight * henyey_greenstein::legendre_moment(g1, l) + (1.0 - weight) * henyey_greenstein::legendre_moment(g2, l)
}
