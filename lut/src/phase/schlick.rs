//! Schlick's rational approximation of Henyey-Greenstein (Blasi, Le Saëc & Schlick 1993; Premože 2003, eq. 4).
//!
//! P = (1 - k²) / (4π (1 - k cos θ)²), |k| < 1. Several publications write 1 + k cos θ; here, as with g, k > 0 is
//! forward.

use std::f64::consts::PI;

use super::quadrature;

/// P(cos θ), 1/sr.
pub(super) fn value(k: f64, cos_theta: f64) -> f64 {
    let (k, along) = if k < 0.0 { (-k, -cos_theta) } else { (k, cos_theta) };
    // 1 - k c, exact at the peak.
    let d = (1.0 - k) + k * (1.0 - along);
    (1.0 - k) * (1.0 + k) / (4.0 * PI * d * d)
}

/// cos θ at which the share `u` of the light lies further back: 1 - c = 2 (1 - k)(1 - u) / (1 - k + 2 k u).
pub(super) fn sample(k: f64, u: f64) -> f64 {
    let t = 1.0 - k + 2.0 * k * u;
    let one_plus_cos = 2.0 * (1.0 + k) * u / t;
    if one_plus_cos < 1.0 { one_plus_cos - 1.0 } else { 1.0 - 2.0 * (1.0 - k) * (1.0 - u) / t }
}

/// χ_l by quadrature: its closed form, a derivative of a Legendre function of the second kind, cancels for small k.
pub(super) fn legendre_moment(k: f64, l: usize) -> f64 {
    2.0 * PI * quadrature::integrate(|c| value(k, c) * quadrature::legendre(l, c))
}
