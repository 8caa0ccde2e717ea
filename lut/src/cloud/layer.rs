//! A layer of clouds as a user describes it.

use super::form::CloudKind;
use crate::{Bands, PhaseFunction};

/// Density of liquid water, kg/m³.
const WATER_KG_PER_M3: f64 = 1000.0;

/// Clouds of one kind between two altitudes.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudLayer {
    /// What it is called in messages and tables.
    pub name: String,
    /// What its clouds look like.
    pub kind: CloudKind,
    /// Altitude of the base, m.
    pub base_m: f64,
    /// Altitude of the highest tops, m; above the base.
    pub top_m: f64,
    /// Share of the weather map on which clouds may form, 0 to 1. What a camera below sees covered is less, as a
    /// cloud is thin at its rim.
    pub coverage: f64,
    /// Liquid or frozen water in the densest part, g/m³.
    pub water_g_per_m3: f64,
    /// Effective radius of droplets, or of spheres with the crystals' volume and area, µm.
    pub effective_radius_um: f64,
    /// Single-scattering albedo b/c by band; droplets' is above 0.99999 in the visible.
    pub albedo: Bands,
    /// How they scatter.
    pub phase: PhaseFunction,
    /// Wind that carries the layer: east, north, m/s.
    pub wind_m_per_s: [f64; 2],
    /// Speed at which shapes change as if the noise rose, m/s.
    pub evolution_m_per_s: f64,
    /// Places the noise: another seed is another sky.
    pub seed: u32,
}

impl CloudLayer {
    /// A layer of a kind with all of its defaults.
    pub fn of_kind(kind: CloudKind) -> Self {
        let defaults = kind.defaults();
        Self {
            name: kind.name().to_owned(),
            kind,
            base_m: defaults.base_m,
            top_m: defaults.top_m,
            coverage: defaults.coverage,
            water_g_per_m3: defaults.water_g_per_m3,
            effective_radius_um: defaults.effective_radius_um,
            albedo: [1.0; 3],
            phase: kind.phase(defaults.effective_radius_um),
            wind_m_per_s: [0.0; 2],
            evolution_m_per_s: defaults.evolution_m_per_s,
            seed: 0,
        }
    }

    /// Extinction where the density is 1, 1/m: 3 LWC / (2 ρ r), for drops much larger than the wavelength, whose
    /// efficiency is 2 (Stephens 1978, eq. 10).
    pub fn extinction_per_m(&self) -> f64 {
        1.5 * (1e-3 * self.water_g_per_m3) / (WATER_KG_PER_M3 * 1e-6 * self.effective_radius_um)
    }

    /// Whether there is anything to see of it.
    pub fn is_empty(&self) -> bool {
        self.coverage <= 0.0 || self.top_m <= self.base_m || self.water_g_per_m3 <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extinction_follows_from_water_and_radius() {
        // Published extinctions of each kind, 1/m.
        for (kind, published) in [
            (CloudKind::Stratus, 0.043),
            (CloudKind::Stratocumulus, 0.05),
            (CloudKind::Cumulus, 0.064),
            (CloudKind::Congestus, 0.15),
            (CloudKind::Cumulonimbus, 0.25),
            (CloudKind::Cirrus, 0.0005),
        ] {
            let extinction = CloudLayer::of_kind(kind).extinction_per_m();
            assert!((extinction / published - 1.0).abs() < 0.01, "{kind:?}: {extinction}");
        }
    }
}
