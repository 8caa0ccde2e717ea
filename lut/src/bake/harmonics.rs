//! Real spherical harmonics that are even in azimuth, which is all that a field symmetric about the light's plane has.
//!
//! Coefficient l(l + 1)/2 + m is that of Y_lm, m ≥ 0, orthonormal on the sphere.

use std::f64::consts::PI;

/// Degrees that tables of multiple scattering keep.
const DEGREES: usize = 3;

/// Coefficients of so many degrees.
const COEFFICIENTS: usize = DEGREES * (DEGREES + 1) / 2;

/// The same without that of degree 0.
pub(super) const HARMONIC_COUNT: usize = COEFFICIENTS - 1;

/// Y_lm(μ, φ).
///
/// By the stable recurrence over l from the sectoral functions, without Condon and Shortley's sign (Press et al.,
/// Numerical Recipes, section 6.7).
pub(super) fn harmonics(mu: f64, cos_phi: f64) -> [f64; COEFFICIENTS] {
    let mut y = [0.0; COEFFICIENTS];
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    let (mut cos_before, mut cos_m) = (cos_phi, 1.0);
    let mut sectoral = (0.25 / PI).sqrt();
    for m in 0..DEGREES {
        if m > 0 {
            // From order 0 to 1 the cosine's norm brings a factor of two more.
            let norm = if m == 1 { 2.0 } else { 1.0 };
            sectoral *= (norm * (1.0 + 0.5 / m as f64)).sqrt() * sine;
            (cos_before, cos_m) = (cos_m, 2.0 * cos_phi * cos_m - cos_before);
        }
        let (mut before, mut value) = (0.0, sectoral);
        for l in m..DEGREES {
            y[l * (l + 1) / 2 + m] = value * cos_m;
            let (a, b, c) = (((l + 1) * (l + 1)) as f64, (m * m) as f64, (l * l) as f64);
            let lower = ((c - b) / (4.0 * c - 1.0)).max(0.0).sqrt();
            (before, value) = (value, ((4.0 * a - 1.0) / (a - b)).sqrt() * (mu * value - lower * before));
        }
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::gauss_legendre;

    #[test]
    fn the_harmonics_are_orthonormal() {
        let azimuths = 16;
        let mut products = vec![[0.0; COEFFICIENTS]; COEFFICIENTS];
        for node in gauss_legendre(12) {
            for k in 0..azimuths {
                let phi = (f64::from(k) + 0.5) * PI / f64::from(azimuths);
                let y = harmonics(2.0 * node.abscissa - 1.0, phi.cos());
                // Both mirror images.
                let weight = 2.0 * node.weight * 2.0 * PI / f64::from(azimuths);
                for (i, row) in products.iter_mut().enumerate() {
                    row.iter_mut().zip(&y).for_each(|(sum, other)| *sum += weight * y[i] * other);
                }
            }
        }
        for (i, row) in products.iter().enumerate() {
            for (j, product) in row.iter().enumerate() {
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-12, "{i}, {j}: {product}");
            }
        }
    }
}
