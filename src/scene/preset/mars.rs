//! Mars on a clear day.
//!
//! Dust grains of about 1.5 µm are several wavelengths wide. Half of what they remove from the beam is diffracted around
//! them, in every colour alike and into a narrow cone; the other half enters them and comes out in wide angles, less of
//! it in blue, which iron oxides absorb. Two constituents say just that, and with it the blue glow around a low sun in a
//! butterscotch sky (Ehlers et al. 2014, Appl. Opt. 53, 1808: it is near-forward scattering, not extinction).

use welkin_lut::{BAND_COUNT, Bands, Medium, PhaseFunction, Planet};

use super::{PresetSun, SOLAR_ANGULAR_RADIUS_RAD, SOLAR_IRRADIANCE, exponential};

/// Mean distance from the sun, astronomical units.
const DISTANCE_AU: f64 = 1.524;

/// Gas and well-mixed dust alike, m (Kahn et al. 1981, J. Geophys. Res. 86, 5833: dust falls off as the gas does).
const SCALE_HEIGHT_M: f64 = 11_100.0;

/// Carbon dioxide at 610 Pa and 210 K, 2.10e23 molecules/m³, times its cross section: 1.24e-30 m² at 532 nm (Sneep and
/// Ubachs 2005, J. Quant. Spectrosc. Radiat. Transf. 92, 293), as λ⁻⁴ to 680, 550 and 440 nm, 1/m.
const MOLECULAR_SCATTERING_PER_M: Bands = [0.98e-7, 2.28e-7, 5.58e-7];

/// Optical depth of the dust between storms, the same in all bands; landers see 0.3 to 1 (Lemmon et al. 2015, Icarus 251, 96).
const DUST_OPTICAL_DEPTH: f64 = 0.5;

/// Single-scattering albedo of the dust, rounded from the Pathfinder values at 671 and 444 nm (Tomasko et al. 1999,
/// J. Geophys. Res. 104, 8987) and between them.
const DUST_ALBEDO: Bands = [0.95, 0.86, 0.76];

/// Mean cosines of the two halves: together 0.69 in red and 0.75 in blue, as the same work has them.
const DIFFRACTION_ASYMMETRY: f64 = 0.9;
const REFRACTION_ASYMMETRY: f64 = 0.45;

pub fn planet() -> Planet {
    // Bright, dusty ground (Bell et al. 2000, J. Geophys. Res. 105, 1721), rounded.
    Planet { radius_m: 3_389_500.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.30, 0.14, 0.06] }
}

pub fn medium() -> Medium {
    let half = 0.5 * DUST_OPTICAL_DEPTH / SCALE_HEIGHT_M;
    // ω c = c/2 + b: what the albedo leaves for light that went through a grain.
    let refracted: Bands = std::array::from_fn(|band| half * (2.0 * DUST_ALBEDO[band] - 1.0));
    let absorbed: Bands = std::array::from_fn(|band| half - refracted[band]);
    let phase = |g| PhaseFunction::HenyeyGreenstein { g };
    let none = [0.0; BAND_COUNT];
    let constituents = vec![
        exponential("carbon_dioxide", MOLECULAR_SCATTERING_PER_M, none, SCALE_HEIGHT_M, PhaseFunction::Rayleigh),
        exponential("dust_diffraction", [half; BAND_COUNT], none, SCALE_HEIGHT_M, phase(DIFFRACTION_ASYMMETRY)),
        exponential("dust_refraction", refracted, absorbed, SCALE_HEIGHT_M, phase(REFRACTION_ASYMMETRY)),
    ];
    Medium { constituents }
}

pub fn sun() -> PresetSun {
    PresetSun {
        irradiance: SOLAR_IRRADIANCE.map(|irradiance| irradiance / (DISTANCE_AU * DISTANCE_AU)),
        angular_radius_rad: SOLAR_ANGULAR_RADIUS_RAD / DISTANCE_AU,
        limb_darkening: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_halves_of_the_dust_have_its_optical_depth_and_albedo() {
        let medium = medium();
        let dust = &medium.constituents[1..];
        for (band, albedo) in DUST_ALBEDO.iter().enumerate() {
            let scattering: f64 = dust.iter().map(|half| half.scattering_per_m[band]).sum();
            let extinction: f64 = dust.iter().map(|half| half.extinction_per_m()[band]).sum();
            assert!((extinction * SCALE_HEIGHT_M - DUST_OPTICAL_DEPTH).abs() < 1e-12);
            assert!((scattering / extinction - albedo).abs() < 1e-12);
        }
    }

    #[test]
    fn dust_is_blue_towards_the_sun_and_red_away_from_it() {
        let medium = medium();
        let towards = |band: usize, cos_theta: f64| -> f64 {
            medium.constituents[1..].iter().map(|half| half.scattering_per_m[band] * half.phase.value(cos_theta)).sum()
        };
        let blue_over_red = |cos_theta| towards(2, cos_theta) / towards(0, cos_theta);
        assert!(blue_over_red(1.0) > 0.98);
        assert!(blue_over_red(0.0) < 0.75);
    }
}
