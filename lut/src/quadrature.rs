//! The rules that tables are integrated with: Gauss-Legendre along rays, Fejér over directions.

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

/// Fejér's first rule on [0, 1], ascending: nodes sin²(π y / 2) at the midpoints y of n equal parts, from which polynomials
/// of degree n - 1 are integrated exactly. (Davis & Rabinowitz 1984, Methods of Numerical Integration, 2.5.5.)
pub fn fejer(n: usize) -> Vec<GaussNode> {
    (0..n)
        .map(|k| {
            let theta = (k as f64 + 0.5) * std::f64::consts::PI / n as f64;
            let terms = (1..=n / 2).map(|j| (2.0 * j as f64 * theta).cos() / (4.0 * (j * j) as f64 - 1.0));
            let weight = (1.0 - 2.0 * terms.sum::<f64>()) / n as f64;
            GaussNode { abscissa: (0.5 * theta).sin().powi(2), weight }
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
    fn fejers_rule_integrates_polynomials_of_a_degree_below_its_nodes() {
        let moment = |nodes: usize, degree: i32| -> f64 {
            fejer(nodes).iter().map(|node| node.weight * node.abscissa.powi(degree)).sum()
        };
        for nodes in [4, 5, 8, 12] {
            for degree in 0..nodes as i32 {
                let exact = 1.0 / f64::from(degree + 1);
                assert!((moment(nodes, degree) - exact).abs() < 1e-14, "{nodes} nodes, degree {degree}");
            }
        }
        // Negative control: two nodes do not see a parabola.
        assert!((moment(2, 2) - 1.0 / 3.0).abs() > 0.01);
    }

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
