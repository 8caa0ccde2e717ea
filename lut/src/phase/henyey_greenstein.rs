//! The phase function of Henyey & Greenstein 1941 (Premože 2003, eq. 2).
//!
//! P = (1 - g²) / (4π (1 + g² - 2g cos θ)^(3/2)), |g| < 1, mean cosine g.

use std::f64::consts::PI;

/// 1 + g² - 2g cos θ without the cancellation near the peak.
///
/// Written as (1 - |g|)² + 2|g| (1 - cos θ'), with θ' counted from the peak, it is exact at the peak itself.
pub(super) fn squared_distance(g: f64, cos_theta: f64) -> f64 {
    let (g, along) = if g < 0.0 { (-g, -cos_theta) } else { (g, cos_theta) };
    (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - along)
}

/// P(cos θ), 1/sr.
pub(super) fn value(g: f64, cos_theta: f64) -> f64 {
    let d = squared_distance(g, cos_theta);
    (1.0 - g) * (1.0 + g) / (4.0 * PI * d * d.sqrt())
}

/// cos θ at which the share `u` of the light lies further back.
///
/// The usual inversion divides by g and subtracts squares. Solved for 1 + c and 1 - c instead, both are products:
/// 1 + c = 2 (1 + g)² u (1 - g (1 - u)) / t² and 1 - c = 2 (1 - g)² (1 - u)(1 + g u) / t², t = 1 - g + 2 g u,
/// so it holds from g = 0 to |g| → 1, and c never leaves [-1, 1].
pub(super) fn sample(g: f64, u: f64) -> f64 {
    let t = 1.0 - g + 2.0 * g * u;
    let one_plus_cos = 2.0 * (1.0 + g) * (1.0 + g) * u * (1.0 - g * (1.0 - u)) / (t * t);
    if one_plus_cos < 1.0 {
        return one_plus_cos - 1.0;
    }
    let one_minus_cos = 2.0 * (1.0 - g) * (1.0 - g) * (1.0 - u) * (1.0 + g * u) / (t * t);
    1.0 - one_minus_cos
}

/// χ_l = g^l.
pub(super) fn legendre_moment(g: f64, l: usize) -> f64 {
    g.powi(l as i32)
}
