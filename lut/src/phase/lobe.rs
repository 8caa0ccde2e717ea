//! The closed form that shaders evaluate: every phase function but a table is a sum of lobes of one shape.

use std::f64::consts::PI;

use super::{DropletFit, PhaseFunction};

/// scale (1 + quadratic ν²) (gap + slope (1 - peak ν))^(-exponent), 1/sr, with ν = cos θ and the peak at ν = 1 or -1.
///
/// Draine's function is of this form, of which Rayleigh's, Henyey-Greenstein's and Cornette-Shanks' are special cases,
/// and so is Schlick's. gap is (1 - |g|)² and slope 2|g|, as 1 + g² - 2gν = (1 - |g|)² + 2|g| (1 ∓ ν): the peak survives rounding,
/// forward and backward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseLobe {
    /// Factor of all, 1/sr.
    pub scale_per_sr: f64,
    /// Factor of ν².
    pub quadratic: f64,
    /// The base at the peak, above 0.
    pub gap: f64,
    /// How the base grows away from it, at least 0.
    pub slope: f64,
    /// 1 where the peak is forward, -1 where it is backward.
    pub peak_nu: f64,
    /// Power of one over the base.
    pub exponent: f64,
}

/// The least base whose power f32 can hold; of so narrow a peak f32 knows no angle but its middle.
const LEAST_GAP: f64 = 1e-20;

impl PhaseLobe {
    /// A lobe that is not there; its base still has a finite logarithm.
    pub const ABSENT: Self =
        Self { scale_per_sr: 0.0, quadratic: 0.0, gap: 1.0, slope: 0.0, peak_nu: 1.0, exponent: 0.0 };

    fn draine(weight: f64, g: f64, alpha: f64) -> Self {
        let norm = 4.0 * PI * (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
        Self {
            scale_per_sr: weight * (1.0 - g.abs()) * (1.0 + g.abs()) / norm,
            quadratic: alpha,
            gap: (1.0 - g.abs()) * (1.0 - g.abs()),
            slope: 2.0 * g.abs(),
            peak_nu: 1.0_f64.copysign(g),
            exponent: 1.5,
        }
    }

    fn schlick(k: f64) -> Self {
        Self {
            scale_per_sr: (1.0 - k * k) / (4.0 * PI),
            quadratic: 0.0,
            gap: 1.0 - k.abs(),
            slope: k.abs(),
            peak_nu: 1.0_f64.copysign(k),
            exponent: 2.0,
        }
    }

    /// Gap and slope about ν = 1, whichever way the peak looks: (gap, slope), the slope below 0 where it is backward.
    pub fn about_forward(&self) -> (f64, f64) {
        if self.peak_nu < 0.0 { (self.gap + 2.0 * self.slope, -self.slope) } else { (self.gap, self.slope) }
    }

    /// From gap and slope about ν = 1.
    pub fn with_base_about_forward(self, gap: f64, slope: f64) -> Self {
        match slope < 0.0 {
            true => Self { gap: gap + 2.0 * slope, slope: -slope, peak_nu: -1.0, ..self },
            false => Self { gap, slope, peak_nu: 1.0, ..self },
        }
    }

    /// The gap that f32 can do with.
    pub fn gap_in_single_precision(&self) -> f32 {
        self.gap.max(LEAST_GAP) as f32
    }

    /// Its part of the phase function, 1/sr, for ν in [-1, 1].
    pub fn value(&self, nu: f64) -> f64 {
        let base = self.gap + self.slope * (1.0 - self.peak_nu * nu);
        self.scale_per_sr * (1.0 + self.quadratic * nu * nu) * base.powf(-self.exponent)
    }
}

impl PhaseFunction {
    /// The lobes that it is the sum of, at most two; none of a table.
    pub fn lobes(&self) -> Vec<PhaseLobe> {
        self.scaled_lobes(1.0)
    }

