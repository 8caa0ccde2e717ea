//! Draine's phase function (Draine 2003, "Scattering by interstellar dust grains. I", eq. 4).
//!
//! P = P_HG(g) (1 + α cos²θ) / (1 + α (1 + 2g²)/3), |g| < 1, α ≥ 0. α = 0 is Henyey-Greenstein, α = 1 is
//! Cornette-Shanks, and g = 0 with α = 1 is Rayleigh.

use super::{henyey_greenstein, inversion};

/// 1 + α (1 + 2g²)/3: the mean of 1 + α cos²θ over the Henyey-Greenstein lobe.
fn norm(g: f64, alpha: f64) -> f64 {
    1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0
}

/// P(cos θ), 1/sr.
pub(super) fn value(g: f64, alpha: f64, cos_theta: f64) -> f64 {
    henyey_greenstein::value(g, cos_theta) * (1.0 + alpha * cos_theta * cos_theta) / norm(g, alpha)
}

/// cos θ at which the share `u` of the light lies further back.
///
/// With v the share of the Henyey-Greenstein lobe that lies further back, q₀ = 1 + g and
/// e = 2 v q₀ / (1 - g + 2 g v), the share of this one is
/// v (1 + α (1 - q₀e + q₀²e²/3 - q₀ g e³/12)) / norm,
/// which follows from integrating c² over the lobe and has neither a division by g nor a square root. Its slope in
/// v, (1 + α c²) / norm, is bounded, so Newton's method is safe.
pub(super) fn sample(g: f64, alpha: f64, u: f64) -> f64 {
    if g < 0.0 {
        // The lobe is its own mirror image; q₀ ≥ 1 keeps e bounded.
        return -sample(-g, alpha, 1.0 - u);
    }
    let norm = norm(g, alpha);
    let q0 = 1.0 + g;
    let v = inversion::invert_increasing(u, |v| {
        let e = 2.0 * v * q0 / (1.0 - g + 2.0 * g * v);
        let mean_square = 1.0 + q0 * e * (-1.0 + e * (q0 / 3.0 - g * e / 12.0));
        let cos_theta = -1.0 + e * (q0 - 0.5 * g * e);
        (v * (1.0 + alpha * mean_square) / norm, (1.0 + alpha * cos_theta * cos_theta) / norm)
    });
    henyey_greenstein::sample(g, v)
}

/// χ_l in closed form, from the Legendre expansion of c² P_l and the moments g^l of the lobe.
pub(super) fn legendre_moment(g: f64, alpha: f64, l: usize) -> f64 {
    let n = l as f64;
    let lobe = |l: usize| henyey_greenstein::legendre_moment(g, l);
    let above = (n + 1.0) * (n + 2.0) / ((2.0 * n + 1.0) * (2.0 * n + 3.0));
    let below = n * (n - 1.0) / ((2.0 * n + 1.0) * (2.0 * n - 1.0));
    let same = (n + 1.0).powi(2) / ((2.0 * n + 1.0) * (2.0 * n + 3.0)) + n * n / ((2.0 * n + 1.0) * (2.0 * n - 1.0));
    let square = above * lobe(l + 2) + same * lobe(l) + if l >= 2 { below * lobe(l - 2) } else { 0.0 };
    (lobe(l) + alpha * square) / norm(g, alpha)
}
