//! The Earth as measured.
//!
//! It differs from `hillaire2020` in its molecular scattering, 13 to 16 % lower at sea level (the engines' numbers follow
//! 1.24062e-6 λ⁻⁴, λ in µm), its scale height, which gives the column of the standard atmosphere, an aerosol about
//! twelve times as thick in optical depth, and the mean radius of the Earth.

use welkin_lut::{Bands, Medium, PhaseFunction, Planet};

use super::{PresetSun, SOLAR_ANGULAR_RADIUS_RAD, SOLAR_IRRADIANCE, exponential, ozone};

/// Bodhaine et al. 1999 (J. Atmos. Oceanic Technol. 16, 1854, eqs. 4, 19, 22, 23), dry air with 360 ppm of carbon dioxide
/// at 288.15 K and 1013.25 hPa, at 680, 550 and 440 nm, 1/m: `spectrum::molecular`.
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

/// Share of carbon dioxide in that air.
pub const CO2_SHARE: f64 = 360e-6;

/// Scattering of the aerosol at any wavelength, 1/m.
pub fn aerosol_scattering_per_m(wavelength_nm: f64) -> f64 {
    AEROSOL_ALBEDO * aerosol_extinction_per_m(wavelength_nm)
}

/// Absorption of the aerosol at any wavelength, 1/m.
pub fn aerosol_absorption_per_m(wavelength_nm: f64) -> f64 {
    (1.0 - AEROSOL_ALBEDO) * aerosol_extinction_per_m(wavelength_nm)
}

/// 0.026 /km at 550 nm with the exponents above; one albedo and asymmetry stand for all wavelengths.
fn aerosol_extinction_per_m(wavelength_nm: f64) -> f64 {
    let to_500 = (wavelength_nm.max(500.0) / 550.0).powf(-1.42);
    2.600e-5 * to_500 * (wavelength_nm.min(500.0) / 500.0).powf(-1.10)
}

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
    use welkin_lut::spectrum::molecular::standard_air_per_m;

    use super::*;

    const WAVELENGTHS_UM: Bands = [0.680, 0.550, 0.440];

    #[test]
    fn molecular_scattering_is_that_of_standard_air() {
        for (constant, wavelength) in MOLECULAR_SCATTERING_PER_M.iter().zip(WAVELENGTHS_UM) {
            let computed = standard_air_per_m(1e3 * wavelength, CO2_SHARE);
            assert!((constant / computed - 1.0).abs() < 1e-4, "{constant} against {computed} at {wavelength} µm");
        }
    }

    #[test]
    fn aerosol_follows_its_angstrom_exponents() {
        for (constant, wavelength) in AEROSOL_EXTINCTION_PER_M.iter().zip(WAVELENGTHS_UM) {
            let computed = aerosol_extinction_per_m(1e3 * wavelength);
            assert!((constant / computed - 1.0).abs() < 1e-3, "{constant} against {computed} at {wavelength} µm");
        }
        assert!((AEROSOL_EXTINCTION_PER_M[1] * AEROSOL_SCALE_HEIGHT_M - 0.064).abs() < 1e-4);
    }
}
