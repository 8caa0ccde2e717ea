//! How much light deep in a thick slab matters to its far side: e^(κ depth) I(μ), the growing solution of the transport
//! equation far from boundaries (Case & Zweifel 1967, "Linear Transport Theory", chapter 4).
//!
//! It guides walks and steadies what they score; neither moves their mean, whatever κ and the positive I are. With I a series of
//! Legendre polynomials, ∫P(ω·ω') I(μ') dω' is the same series times the moments of P (the addition theorem), so that
//! directions drawn in proportion to P I have a known density.

use std::f64::consts::PI;

use welkin_lut::PhaseFunction;

/// Highest degree of the series.
const DEGREE: usize = 24;
/// Coefficients below this share of their sum are left out, but for the first two.
const NEGLIGIBLE: f64 = 3e-3;
/// Largest κ, in units of the extinction: with 1 a walk along the normal would not collide.
const LARGEST: f64 = 0.98;
/// Smallest κ: where nothing is absorbed the importance is linear in depth, which is its limit.
const SMALLEST: f64 = 1e-4;
/// I stays above this share of its mean.
const FLOOR: f64 = 0.05;
/// Places where that is checked.
const PLACES: usize = 4096;

/// The growing solution for one medium.
#[derive(Debug, Clone)]
pub(super) struct Asymptotic {
    /// κ: by how much importance grows over one optical depth, as a logarithm; in ]0, 1[.
    pub kappa: f64,
    /// Coefficients of P_l(μ) in I, up to the last that counts.
    series: Vec<f64>,
    /// The same times the moments of the phase function.
    scattered: Vec<f64>,
    /// I(1), its largest value.
    pub most: f64,
}

impl Asymptotic {
    /// For a single-scattering albedo and a phase function.
    pub fn new(albedo: f64, phase: &PhaseFunction) -> Self {
        let moments: [f64; DEGREE + 1] = std::array::from_fn(|l| phase.legendre_moment(l));
        let h: [f64; DEGREE + 1] = std::array::from_fn(|l| (2 * l + 1) as f64 * (1.0 - albedo * moments[l]));
        let kappa = smallest_root(&h).clamp(SMALLEST, LARGEST);
        let mut series = solution(&h, kappa).to_vec();
        let negligible = NEGLIGIBLE * series.iter().sum::<f64>();
        while series.len() > 2 && series[series.len() - 1] < negligible {
            series.pop();
        }
        // The series of a sharp peak overshoots: it is smoothed until it is positive everywhere.
        while lowest(&series) < FLOOR {
            for (l, a) in series.iter_mut().enumerate() {
                *a *= 0.97_f64.powi(l as i32);
            }
        }
        let scattered = series.iter().zip(moments).map(|(a, moment)| a * moment).collect();
        let most = series.iter().sum();
        Self { kappa, series, scattered, most }
    }

    /// I(μ), positive, 1 on average.
    pub fn importance(&self, mu: f64) -> f64 {
        sum(&self.series, mu).max(f64::MIN_POSITIVE)
    }

    /// ∫P(ω·ω') I(μ') dω'.
    pub fn after_scattering(&self, mu: f64) -> f64 {
        sum(&self.scattered, mu).max(f64::MIN_POSITIVE)
    }
}

/// The pivots of the tridiagonal system H - κM from its end; all are positive below the smallest root κ.
fn pivots(h: &[f64; DEGREE + 1], kappa: f64) -> [f64; DEGREE + 1] {
    let mut pivots = *h;
    for l in (0..DEGREE).rev() {
        pivots[l] -= (kappa * (l + 1) as f64).powi(2) / pivots[l + 1];
    }
    pivots
}

