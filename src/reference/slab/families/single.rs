//! Light scattered exactly once, and reflected by the surface once at most on its way: the lower end of the chart.

use super::{Fluxes, SlabMethod};
use crate::reference::quadrature::GaussLegendre;
use crate::reference::slab::Slab;

/// Nodes over the cosines of exits, and over azimuths.
const NODES: (usize, usize) = (48, 32);

/// Single scattering in the slab; the surface adds what reaches it directly and leaves directly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SingleScattering;

impl SlabMethod for SingleScattering {
    fn name(&self) -> String {
        "single scattering".to_owned()
    }

    /// W P(Θ) ∫ e^(-τ'/μ₀ - rest/μ) dτ' / μ₀ over the hemispheres.
    fn fluxes(&self, slab: &Slab) -> Fluxes {
        let Slab { optical_thickness: tau, albedo, ref phase, mu0, surface_albedo } = *slab;
        let (mut up, mut down, mut leaves) = (0.0, 0.0, 0.0);
        let rule = GaussLegendre::new(NODES.0);
        let sine = |mu: f64| (1.0 - mu * mu).max(0.0).sqrt();
        for (mu, weight) in rule.points {
            leaves += 2.0 * weight * mu * (-tau / mu).exp();
            let mean_phase = |sign: f64| -> f64 {
                let at = |i: usize| {
                    let azimuth = std::f64::consts::PI * (i as f64 + 0.5) / NODES.1 as f64;
                    phase.value(sign * mu * mu0 + sine(mu) * sine(mu0) * azimuth.cos())
                };
                (0..NODES.1).map(at).sum::<f64>() / NODES.1 as f64
            };
            let (rate_up, rate_down) = (1.0 / mu0 + 1.0 / mu, 1.0 / mu0 - 1.0 / mu);
            let depths_up = -(-tau * rate_up).exp_m1() / rate_up;
            // Both slants are alike where the rates are: then the integral is the thickness.
            let depths_down = match (tau * rate_down).abs() < 1e-9 {
                true => tau * (-tau / mu0).exp(),
                false => ((-tau / mu).exp() - (-tau / mu0).exp()) / rate_down,
            };
            let around = std::f64::consts::TAU * weight * albedo / mu0;
            up += around * mean_phase(-1.0) * depths_up;
            down += around * mean_phase(1.0) * depths_down;
        }
        let direct = (-tau / mu0).exp();
        Fluxes { reflectance: up + surface_albedo * direct * leaves, diffuse_transmittance: down }
    }
}
