//! Scattering by molecules.

use std::f64::consts::PI;

/// Molecules in a cubic metre of standard air, 288.15 K and 1013.25 hPa (Bodhaine et al. 1999).
const MOLECULES_PER_M3: f64 = 2.546_899e25;

/// Scattering coefficient of dry standard air (288.15 K, 1013.25 hPa) with a share of carbon dioxide, 1/m.
///
/// Bodhaine et al. 1999 (J. Atmos. Oceanic Technol. 16, 1854, eqs. 4, 19, 22, 23); holds from 250 nm to the near infrared.
pub fn standard_air_per_m(wavelength_nm: f64, co2_share: f64) -> f64 {
    // 1/µm², as their fits have it.
    let k = (wavelength_nm * 1e-3).powi(-2);
    let refractivity_300ppm = (8060.51 + 2_480_990.0 / (132.274 - k) + 17_455.7 / (39.329_57 - k)) * 1e-8;
    let n2 = (1.0 + refractivity_300ppm * (1.0 + 0.54 * (co2_share - 0.0003))).powi(2);
    let (nitrogen, oxygen) = (1.034 + 3.17e-4 * k, 1.096 + 1.385e-3 * k + 1.448e-4 * k * k);
    let co2_percent = co2_share * 100.0;
    let king =
        (78.084 * nitrogen + 20.946 * oxygen + 0.934 + co2_percent * 1.15) / (78.084 + 20.946 + 0.934 + co2_percent);
    let lorentz = (n2 - 1.0) / (n2 + 2.0);
    24.0 * PI.powi(3) * lorentz * lorentz * king / ((wavelength_nm * 1e-9).powi(4) * MOLECULES_PER_M3)
}

/// The engines' scattering coefficient at sea level: 1.24062e-6 λ⁻⁴ with λ in µm, 1/m (Bruneton 2017, Hillaire 2020).
pub fn engines_air_per_m(wavelength_nm: f64) -> f64 {
    1.240_62e-6 * (wavelength_nm * 1e-3).powi(-4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_scatters_as_published() {
        // Optical depth of a column at sea level and 45° latitude, their eq. 30; at a scale height of RT/(Mg). Gravity that
        // varies with altitude makes up to 0.2 %, the fit the rest.
        for wavelength_nm in [380.0, 440.0, 500.0, 550.0, 620.0, 680.0, 750.0] {
            let (k, l2) = ((wavelength_nm * 1e-3_f64).powi(-2), (wavelength_nm * 1e-3_f64).powi(2));
            let published = 0.002_152_0 * (1.045_599_6 - 341.290_61 * k - 0.902_308_50 * l2)
                / (1.0 + 0.002_705_988_9 * k - 85.968_563 * l2);
            let column = standard_air_per_m(wavelength_nm, 360e-6) * 8434.6;
            assert!((column / published - 1.0).abs() < 3e-3, "{column} against {published} at {wavelength_nm} nm");
        }
    }

    #[test]
    fn the_engines_bands_follow_their_law() {
        for (wavelength_nm, published) in [(680.0, 5.802e-6), (550.0, 13.558e-6), (440.0, 33.1e-6)] {
            assert!((engines_air_per_m(wavelength_nm) / published - 1.0).abs() < 1e-4);
        }
    }
}
