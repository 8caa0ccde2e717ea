//! The presets' air at any wavelength.

use welkin_lut::spectrum::{molecular, ozone};
use welkin_lut::{Bands, Constituent};

use super::{OZONE_PEAK_PER_M3, Preset, earth, mars};

/// What of a constituent depends on the wavelength.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// b.
    Scattering,
    /// a.
    Absorption,
    /// a·L_e.
    Emission,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Scattering, Self::Absorption, Self::Emission];

    /// Its field in a scene file.
    pub fn field(self) -> &'static str {
        match self {
            Self::Scattering => "scattering_per_m",
            Self::Absorption => "absorption_per_m",
            Self::Emission => "emission_per_m",
        }
    }

    /// A constituent's values.
    pub fn of(self, constituent: &mut Constituent) -> &mut Bands {
        match self {
            Self::Scattering => &mut constituent.scattering_per_m,
            Self::Absorption => &mut constituent.absorption_per_m,
            Self::Emission => &mut constituent.emission_per_m,
        }
    }
}

/// A coefficient by wavelength in nm.
pub type Spectrum = fn(f64) -> f64;

impl Preset {
    /// The spectrum of a constituent's coefficient and the values in the bands that the preset has for it, where they are
    /// more than a power of the wavelength.
    ///
    /// The spectra meet the values in the bands to their rounding, but for ozone, whose values are means over the 10 nm
    /// above the wavelengths.
    pub fn spectrum(self, constituent: &str, quantity: Quantity) -> Option<(Spectrum, Bands)> {
        let spectrum: Spectrum = match (self, constituent, quantity) {
            (Self::Earth, "rayleigh", Quantity::Scattering) => |nm| molecular::standard_air_per_m(nm, earth::CO2_SHARE),
            (Self::Hillaire2020, "rayleigh", Quantity::Scattering) => molecular::engines_air_per_m,
            (Self::Earth, "aerosol", Quantity::Scattering) => earth::aerosol_scattering_per_m,
            (Self::Earth, "aerosol", Quantity::Absorption) => earth::aerosol_absorption_per_m,
            (Self::Earth | Self::Hillaire2020, "ozone", Quantity::Absorption) => {
                |nm| OZONE_PEAK_PER_M3 * ozone::cross_section_m2(nm)
            }
            (Self::Mars, "dust_diffraction_rg", Quantity::Scattering) => mars::wide_diffraction_per_m,
            (Self::Mars, "dust_diffraction_b", Quantity::Scattering) => mars::narrow_diffraction_per_m,
            (Self::Mars, "dust_refraction", Quantity::Scattering) => mars::refraction_per_m,
            (Self::Mars, "dust_refraction", Quantity::Absorption) => mars::absorption_per_m,
            _ => return None,
        };
        let mut medium = self.medium();
        let constituent = medium.constituents.iter_mut().find(|other| other.name == constituent)?;
        Some((spectrum, *quantity.of(constituent)))
    }
}

#[cfg(test)]
mod tests {
    use welkin_lut::BAND_WAVELENGTHS_NM;

    use super::*;

    #[test]
    fn spectra_meet_the_presets_bands() {
        for preset in [Preset::Earth, Preset::Hillaire2020, Preset::Mars] {
            for constituent in preset.medium().constituents {
                for quantity in Quantity::ALL {
                    let Some((spectrum, bands)) = preset.spectrum(&constituent.name, quantity) else { continue };
                    // The bands of ozone are means over the 10 nm above.
                    let above_nm = if constituent.name == "ozone" { 5.0 } else { 0.0 };
                    for (nm, value) in BAND_WAVELENGTHS_NM.into_iter().zip(bands) {
                        let computed = spectrum(nm + above_nm);
                        // Ozone's 0.085e-6 has two digits.
                        let rounding = 1.5e-3 * value;
                        assert!(
                            (computed - value).abs() <= rounding,
                            "{} at {nm} nm: {computed}, not {value}",
                            constituent.name
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_dust_of_mars_is_as_thick_at_every_wavelength() {
        let names = ["dust_diffraction_rg", "dust_diffraction_b", "dust_refraction"];
        let extinction = |nm: f64| -> f64 {
            let scattered = names.map(|name| Preset::Mars.spectrum(name, Quantity::Scattering).unwrap().0(nm));
            let absorbed = Preset::Mars.spectrum("dust_refraction", Quantity::Absorption).unwrap().0(nm);
            scattered.iter().sum::<f64>() + absorbed
        };
        for nm in [380.0, 430.0, 470.0, 530.0, 600.0, 700.0] {
            assert!((extinction(nm) / extinction(550.0) - 1.0).abs() < 1e-12);
        }
    }
}
