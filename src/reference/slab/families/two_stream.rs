//! Two streams: one flux up, one flux down, in closed form (Meador & Weaver 1980, J. Atmos. Sci. 37, 630).

use super::{Fluxes, SlabMethod, without_forward_peak};
use crate::reference::slab::Slab;

/// How the two fluxes stand for all directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Closure {
    /// Light along two slants, those of Gauss's rule.
    Quadrature,
    /// Light whose radiance is linear in the cosine: Eddington's, which is the diffusion equation (Stam 1995) for a slab.
    Eddington,
}

/// The method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TwoStream {
    /// How the fluxes stand for all directions.
    pub closure: Closure,
    /// Whether the forward peak, a share χ₂ of all scattering, counts as not scattered.
    pub delta: bool,
}

/// The slab as the two streams see it: Meador & Weaver's γ.
struct Gammas {
    thickness: f64,
    albedo: f64,
    exchange: [f64; 4],
}

impl SlabMethod for TwoStream {
    fn name(&self) -> String {
        let closure = match self.closure {
            Closure::Quadrature => "two streams",
            Closure::Eddington => "diffusion",
        };
        format!("{closure}{}", if self.delta { ", delta-scaled" } else { "" })
    }

    fn fluxes(&self, slab: &Slab) -> Fluxes {
        let gammas = self.gammas(slab);
        let (reflected, transmitted) = gammas.of_beam(slab.mu0);
        let (reflected_diffuse, transmitted_diffuse) = gammas.of_diffuse();
        // What the peak holds arrives with the beam, but has been scattered.
        let direct = (-slab.optical_thickness / slab.mu0).exp();
        let black = transmitted + (-gammas.thickness / slab.mu0).exp() - direct;
        let a = slab.surface_albedo;
        let from_surface = a * (black + direct) / (1.0 - a * reflected_diffuse);
        Fluxes {
            reflectance: reflected + from_surface * transmitted_diffuse,
            diffuse_transmittance: black + from_surface * reflected_diffuse,
        }
    }
}

impl TwoStream {
    fn gammas(&self, slab: &Slab) -> Gammas {
        let (mut g, mut thickness, mut albedo) = (slab.phase.legendre_moment(1), slab.optical_thickness, slab.albedo);
        if self.delta {
            let peak = slab.phase.legendre_moment(2).max(0.0);
            (thickness, albedo) = without_forward_peak(slab, peak);
            g = (g - peak) / (1.0 - peak);
        }
        // Where nothing is absorbed, the two exponentials are one: a share too small to be seen tells them apart.
        let w = albedo.min(1.0 - 1e-9);
        let (sum, difference, third) = match self.closure {
            Closure::Quadrature => {
                let root = 3_f64.sqrt();
                (0.5 * root * (2.0 - w * (1.0 + g)), 0.5 * root * w * (1.0 - g), 0.5 * (1.0 - root * g * slab.mu0))
            }
            Closure::Eddington => (
                0.25 * (7.0 - w * (4.0 + 3.0 * g)),
                -0.25 * (1.0 - w * (4.0 - 3.0 * g)),
                0.25 * (2.0 - 3.0 * g * slab.mu0),
            ),
        };
        Gammas { thickness, albedo: w, exchange: [sum, difference, third, 1.0 - third] }
    }
}

impl Gammas {
    fn attenuation(&self) -> f64 {
        let [g1, g2, ..] = self.exchange;
        (g1 * g1 - g2 * g2).sqrt()
    }

    /// Reflectance and diffuse transmittance for a beam: eq. 14 and 15, over e^(kτ).
    fn of_beam(&self, mu0: f64) -> (f64, f64) {
        let ([g1, g2, g3, g4], tau, k) = (self.exchange, self.thickness, self.attenuation());
        // The formulas are 0/0 where the beam falls off as the diffuse light does.
        let mu0 = if (k * mu0 - 1.0).abs() < 1e-6 { mu0 * (1.0 + 2e-6) } else { mu0 };
        let (alpha1, alpha2) = (g1 * g4 + g2 * g3, g1 * g3 + g2 * g4);
        let (back, beam) = ((-2.0 * k * tau).exp(), (-tau / mu0).exp());
        let scale = self.albedo / ((1.0 - (k * mu0).powi(2)) * ((k + g1) + (k - g1) * back));
        let reflected = (1.0 - k * mu0) * (alpha2 + k * g3)
            - (1.0 + k * mu0) * (alpha2 - k * g3) * back
            - 2.0 * k * (g3 - alpha2 * mu0) * beam * (-k * tau).exp();
        let transmitted = ((1.0 + k * mu0) * (alpha1 + k * g4) - (1.0 - k * mu0) * (alpha1 - k * g4) * back) * beam
            - 2.0 * k * (g4 + alpha1 * mu0) * (-k * tau).exp();
        (scale * reflected, -scale * transmitted)
    }

    /// Reflectance and transmittance for light from everywhere.
    fn of_diffuse(&self) -> (f64, f64) {
        let ([g1, g2, ..], k) = (self.exchange, self.attenuation());
        let fall = (-k * self.thickness).exp();
        let denominator = k + g1 + (k - g1) * fall * fall;
        (g2 * (1.0 - fall * fall) / denominator, 2.0 * k * fall / denominator)
    }
}
