//! What a point of the medium does to light: the sums over the constituents present there.

use glam::DVec3;
use welkin_lut::{Bands, Constituent, PhaseFunction};

use super::spectrum;

/// Optical properties of one constituent at density 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Matter {
    /// b, 1/m.
    pub scattering_per_m: Bands,
    /// c = a + b, 1/m.
    pub extinction_per_m: Bands,
    /// a·L_e, W·m⁻²·sr⁻¹·nm⁻¹ per m.
    pub emission_per_m: Bands,
    /// P.
    pub phase: PhaseFunction,
}

impl From<&Constituent> for Matter {
    fn from(constituent: &Constituent) -> Self {
        Self {
            scattering_per_m: constituent.scattering_per_m,
            extinction_per_m: constituent.extinction_per_m(),
            emission_per_m: constituent.emission_per_m,
            phase: constituent.phase.clone(),
        }
    }
}

/// The matter at one point: constituents and their densities, in the same order.
#[derive(Debug, Clone, Copy)]
pub struct Local<'a> {
    /// The constituents.
    pub matter: &'a [Matter],
    /// Density of each, relative to its coefficients.
    pub density: &'a [f64],
}

impl Local<'_> {
    fn sum(&self, coefficient: impl Fn(&Matter) -> Bands) -> Bands {
        let mut total = spectrum::ZERO;
        for (matter, &density) in self.matter.iter().zip(self.density) {
            spectrum::accumulate(&mut total, density, coefficient(matter));
        }
        total
    }

    /// b, 1/m.
    pub fn scattering(&self) -> Bands {
        self.sum(|m| m.scattering_per_m)
    }

    /// c, 1/m.
    pub fn extinction(&self) -> Bands {
        self.sum(|m| m.extinction_per_m)
    }

    /// a·L_e, W·m⁻²·sr⁻¹·nm⁻¹ per m.
    pub fn emission(&self) -> Bands {
        self.sum(|m| m.emission_per_m)
    }

    /// b P(cos θ), 1/m/sr: in-scattering per unit radiance and solid angle (Premože 2003, eq. 10).
    pub fn in_scattering(&self, cos_theta: f64) -> Bands {
        let mut total = spectrum::ZERO;
        for (matter, &density) in self.matter.iter().zip(self.density) {
            if density > 0.0 && matter.scattering_per_m != spectrum::ZERO {
                spectrum::accumulate(&mut total, density * matter.phase.value(cos_theta), matter.scattering_per_m);
            }
        }
        total
    }
}

/// A unit vector at polar angle acos(`cosine`) and azimuth 2π`turn` around the unit vector `axis`.
pub fn around(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    let (x, y) = axis.any_orthonormal_pair();
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (sin_azimuth, cos_azimuth) = (std::f64::consts::TAU * turn).sin_cos();
    axis * cosine + (x * cos_azimuth + y * sin_azimuth) * sine
}
