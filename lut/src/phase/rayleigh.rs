//! Scattering by particles much smaller than the wavelength (Rayleigh 1871; Premože 2003, eq. 5).
//!
//! P = 3/(16π) (1 + cos²θ). The λ⁻⁴ of the published form belongs to the scattering coefficient; depolarisation is
//! left out.

use std::f64::consts::PI;

/// P(cos θ), 1/sr.
pub(super) fn value(cos_theta: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + cos_theta * cos_theta)
}

/// cos θ at which the share `u` of the light lies further back: the real root of c³ + 3c = 2w, w = 4u - 2, by
/// Cardano's formula.
pub(super) fn sample(u: f64) -> f64 {
    let w = 4.0 * u - 2.0;
    // The larger of the two cube roots, so that nothing cancels; the other is its negative reciprocal.
    let root = (w.abs() + (w * w + 1.0).sqrt()).cbrt();
    (root - root.recip()).copysign(w).clamp(-1.0, 1.0)
}
