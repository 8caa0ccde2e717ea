//! Numerical integration with a stated error: Gauss-Legendre rules and adaptive Gauss-Kronrod.

use std::f64::consts::PI;

use welkin_lut::{BAND_COUNT, Bands};

/// A Gauss-Legendre rule on [0, 1]: exact for polynomials of degree 2n - 1.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLegendre {
    /// (node, weight) in ascending order of the nodes; the weights sum to 1.
    pub points: Vec<(f64, f64)>,
}

impl GaussLegendre {
    /// The rule with `count` ≥ 1 nodes, by Newton's method on the Legendre polynomial.
    pub fn new(count: usize) -> Self {
        let points = (0..count).map(|i| {
            let mut x = -((PI * (i as f64 + 0.75)) / (count as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (value, derivative) = legendre(count, x);
                slope = derivative;
                let step = value / derivative;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        });
        Self { points: points.collect() }
    }
}

/// P_n(x) and P_n'(x) by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (previous, current) = (current, ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k);
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}

/// The value of an integral in each band and a bound on its error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Integral {
    /// The integral.
    pub value: Bands,
    /// Estimated absolute error: the sum of |Kronrod - Gauss| over the panels, which overstates it.
    pub error: Bands,
}

/// Positive nodes of the 15-point Kronrod rule on [-1, 1], its weights, and the weights of the embedded 7-point
/// Gauss rule (zero where that has no node).
const KRONROD: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_56, 0.129_484_966_168_869_7),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_19, 0.0),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_46, 0.204_432_940_075_298_89, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

fn gauss_kronrod(f: &mut impl FnMut(f64) -> Bands, a: f64, b: f64) -> Integral {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let (mut kronrod, mut gauss) = ([0.0; BAND_COUNT], [0.0; BAND_COUNT]);
    for (node, weight, gauss_weight) in KRONROD {
        let mut value = f(middle + half * node);
        if node > 0.0 {
            let mirrored = f(middle - half * node);
            value = std::array::from_fn(|j| value[j] + mirrored[j]);
        }
        for j in 0..BAND_COUNT {
            kronrod[j] += weight * value[j];
            gauss[j] += gauss_weight * value[j];
        }
    }
    Integral {
        value: kronrod.map(|v| v * half),
        error: std::array::from_fn(|j| ((kronrod[j] - gauss[j]) * half).abs()),
    }
}

/// Most panels that one integral may use before it returns what it has, with its true (large) error estimate.
const PANEL_LIMIT: usize = 4000;

/// Integrates `f` between consecutive `breakpoints` until the error estimate of every band is below
/// `relative` times its integral, or below `absolute`.
///
/// The panel with the largest share of its band's tolerance is halved first (adaptive Gauss-Kronrod 7-15; Piessens
/// et al., QUADPACK 1983). Kinks and jumps of `f` belong into `breakpoints`, in ascending order.
pub fn integrate(mut f: impl FnMut(f64) -> Bands, breakpoints: &[f64], relative: f64, absolute: f64) -> Integral {
    let mut panels: Vec<(f64, f64, Integral)> = breakpoints
        .windows(2)
        .filter(|ends| ends[1] > ends[0])
        .map(|ends| (ends[0], ends[1], gauss_kronrod(&mut f, ends[0], ends[1])))
        .collect();
    loop {
        let total = sum(&panels);
        let tolerance = total.value.map(|v| (relative * v.abs()).max(absolute));
        let excess = |i: &Integral| (0..BAND_COUNT).map(|j| i.error[j] / tolerance[j]).fold(0.0, f64::max);
        // An integrand that vanishes gives 0/0, which `max` passes over.
        if excess(&total) <= 1.0 || panels.len() >= PANEL_LIMIT {
            return total;
        }
        let worst = (0..panels.len()).max_by(|&i, &k| excess(&panels[i].2).total_cmp(&excess(&panels[k].2)));
        let Some(worst) = worst else { return total };
        let (a, b, _) = panels[worst];
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            return total;
        }
        panels[worst] = (a, middle, gauss_kronrod(&mut f, a, middle));
        panels.push((middle, b, gauss_kronrod(&mut f, middle, b)));
    }
}

fn sum(panels: &[(f64, f64, Integral)]) -> Integral {
    let mut total = Integral::default();
    for (_, _, part) in panels {
        for j in 0..BAND_COUNT {
            total.value[j] += part.value[j];
            total.error[j] += part.error[j];
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_legendre_is_exact_to_its_degree_and_not_beyond() {
        for count in [1, 2, 5, 8, 24, 64] {
            let rule = GaussLegendre::new(count);
            let moment = |power: i32| rule.points.iter().map(|(x, w)| w * x.powi(power)).sum::<f64>();
            let degree = 2 * count as i32 - 1;
            assert!((moment(degree) * f64::from(degree + 1) - 1.0).abs() < 1e-12, "{count} nodes");
            if count <= 5 {
                let beyond = moment(degree + 1) * f64::from(degree + 2) - 1.0;
                assert!(beyond.abs() > 1e-7, "{count} nodes are exact beyond their degree: {beyond}");
            }
        }
    }

    #[test]
    fn adaptive_integration_keeps_its_error_bound_on_a_narrow_peak() {
        let width = 1e-4;
        let exact = 2.0 * (0.5_f64 / width).atan() / width;
        let f = |x: f64| [1.0 / ((x - 0.5).powi(2) + width * width); 3];
        let integral = integrate(f, &[0.0, 1.0], 1e-9, 0.0);
        assert!((integral.value[0] - exact).abs() <= integral.error[0].max(1e-13 * exact));
        assert!(integral.error[0] <= 1e-9 * exact);
        let rough = integrate(f, &[0.0, 1.0], 0.5, 0.0);
        assert!(rough.error[0] > integral.error[0], "the bound tells a rough integral from a fine one");
    }
}
