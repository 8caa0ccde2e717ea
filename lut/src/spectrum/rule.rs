//! At which wavelengths to compute light, and what each counts towards colour.

use super::{LONGEST_NM, SHORTEST_NM, cie, solar};

/// Fewest wavelengths of a Gauss rule; three are [`three_bands`](super::three_bands).
pub const FEWEST: usize = 4;

/// Most wavelengths of a rule.
pub const MOST: usize = 40;

/// A wavelength with its share in colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralNode {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// What spectral radiance at this wavelength adds to X, Y and Z.
    pub xyz: [f64; 3],
}

/// Wavelengths in falling order, red first as the bands are.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralRule {
    /// The wavelengths.
    pub nodes: Vec<SpectralNode>,
}

impl SpectralRule {
    /// The n-point Gauss rule for sunlight, n from [`FEWEST`] to [`MOST`]: nodes crowd where the eye and the sun are.
    ///
    /// The weight of the rule is E·(x̄ + ȳ + z̄), E the sun's spectrum. What air does to sunlight, L/E, is smooth, so the
    /// polynomial of degree n - 1 through its values at the nodes stands for it: each of X, Y, Z is exact where L/E is
    /// such a polynomial, their sum up to degree 2n - 1. Polynomials are those orthonormal under the weight at every
    /// nanometre (Stieltjes; Gautschi 2004, Orthogonal Polynomials, 2.2).
    ///
    /// # Panics
    /// Where n is out of range.
    pub fn gauss(n: usize) -> Self {
        assert!((FEWEST..=MOST).contains(&n), "{n} wavelengths");
        let measure = measure();
        let recurrence = stieltjes(&measure, n);
        // What the polynomials of each degree make of x̄, ȳ and z̄.
        let mut moments = vec![[0.0; 3]; n];
        for point in &measure {
            let polynomials = recurrence.orthonormal(point.x, n);
            for (moment, p) in moments.iter_mut().zip(polynomials) {
                (0..3).for_each(|c| moment[c] += p * point.xyz[c]);
            }
        }
        let node = |i: usize| {
            let x = recurrence.eigenvalue(i, n);
            let polynomials = recurrence.orthonormal(x, n);
            let weight = 1.0 / polynomials.iter().map(|p| p * p).sum::<f64>();
            let wavelength_nm = wavelength_nm(x);
            let scale = weight / solar::irradiance(wavelength_nm);
            let sum = |c: usize| polynomials.iter().zip(&moments).map(|(p, moment)| p * moment[c]).sum::<f64>();
            SpectralNode { wavelength_nm, xyz: std::array::from_fn(|c| scale * sum(c)) }
        };
        Self { nodes: (0..n).rev().map(node).collect() }
    }

    /// X, Y and Z of a spectral radiance.
    pub fn tristimulus(&self, spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for node in &self.nodes {
            let radiance = spectrum(node.wavelength_nm);
            (0..3).for_each(|c| sum[c] += radiance * node.xyz[c]);
        }
        sum
    }
}

/// A point of the discrete measure, every nanometre.
struct Point {
    /// Wavelength scaled to [-1, 1].
    x: f64,
    /// Sunlight through x̄, ȳ, z̄.
    xyz: [f64; 3],
    /// Their sum.
    weight: f64,
}

/// Where nodes lie, nm; less than a thousandth of X + Y + Z of sunlight lies beyond either end.
const FROM_NM: f64 = 390.0;
const TO_NM: f64 = 710.0;

fn wavelength_nm(x: f64) -> f64 {
    0.5 * ((TO_NM - FROM_NM) * x + TO_NM + FROM_NM)
}

/// What lies beyond the ends counts as if it were there: L/E is taken as constant.
fn measure() -> Vec<Point> {
    let steps = (TO_NM - FROM_NM) as usize;
    let scaled = |step: usize| 2.0 * step as f64 / steps as f64 - 1.0;
    let mut points: Vec<_> = (0..=steps).map(|step| Point { x: scaled(step), xyz: [0.0; 3], weight: 0.0 }).collect();
    for step in 0..=(LONGEST_NM - SHORTEST_NM) as u32 {
        let wavelength_nm = SHORTEST_NM + f64::from(step);
        let point = &mut points[(wavelength_nm.clamp(FROM_NM, TO_NM) - FROM_NM) as usize];
        let irradiance = solar::irradiance(wavelength_nm) / cie::Y_INTEGRAL_NM;
        for (sum, value) in point.xyz.iter_mut().zip(cie::matching_functions(wavelength_nm)) {
            *sum += value * irradiance;
            point.weight += value * irradiance;
        }
    }
    points
}

/// x p_k = √β_(k+1) p_(k+1) + α_k p_k + √β_k p_(k-1), and β_0 the measure's mass.
struct Recurrence {
    alpha: Vec<f64>,
    beta: Vec<f64>,
}

