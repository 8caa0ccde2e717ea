//! The closed form that shaders evaluate: every phase function but a table is a sum of lobes of one shape.

use std::f64::consts::PI;

use super::{DropletFit, PhaseFunction};

/// scale (1 + quadratic ν²) (gap + slope (1 - ν))^(-exponent), 1/sr, with ν = cos θ.
///
/// Draine's function is of this form, of which Rayleigh's, Henyey-Greenstein's and Cornette-Shanks' are special cases,
/// and so is Schlick's. gap is (1 - g)² and slope 2g, as 1 + g² - 2gν = (1 - g)² + 2g (1 - ν): the peak survives f32.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseLobe {
    /// Factor of all, 1/sr.
    pub scale_per_sr: f64,
    /// Factor of ν².
    pub quadratic: f64,
    /// The base at ν = 1, above 0.
    pub gap: f64,
    /// How the base grows with 1 - ν.
    pub slope: f64,
    /// Power of one over the base.
    pub exponent: f64,
}

impl PhaseLobe {
    /// A lobe that is not there; its base still has a finite logarithm.
    pub const ABSENT: Self = Self { scale_per_sr: 0.0, quadratic: 0.0, gap: 1.0, slope: 0.0, exponent: 0.0 };

    fn draine(weight: f64, g: f64, alpha: f64) -> Self {
        let norm = 4.0 * PI * (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
        Self {
            scale_per_sr: weight * (1.0 - g * g) / norm,
            quadratic: alpha,
            gap: (1.0 - g) * (1.0 - g),
            slope: 2.0 * g,
            exponent: 1.5,
        }
    }

    fn schlick(k: f64) -> Self {
        Self { scale_per_sr: (1.0 - k * k) / (4.0 * PI), quadratic: 0.0, gap: 1.0 - k, slope: k, exponent: 2.0 }
    }

    /// The base from where it is least, as (gap, slope, ν there): gap + slope (1 - peak ν) with a slope of at least 0.
    ///
    /// Shaders have it so: a lobe of g < 0 is narrow at ν = -1, where the base is the small difference of gap and 2 slope,
    /// which f32 would lose.
    pub fn from_peak(&self) -> (f64, f64, f64) {
        match self.slope < 0.0 {
            true => (self.gap + 2.0 * self.slope, -self.slope, -1.0),
            false => (self.gap, self.slope, 1.0),
        }
    }

    /// Its part of the phase function, 1/sr, for ν in [-1, 1].
    pub fn value(&self, nu: f64) -> f64 {
        let base = self.gap + self.slope * (1.0 - nu);
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
            let (gap, slope, peak_nu) = lobe.from_peak();
            let base = gap as f32 + slope as f32 * (1.0 - peak_nu as f32 * nu);
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
        // The control: the same lobe from ν = 1, whatever its g.
        let [lobe] = PhaseFunction::HenyeyGreenstein { g: -0.9999 }.lobes()[..] else { panic!("one lobe") };
        let base = lobe.gap as f32 + lobe.slope as f32 * 2.0;
        assert!((f64::from(base) / 1e-8 - 1.0).abs() > 0.1, "{base}");
    }
}
