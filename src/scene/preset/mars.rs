//! Mars on a clear day.
//!
//! Dust grains of about 1.5 µm are several wavelengths wide. Half of what they remove from the beam is diffracted around
//! them into a narrow cone, as much in every colour but the narrower the shorter the wave; the other half enters them
//! and comes out in wide angles, less of it in blue, which iron oxides absorb. Separate constituents say just that, and
//! with it the blue glow around a low sun in a butterscotch sky (Ehlers et al. 2014, Appl. Opt. 53, 1808: it is
//! near-forward scattering, not extinction).

use welkin_lut::spectrum::scaled_between_bands;
use welkin_lut::{BAND_COUNT, BAND_WAVELENGTHS_NM, Bands, Medium, PhaseFunction, Planet};

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

/// Diffraction by a grain of radius r falls to half at 1.616 λ/(2πr) (Airy); a Henyey-Greenstein lobe with these mean
/// cosines does so too, for 1.5 µm, and its tail falls with the same power of the angle. Red and green share a lobe, for
/// every lobe costs time.
const RED_GREEN_DIFFRACTION_ASYMMETRY: f64 = 0.873;
const BLUE_DIFFRACTION_ASYMMETRY: f64 = 0.907;

/// Brings the mean cosine of all dust to 0.67 in red and 0.75 in blue; retrievals lie about there.
const REFRACTION_ASYMMETRY: f64 = 0.45;

pub fn planet() -> Planet {
    // Bright, dusty ground (Bell et al. 2000, J. Geophys. Res. 105, 1721), rounded.
    Planet { radius_m: 3_389_500.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.30, 0.14, 0.06] }
}

pub fn medium() -> Medium {
    let half = HALF_PER_M;
    // ω c = c/2 + b: what the albedo leaves for light that went through a grain.
    let refracted: Bands = std::array::from_fn(|band| half * (2.0 * DUST_ALBEDO[band] - 1.0));
    let absorbed: Bands = std::array::from_fn(|band| half - refracted[band]);
    let phase = |g| PhaseFunction::HenyeyGreenstein { g };
    let none = [0.0; BAND_COUNT];
    let constituents = vec![
        exponential("carbon_dioxide", MOLECULAR_SCATTERING_PER_M, none, SCALE_HEIGHT_M, PhaseFunction::Rayleigh),
        exponential(
            "dust_diffraction_rg",
            [half, half, 0.0],
            none,
            SCALE_HEIGHT_M,
            phase(RED_GREEN_DIFFRACTION_ASYMMETRY),
        ),
        exponential("dust_diffraction_b", [0.0, 0.0, half], none, SCALE_HEIGHT_M, phase(BLUE_DIFFRACTION_ASYMMETRY)),
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

/// Half of the dust's extinction, which is the same at all wavelengths, 1/m.
const HALF_PER_M: f64 = 0.5 * DUST_OPTICAL_DEPTH / SCALE_HEIGHT_M;

/// How much of the diffraction belongs to the narrow lobe: all of it at 440 nm and none at 550 nm, linear in between, for
/// the lobe narrows steadily as the wave gets shorter.
fn narrow_share(wavelength_nm: f64) -> f64 {
    let [_, green_nm, blue_nm] = BAND_WAVELENGTHS_NM;
    ((green_nm - wavelength_nm) / (green_nm - blue_nm)).clamp(0.0, 1.0)
}

/// `dust_diffraction_rg` at any wavelength, 1/m.
pub fn wide_diffraction_per_m(wavelength_nm: f64) -> f64 {
    HALF_PER_M * (1.0 - narrow_share(wavelength_nm))
}

/// `dust_diffraction_b` at any wavelength, 1/m.
pub fn narrow_diffraction_per_m(wavelength_nm: f64) -> f64 {
    HALF_PER_M * narrow_share(wavelength_nm)
}

/// Scattering by `dust_refraction` at any wavelength, 1/m: the albedo is linear between the bands, constant beyond.
pub fn refraction_per_m(wavelength_nm: f64) -> f64 {
    let albedo = scaled_between_bands(|_| 1.0, [1.0; BAND_COUNT], DUST_ALBEDO, wavelength_nm);
    HALF_PER_M * (2.0 * albedo - 1.0)
}

/// Absorption by `dust_refraction` at any wavelength, 1/m.
pub fn absorption_per_m(wavelength_nm: f64) -> f64 {
    HALF_PER_M - refraction_per_m(wavelength_nm)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dust_together_has_its_optical_depth_and_albedo() {
        let medium = medium();
        let dust = &medium.constituents[1..];
        for (band, albedo) in DUST_ALBEDO.iter().enumerate() {
            let scattering: f64 = dust.iter().map(|lobe| lobe.scattering_per_m[band]).sum();
            let extinction: f64 = dust.iter().map(|lobe| lobe.extinction_per_m()[band]).sum();
            assert!((extinction * SCALE_HEIGHT_M - DUST_OPTICAL_DEPTH).abs() < 1e-12);
            assert!((scattering / extinction - albedo).abs() < 1e-12);
        }
    }

    #[test]
    fn a_diffraction_lobe_is_half_as_bright_where_an_airy_disc_is() {
        let red_green_um = 0.5 * (0.680 + 0.550);
        for (g, wavelength_um) in [(RED_GREEN_DIFFRACTION_ASYMMETRY, red_green_um), (BLUE_DIFFRACTION_ASYMMETRY, 0.440)]
        {
            let half_angle: f64 = 1.616 * wavelength_um / (2.0 * std::f64::consts::PI * 1.5);
            let lobe = PhaseFunction::HenyeyGreenstein { g };
            let ratio = lobe.value(half_angle.cos()) / lobe.value(1.0);
            assert!((ratio - 0.5).abs() < 0.02, "{ratio} at {wavelength_um} µm");
        }
    }

    #[test]
    fn dust_is_blue_towards_the_sun_and_red_away_from_it() {
        let medium = medium();
        let towards = |band: usize, cos_theta: f64| -> f64 {
            medium.constituents[1..].iter().map(|lobe| lobe.scattering_per_m[band] * lobe.phase.value(cos_theta)).sum()
        };
        let blue_over_red = |cos_theta| towards(2, cos_theta) / towards(0, cos_theta);
        assert!(blue_over_red(1.0) > 1.5);
        assert!(blue_over_red(0.0) < 0.75);
    }
}