fn stieltjes(measure: &[Point], n: usize) -> Recurrence {
    let mut recurrence = Recurrence { alpha: Vec::new(), beta: vec![measure.iter().map(|point| point.weight).sum()] };
    let mut before = vec![0.0; measure.len()];
    let mut p = vec![1.0 / recurrence.beta[0].sqrt(); measure.len()];
    for k in 0..n {
        let mean = |values: &dyn Fn(usize) -> f64| -> f64 { (0..measure.len()).map(values).sum() };
        let alpha = mean(&|i| measure[i].weight * measure[i].x * p[i] * p[i]);
        let next: Vec<f64> = (0..measure.len())
            .map(|i| (measure[i].x - alpha) * p[i] - if k > 0 { recurrence.beta[k].sqrt() * before[i] } else { 0.0 })
            .collect();
        let beta = mean(&|i| measure[i].weight * next[i] * next[i]);
        recurrence.alpha.push(alpha);
        recurrence.beta.push(beta);
        (before, p) = (p, next.iter().map(|value| value / beta.sqrt()).collect());
    }
    recurrence
}

impl Recurrence {
    /// p_0 .. p_(n-1) at x.
    fn orthonormal(&self, x: f64, n: usize) -> Vec<f64> {
        let mut values = vec![1.0 / self.beta[0].sqrt()];
        for k in 0..n - 1 {
            let before = if k > 0 { self.beta[k].sqrt() * values[k - 1] } else { 0.0 };
            values.push(((x - self.alpha[k]) * values[k] - before) / self.beta[k + 1].sqrt());
        }
        values
    }

    /// The i-th smallest zero of p_n, by bisection on Sturm's count of the Jacobi matrix's eigenvalues.
    fn eigenvalue(&self, i: usize, n: usize) -> f64 {
        let below = |x: f64| {
            let (mut count, mut pivot) = (0, 1.0_f64);
            for k in 0..n {
                let coupling = if k > 0 { self.beta[k] / pivot } else { 0.0 };
                pivot = self.alpha[k] - x - coupling;
                if pivot == 0.0 {
                    pivot = f64::MIN_POSITIVE;
                }
                count += usize::from(pivot < 0.0);
            }
            count
        };
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if below(middle) > i { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }
}

/// The n-point rule with nodes in the middle of even steps between two wavelengths and no thought for the eye or the sun:
/// what one would write first, for comparison.
pub fn midpoints(n: usize, from_nm: f64, to_nm: f64) -> SpectralRule {
    let step_nm = (to_nm - from_nm) / n as f64;
    let node = |i: usize| {
        let wavelength_nm = from_nm + (i as f64 + 0.5) * step_nm;
        let xyz = cie::matching_functions(wavelength_nm).map(|value| value * step_nm / cie::Y_INTEGRAL_NM);
        SpectralNode { wavelength_nm, xyz }
    };
    SpectralRule { nodes: (0..n).rev().map(node).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::spectrum::{molecular, ozone};

    /// Largest error of X, Y and Z, over their sum, in sunlight that went through so many air masses of molecules and ozone
    /// and was scattered by molecules.
    fn error(rule: &SpectralRule, masses: f64, ozone_masses: f64) -> f64 {
        let sky = |nm: f64| {
            let molecules = molecular::standard_air_per_m(nm, 360e-6) * 8434.6;
            let depth = masses * molecules + ozone_masses * ozone::cross_section_m2(nm) * 8.06e22;
            solar::irradiance(nm) * molecules * (-depth).exp()
        };
        let (computed, exact) = (rule.tristimulus(sky), cie::tristimulus(sky));
        let sum: f64 = exact.iter().sum();
        (0..3).map(|c| (computed[c] - exact[c]).abs() / sum).fold(0.0, f64::max)
    }

    #[test]
    fn sunlight_is_exact() {
        for n in FEWEST..=MOST {
            let computed = SpectralRule::gauss(n).tristimulus(solar::irradiance);
            for (computed, exact) in computed.iter().zip(cie::tristimulus(solar::irradiance)) {
                assert!((computed / exact - 1.0).abs() < 1e-10, "{n} wavelengths: {computed}, not {exact}");
            }
        }
    }

    #[test]
    fn wavelengths_fall_and_lie_where_there_is_colour() {
        for n in FEWEST..=MOST {
            let nodes = SpectralRule::gauss(n).nodes;
            assert_eq!(nodes.len(), n);
            assert!(nodes.is_sorted_by(|a, b| a.wavelength_nm > b.wavelength_nm));
            assert!(nodes.iter().all(|node| (FROM_NM..=TO_NM).contains(&node.wavelength_nm)));
        }
    }

    #[test]
    fn few_wavelengths_are_enough_where_even_steps_are_not() {
        for (masses, ozone_masses) in [(0.0, 1.0), (3.0, 10.0), (10.0, 10.0), (10.0, 30.0)] {
            let gauss = |n| error(&SpectralRule::gauss(n), masses, ozone_masses);
            let even = error(&midpoints(6, 390.0, 710.0), masses, ozone_masses);
            assert!(gauss(6) < 1e-3 && even > 10.0 * gauss(6), "{} against {even}", gauss(6));
            // The spectra of sun and ozone are tables with kinks every 10 nm, so more wavelengths gain slowly.
            assert!(gauss(40) < 3e-4, "{}", gauss(40));
        }
    }
}