/// κ for which (2l+1)(1 - Wχ_l) b_l = κ (l b_{l-1} + (l+1) b_{l+1}) has a solution.
fn smallest_root(h: &[f64; DEGREE + 1]) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if pivots(h, middle).iter().all(|&p| p > 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// a_l = (2l+1) b_l with b_0 = 1, from the end, where the recurrence is stable.
fn solution(h: &[f64; DEGREE + 1], kappa: f64) -> [f64; DEGREE + 1] {
    let pivots = pivots(h, kappa);
    let mut b = 1.0;
    std::array::from_fn(|l| {
        if l > 0 {
            // A κ above the root (its floor) may turn pivots; what remains is then no more than a guess.
            b *= (kappa * l as f64 / pivots[l]).clamp(0.0, 1.0);
        }
        (2 * l + 1) as f64 * b
    })
}

/// Σ a_l P_l(μ) by Clenshaw's recurrence.
fn sum(series: &[f64], mu: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for (l, a) in series.iter().enumerate().rev() {
        let here = a + RECURRENCE[l].0 * mu * one - RECURRENCE[l].1 * two;
        (two, one) = (one, here);
    }
    one
}

/// (2l+1)/(l+1) and (l+1)/(l+2) of P_(l+1) = (2l+1)/(l+1) μ P_l - l/(l+1) P_(l-1).
const RECURRENCE: [(f64, f64); DEGREE + 1] = {
    let mut table = [(0.0, 0.0); DEGREE + 1];
    let mut l = 0;
    while l <= DEGREE {
        let n = l as f64;
        table[l] = ((2.0 * n + 1.0) / (n + 1.0), (n + 1.0) / (n + 2.0));
        l += 1;
    }
    table
};

fn lowest(series: &[f64]) -> f64 {
    (0..=PLACES).map(|i| sum(series, (PI * i as f64 / PLACES as f64).cos())).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn isotropic_scattering_has_the_diffusion_length_of_the_textbook() {
        // 1 = (W / 2κ) ln((1 + κ) / (1 - κ)): Case & Zweifel 1967.
        for albedo in [0.5, 0.9, 0.999] {
            let kappa = Asymptotic::new(albedo, &PhaseFunction::Isotropic).kappa;
            let one = 0.5 * albedo / kappa * ((1.0 + kappa) / (1.0 - kappa)).ln();
            assert!((one - 1.0).abs() < 1e-6, "{albedo}: {kappa} gives {one}");
            // Control: another albedo has another length.
            assert!((one / albedo * (albedo + 1e-3) - 1.0).abs() > 1e-4);
        }
    }

    #[test]
    fn importance_is_positive_and_what_scattering_makes_of_it_is_its_integral() {
        const AROUND: usize = 64;
        let rule = crate::reference::quadrature::GaussLegendre::new(200);
        for g in [-0.6, 0.0, 0.5, 0.85, 0.95] {
            for albedo in [0.1, 0.5, 0.9, 0.999, 1.0] {
                let phase = PhaseFunction::HenyeyGreenstein { g };
                let guide = Asymptotic::new(albedo, &phase);
                for mu in [-0.9, 0.1, 1.0] {
                    let integral: f64 = rule
                        .points
                        .iter()
                        .flat_map(|&(x, w)| (0..AROUND).map(move |k| (2.0 * x - 1.0, w, k as f64 / AROUND as f64)))
                        .map(|(cos, w, turned)| {
                            let importance = guide.importance(super::super::turn(mu, cos, turned));
                            4.0 * PI * w / AROUND as f64 * phase.value(cos) * importance
                        })
                        .sum();
                    let (label, exact) = (format!("g {g}, W {albedo}, μ {mu}"), guide.after_scattering(mu));
                    assert!((integral / exact - 1.0).abs() < 1e-6, "{label}: {integral} and {exact}");
                    // Control: importance is not flat.
                    assert!(mu != 1.0 || (integral / guide.importance(mu) - 1.0).abs() > 1e-6, "{label}");
                }
                assert!(guide.most >= guide.importance(0.99) && guide.importance(-1.0) >= 0.5 * FLOOR);
            }
        }
    }
}
