//! Planets with their air and sun, by name.

mod airglow;
mod earth;
mod hillaire2020;
mod mars;
mod spectra;

pub(super) use spectra::Quantity;

use schemars::JsonSchema;
use serde::Deserialize;
use welkin_lut::spectrum::three_bands::SOLAR_IRRADIANCE;
use welkin_lut::{Bands, Constituent, DensityProfile, Medium, PhaseFunction, Planet};

/// A planet with its air and sun, from published numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// The Earth as measured: molecular scattering by Bodhaine 1999, clean continental aerosol, 300 Dobson units of ozone.
    Earth,
    /// The Earth of the engines that follow Hillaire 2020; its molecular scattering is 15 to 20 % above the measured.
    Hillaire2020,
    /// Mars on a clear day: dust of optical depth 0.5 in thin carbon dioxide.
    Mars,
}

/// What a preset says of its sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PresetSun {
    /// Irradiance normal to the beam above the atmosphere, W·m⁻²·nm⁻¹.
    pub irradiance: Bands,
    /// Angular radius of the disc, rad.
    pub angular_radius_rad: f64,
    /// Whether the disc darkens towards its limb.
    pub limb_darkening: bool,
}

/// The sun's mean angular radius at one astronomical unit: 695 700 km (IAU 2015 resolution B3) over 149 597 870.7 km, rad.
const SOLAR_ANGULAR_RADIUS_RAD: f64 = 695_700.0 / 149_597_870.7;

impl Preset {
    /// What a scene file calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Earth => "earth",
            Self::Hillaire2020 => "hillaire2020",
            Self::Mars => "mars",
        }
    }

    /// The sphere and its shell of air.
    pub fn planet(self) -> Planet {
        match self {
            Self::Earth => earth::planet(),
            Self::Hillaire2020 => hillaire2020::planet(),
            Self::Mars => mars::planet(),
        }
    }

    /// The air.
    pub fn medium(self) -> Medium {
        match self {
            Self::Earth => earth::medium(),
            Self::Hillaire2020 => hillaire2020::medium(),
            Self::Mars => mars::medium(),
        }
    }

    /// Constituents that a scene file can add by their name alone.
    pub fn optional(self) -> Vec<Constituent> {
        match self {
            Self::Earth | Self::Hillaire2020 => vec![airglow::airglow()],
            Self::Mars => vec![],
        }
    }

    /// The sun.
    pub fn sun(self) -> PresetSun {
        match self {
            Self::Earth => earth::sun(),
            Self::Hillaire2020 => hillaire2020::sun(),
            Self::Mars => mars::sun(),
        }
    }

    /// Whether a date and a place on Earth say where the sun stands.
    pub fn is_earth(self) -> bool {
        self != Self::Mars
    }
}

fn exponential(
    name: &str,
    scattering_per_m: Bands,
    absorption_per_m: Bands,
    scale_height_m: f64,
    phase: PhaseFunction,
) -> Constituent {
    Constituent {
        name: name.to_owned(),
        scattering_per_m,
        absorption_per_m,
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Exponential { scale_height_m },
        phase,
    }
}

/// Ozone in a triangle over altitude between 10 and 40 km. 300 Dobson units are 8.06e22 molecules/m²; spread over the
/// triangle's 15 km they have this peak, 1/m³.
const OZONE_PEAK_PER_M3: f64 = 8.06e22 / 15_000.0;

/// That ozone, at its peak times the cross sections 1.21e-25, 3.50e-25 and 1.58e-26 m² at 680, 550 and 440 nm.
fn ozone() -> Constituent {
    Constituent {
        name: "ozone".to_owned(),
        scattering_per_m: [0.0; 3],
        absorption_per_m: [0.650e-6, 1.881e-6, 0.085e-6],
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Tent { centre_m: 25_000.0, half_width_m: 15_000.0 },
        phase: PhaseFunction::Isotropic,
    }
}

#[cfg(test)]
mod tests {
    use super::Preset;

    #[test]
    fn every_preset_is_a_possible_world() {
        for preset in [Preset::Earth, Preset::Hillaire2020, Preset::Mars] {
            preset.planet().validate().unwrap();
            preset.medium().validate().unwrap();
            preset.optional().iter().for_each(|constituent| constituent.validate().unwrap());
        }
    }
}
