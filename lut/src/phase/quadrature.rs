//! Integrals over cos θ of functions that peak at either end.

use std::sync::LazyLock;

use crate::quadrature::{GaussNode, gauss_legendre};

/// Points of the rule on one panel.
const POINTS: usize = 16;

/// Panels from the middle to one end; each is half as long as the one before, the last two equally long. A phase
/// function's singularity lies beyond the end by (1 - g)²/2g, 5e-9 at g = 0.9999, so the last panels are shorter.
const PANELS: i32 = 32;

/// The Gauss-Legendre rule on [0, 1] with [`POINTS`] points.
static RULE: LazyLock<Vec<GaussNode>> = LazyLock::new(|| gauss_legendre(POINTS));

/// The Legendre polynomial P_l(x).
pub(super) fn legendre(l: usize, x: f64) -> f64 {
    let (mut previous, mut current) = (0.0, 1.0);
    for k in 0..l {
        let k = k as f64;
        (previous, current) = (current, ((2.0 * k + 1.0) * x * current - k * previous) / (k + 1.0));
    }
    current
}

/// ∫ f dx over [a, b]; exact for polynomials of degree 31.
pub(super) fn integrate_panel(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    (b - a) * RULE.iter().map(|node| node.weight * f(a + (b - a) * node.abscissa)).sum::<f64>()
}

/// ∫ f dx over [-1, 1] for an f that is smooth inside, however steep towards the ends.
pub(super) fn integrate(f: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for panel in 0..PANELS {
        let outer = 0.5_f64.powi(panel);
        let inner = if panel == PANELS - 1 { 0.0 } else { 0.5 * outer };
        sum += integrate_panel(inner, outer, |gap| f(1.0 - gap) + f(gap - 1.0));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_up_to_degree_31_and_not_of_degree_80() {
        let error = |degree: i32| (integrate_panel(0.0, 1.0, |x| x.powi(degree)) * f64::from(degree + 1) - 1.0).abs();
        for degree in 0..=31 {
            assert!(error(degree) < 1e-14, "degree {degree}: {}", error(degree));
        }
        assert!(error(80) > 1e-12, "a rule of 16 points cannot be exact here: {}", error(80));
    }

    #[test]
    fn legendre_polynomials_are_one_at_one_and_alternate_at_minus_one() {
        for l in 0..20 {
            let sign = if l % 2 == 0 { 1.0 } else { -1.0 };
            assert!((legendre(l, 1.0) - 1.0).abs() < 1e-14 && (legendre(l, -1.0) - sign).abs() < 1e-14);
        }
        assert!((legendre(2, 0.3) - (1.5 * 0.09 - 0.5)).abs() < 1e-15);
    }
}
