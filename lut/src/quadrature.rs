//! Gauss-Legendre nodes: the one rule that the tables are integrated with.

/// A node of a quadrature rule on [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussNode {
    /// Where the integrand is taken.
    pub abscissa: f64,
    /// What it counts; the weights of a rule add up to 1.
    pub weight: f64,
}

/// The n-point Gauss-Legendre rule on [0, 1], ascending: exact for polynomials of degree 2n - 1.
///
/// Newton's iteration on the Legendre polynomial from the Chebyshev guess (Press et al., Numerical Recipes, gauleg).
pub fn gauss_legendre(n: usize) -> Vec<GaussNode> {
    (0..n)
        .map(|i| {
            let mut x = -((i as f64 + 0.75) / (n as f64 + 0.5) * std::f64::consts::PI).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (value, derivative) = legendre_with_derivative(n, x);
                slope = derivative;
                x -= value / derivative;
            }
            GaussNode { abscissa: 0.5 * (1.0 + x), weight: 1.0 / ((1.0 - x * x) * slope * slope) }
        })
        .collect()
}

/// P_n(x) and its derivative by the three-term recurrence, |x| < 1.
fn legendre_with_derivative(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (0.0, 1.0);
    for l in 1..=n {
        let l = l as f64;
        (before, value) = (value, ((2.0 * l - 1.0) * x * value - (l - 1.0) * before) / l);
    }
    (value, n as f64 * (x * value - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_is_exact_up_to_its_degree_and_no_further() {
        for n in 1..=32 {
            let integrate = |power: usize| -> f64 {
                gauss_legendre(n).iter().map(|node| node.weight * node.abscissa.powi(power as i32)).sum()
            };
            let exact = |power: usize| 1.0 / (power as f64 + 1.0);
            assert!((integrate(2 * n - 1) - exact(2 * n - 1)).abs() < 1e-14, "{n} points");
            // Beyond n = 8 the error of the next degree drowns in rounding.
            assert!(n > 8 || (integrate(2 * n) - exact(2 * n)).abs() > 1e-13, "{n} points");
        }
    }
}