    /// The same with a factor on the asymmetry of every lobe.
    pub fn scaled_lobes(&self, factor: f64) -> Vec<PhaseLobe> {
        let draine = |weight, g: f64, alpha| PhaseLobe::draine(weight, g * factor, alpha);
        match *self {
            Self::Isotropic => vec![draine(1.0, 0.0, 0.0)],
            Self::Rayleigh => vec![draine(1.0, 0.0, 1.0)],
            Self::HenyeyGreenstein { g } => vec![draine(1.0, g, 0.0)],
            Self::DoubleHenyeyGreenstein { weight, g1, g2 } => {
                vec![draine(weight, g1, 0.0), draine(1.0 - weight, g2, 0.0)]
            }
            Self::Schlick { k } => vec![PhaseLobe::schlick(k * factor)],
            Self::CornetteShanks { g } => vec![draine(1.0, g, 1.0)],
            Self::Draine { g, alpha } => vec![draine(1.0, g, alpha)],
            Self::HenyeyGreensteinDraine { droplet_diameter_um } => {
                let fit = DropletFit::new(droplet_diameter_um);
                vec![draine(1.0 - fit.weight_draine, fit.g_hg, 0.0), draine(fit.weight_draine, fit.g_draine, fit.alpha)]
            }
            Self::Tabulated(_) => vec![],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lobes_add_up_to_the_phase_function() {
        let functions = [
            PhaseFunction::Isotropic,
            PhaseFunction::Rayleigh,
            PhaseFunction::HenyeyGreenstein { g: 0.8 },
            PhaseFunction::DoubleHenyeyGreenstein { weight: 0.9, g1: 0.85, g2: -0.2 },
            PhaseFunction::Schlick { k: 0.7 },
            PhaseFunction::CornetteShanks { g: 0.76 },
            PhaseFunction::Draine { g: 0.5, alpha: 3.0 },
            PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 10.0 },
        ];
        for function in functions {
            for i in 0..=100 {
                let nu = f64::from(i) / 50.0 - 1.0;
                let sum: f64 = function.lobes().iter().map(|lobe| lobe.value(nu)).sum();
                assert!((sum / function.value(nu) - 1.0).abs() < 1e-12, "{function:?} at {nu}");
            }
        }
    }

    #[test]
    fn a_peak_survives_single_precision_forward_and_backward() {
        let value_in_f32 = |lobe: &PhaseLobe, nu: f32| {
            let base = lobe.gap_in_single_precision() + lobe.slope as f32 * (1.0 - lobe.peak_nu as f32 * nu);
            lobe.scale_per_sr as f32 * base.powf(-lobe.exponent as f32)
        };
        for g in [0.9999, -0.9999, 0.5, -0.5] {
            let function = PhaseFunction::HenyeyGreenstein { g };
            let [lobe] = function.lobes()[..] else { panic!("one lobe") };
            for nu in [1.0, -1.0, 1.0 - f32::EPSILON, f32::EPSILON - 1.0, 0.3] {
                let error = f64::from(value_in_f32(&lobe, nu)) / function.value(nu.into()) - 1.0;
                assert!(error.abs() < 2e-6, "g = {g} at {nu}: {error}");
            }
        }
        // The narrowest that there are: what f32 cannot hold is finite.
        for g in [1.0 - f64::EPSILON / 2.0, f64::EPSILON / 2.0 - 1.0, -0.999_999_998] {
            let [lobe] = PhaseFunction::HenyeyGreenstein { g }.lobes()[..] else { panic!("one lobe") };
            let values = [-1.0, 1.0].map(|nu| value_in_f32(&lobe, nu));
            assert!(values.iter().all(|value| value.is_finite() && *value >= 0.0), "{g}: {values:?}");
        }
        // The control: the same lobe from ν = 1, whatever its g.
        let [lobe] = PhaseFunction::HenyeyGreenstein { g: -0.9999 }.lobes()[..] else { panic!("one lobe") };
        let (gap, slope) = lobe.about_forward();
        let base = gap as f32 + slope as f32 * 2.0;
        assert!((f64::from(base) / 1e-8 - 1.0).abs() > 0.1, "{base}");
    }
}
