//! Moments of light around a point light that was scattered once, where little has been lost.

use std::f64::consts::PI;

use crate::PhaseFunction;
use crate::legendre::legendre;

/// Angles at which integrals are taken.
const ANGLES: usize = 4096;

/// A_l = 2π ∫ P(Θ) ∫₀^Θ P_l(cos θ) dθ dΘ of the degrees below `count`; A_1 is 1 for all phase functions.
pub fn moments(phase: &PhaseFunction, count: usize) -> Vec<f64> {
    // Angles crowd where phase functions peak, forward and backward.
    let from_end = |i: usize| 0.5 * PI * (2.0 * i as f64 / ANGLES as f64).powi(3);
    let angle = |i: usize| if i <= ANGLES / 2 { from_end(i) } else { PI - from_end(ANGLES - i) };
    let mut within = vec![0.0; count];
    let mut sums = vec![0.0; count];
    let mut whole = 0.0;
    for i in 0..ANGLES {
        let (near, far) = (angle(i), angle(i + 1));
        let (middle, width) = (0.5 * (near + far), far - near);
        let scattered = 2.0 * PI * phase.value(middle.cos()) * width;
        whole += scattered * middle.sin();
        for (l, p) in legendre(count, middle.cos()).enumerate() {
            sums[l] += scattered * (within[l] + 0.5 * p * width);
            within[l] += p * width;
        }
    }
    sums.iter().map(|sum| sum / whole).collect()
}
