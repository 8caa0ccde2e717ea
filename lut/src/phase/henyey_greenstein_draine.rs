//! Fog and cloud droplets by size: a fit of Henyey-Greenstein and Draine lobes to Mie theory (Jendersie & d'Eon 2023,
//! "An Approximate Mie Scattering Function for Fog and Cloud Rendering", eq. 4-7).
//!
//! P = (1 - w) P_HG(g_HG) + w P_D(g_D, α); the four parameters follow from the droplets' diameter d, 5 µm ≤ d ≤ 50 µm.

use super::{draine, henyey_greenstein};

/// The parameters of the two lobes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropletFit {
    /// Mean cosine of the Henyey-Greenstein lobe.
    pub g_hg: f64,
    /// g of the Draine lobe.
    pub g_draine: f64,
    /// α of the Draine lobe.
    pub alpha: f64,
    /// Share of the Draine lobe.
    pub weight_draine: f64,
}

impl DropletFit {
    /// The fit for water droplets of a diameter in [5, 50] µm.
    pub fn new(droplet_diameter_um: f64) -> Self {
        let d = droplet_diameter_um;
        Self {
            g_hg: (-0.0990567 / (d - 1.67154)).exp(),
            g_draine: (-2.20679 / (d + 3.91029) - 0.428934).exp(),
            alpha: (3.62489 - 8.29288 / (d + 5.52825)).exp(),
            weight_draine: (-0.599085 / (d - 0.641583) - 0.665888).exp(),
        }
    }

    /// P(cos θ), 1/sr.
    pub fn value(&self, cos_theta: f64) -> f64 {
        (1.0 - self.weight_draine) * henyey_greenstein::value(self.g_hg, cos_theta)
            + self.weight_draine * draine::value(self.g_draine, self.alpha, cos_theta)
    }

    /// Draws a lobe with the lower or upper part of `u`, then cos θ with what is left of it.
    pub(super) fn sample(&self, u: f64) -> f64 {
        if u < self.weight_draine {
            draine::sample(self.g_draine, self.alpha, u / self.weight_draine)
        } else {
            henyey_greenstein::sample(self.g_hg, (u - self.weight_draine) / (1.0 - self.weight_draine))
        }
    }

    /// The lobes' moments, weighted.
    pub(super) fn legendre_moment(&self, l: usize) -> f64 {
        (1.0 - self.weight_draine) * henyey_greenstein::legendre_moment(self.g_hg, l)
            + self.weight_draine * draine::legendre_moment(self.g_draine, self.alpha, l)
    }
}
