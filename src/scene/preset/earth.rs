//! The Earth as measured.
//!
//! It differs from `hillaire2020` in its molecular scattering, 13 to 16 % lower at sea level (the engines' numbers follow
//! 1.24062e-6 λ⁻⁴, λ in µm), its scale height, which gives the column of the standard atmosphere, an aerosol about
//! twelve times as thick in optical depth, and the mean radius of the Earth.

use welkin_lut::{Bands, Medium, PhaseFunction, Planet};

use super::{PresetSun, SOLAR_ANGULAR_RADIUS_RAD, SOLAR_IRRADIANCE, exponential, ozone};

/// Bodhaine et al. 1999 (J. Atmos. Oceanic Technol. 16, 1854, eqs. 4, 19, 22, 23), dry air with 360 ppm of carbon dioxide
/// at 288.15 K and 1013.25 hPa, at 680, 550 and 440 nm, 1/m. The test below computes them.
const MOLECULAR_SCATTERING_PER_M: Bands = [4.848e-6, 11.488e-6, 28.712e-6];

/// RT/(Mg) at 288.15 K: the isothermal scale height that gives the column of air which the surface pressure says.
const MOLECULAR_SCALE_HEIGHT_M: f64 = 8434.6;

/// Clean continental aerosol (Hess et al. 1998, OPAC, Bull. Am. Meteorol. Soc. 79, 831, table 4) at 550 nm: extinction
/// 0.026 /km, single-scattering albedo 0.972, asymmetry 0.709, Ångström exponents 1.42 above and 1.10 below 500 nm.
const AEROSOL_EXTINCTION_PER_M: Bands = [1.923e-5, 2.600e-5, 3.428e-5];
const AEROSOL_ALBEDO: f64 = 0.972;
const AEROSOL_ASYMMETRY: f64 = 0.709;

/// Gives the optical depth of the same model, 0.064 at 550 nm.
const AEROSOL_SCALE_HEIGHT_M: f64 = 2460.0;

pub fn planet() -> Planet {
    // The mean radius (Moritz 2000, GRS80) and about the mean reflectance of land and sea (Stephens et al. 2015).
    Planet { radius_m: 6_371_009.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.13; 3] }
}

pub fn medium() -> Medium {
    let scattering = AEROSOL_EXTINCTION_PER_M.map(|extinction| extinction * AEROSOL_ALBEDO);
    let absorption = AEROSOL_EXTINCTION_PER_M.map(|extinction| extinction * (1.0 - AEROSOL_ALBEDO));
    let forward = PhaseFunction::HenyeyGreenstein { g: AEROSOL_ASYMMETRY };
    let molecules = PhaseFunction::Rayleigh;
    let constituents = vec![
        exponential("rayleigh", MOLECULAR_SCATTERING_PER_M, [0.0; 3], MOLECULAR_SCALE_HEIGHT_M, molecules),
        exponential("aerosol", scattering, absorption, AEROSOL_SCALE_HEIGHT_M, forward),
        ozone(),
    ];
    Medium { constituents }
}

pub fn sun() -> PresetSun {
    PresetSun { irradiance: SOLAR_IRRADIANCE, angular_radius_rad: SOLAR_ANGULAR_RADIUS_RAD, limb_darkening: true }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const WAVELENGTHS_UM: Bands = [0.680, 0.550, 0.440];

    /// Scattering coefficient of standard air, 1/m; `k` is λ⁻², 1/µm².
    fn bodhaine_1999(wavelength_um: f64, co2_parts: f64) -> f64 {
        let k = wavelength_um.powi(-2);
        let refractivity_300ppm = (8060.51 + 2_480_990.0 / (132.274 - k) + 17_455.7 / (39.329_57 - k)) * 1e-8;
        let n2 = (1.0 + refractivity_300ppm * (1.0 + 0.54 * (co2_parts - 0.0003))).powi(2);
        let (nitrogen, oxygen) = (1.034 + 3.17e-4 * k, 1.096 + 1.385e-3 * k + 1.448e-4 * k * k);
        let co2_percent = co2_parts * 100.0;
        let king = (78.084 * nitrogen + 20.946 * oxygen + 0.934 + co2_percent * 1.15)
            / (78.084 + 20.946 + 0.934 + co2_percent);
        let molecules_per_m3 = 2.546_899e25;
        let wavelength_m = wavelength_um * 1e-6;
        let lorentz = (n2 - 1.0) / (n2 + 2.0);
        24.0 * PI.powi(3) * lorentz * lorentz * king / (wavelength_m.powi(4) * molecules_per_m3)
    }

    #[test]
    fn molecular_scattering_is_that_of_standard_air() {
        for (constant, wavelength) in MOLECULAR_SCATTERING_PER_M.iter().zip(WAVELENGTHS_UM) {
            let computed = bodhaine_1999(wavelength, 360e-6);
            assert!((constant / computed - 1.0).abs() < 1e-4, "{constant} against {computed} at {wavelength} µm");
        }
    }

    #[test]
    fn the_molecular_column_has_the_optical_depth_fitted_by_bodhaine() {
        // Their eq. 30, sea level at 45° latitude; its gravity varies with altitude, ours does not: 0.2 %.
        for (scattering, wavelength) in MOLECULAR_SCATTERING_PER_M.iter().zip(WAVELENGTHS_UM) {
            let (k, l2) = (wavelength.powi(-2), wavelength * wavelength);
            let published = 0.002_152_0 * (1.045_599_6 - 341.290_61 * k - 0.902_308_50 * l2)
                / (1.0 + 0.002_705_988_9 * k - 85.968_563 * l2);
            let column = scattering * MOLECULAR_SCALE_HEIGHT_M;
            assert!((column / published - 1.0).abs() < 3e-3, "{column} against {published}");
        }
    }

    #[test]
    fn aerosol_follows_its_angstrom_exponents() {
        let at_500 = AEROSOL_EXTINCTION_PER_M[1] * (0.550_f64 / 0.500).powf(1.42);
        let red = AEROSOL_EXTINCTION_PER_M[1] * (0.550_f64 / 0.680).powf(1.42);
        let blue = at_500 * (0.500_f64 / 0.440).powf(1.10);
        assert!((AEROSOL_EXTINCTION_PER_M[0] / red - 1.0).abs() < 1e-3, "{red}");
        assert!((AEROSOL_EXTINCTION_PER_M[2] / blue - 1.0).abs() < 1e-3, "{blue}");
        assert!((AEROSOL_EXTINCTION_PER_M[1] * AEROSOL_SCALE_HEIGHT_M - 0.064).abs() < 1e-4);
    }
}
