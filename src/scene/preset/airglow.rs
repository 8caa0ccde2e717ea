//! The Earth's night airglow: chemiluminescence of atomic oxygen, sodium and hydroxyl between about 87 and 97 km
//! (Khomich, Semenov and Shefov 2008, "Airglow as an Indicator of Upper Atmospheric Structure and Dynamics").
//!
//! Its lines are spread evenly over each band, which makes the colour right for broad-band photometry and too little
//! green for an eye that sees the 557.7 nm line. The line at 630 nm, from 250 km, is counted with the rest.

use welkin_lut::{BAND_COUNT, Bands, Constituent, DensityProfile, PhaseFunction};

use super::SOLAR_IRRADIANCE;

/// Brightness at the zenith in tenth-magnitude stars of solar colour per square degree, S10⊙, in R, V and B.
///
/// In V 145 at solar minimum (Benn and Ellison 1998, La Palma technical note 115; Leinert et al. 1998, A&A Suppl. 127, 1,
/// have the same order). In R and B what is left of the darkest sky, 21.0 and 22.7 mag per square arcsecond, when
/// 60 S10⊙ of zodiacal light at the ecliptic poles and 0.10 and 0.02 mag of artificial light are taken off, all from
/// the same note; in V, 21.9 mag, the same sum leaves 145 too. At solar maximum it is about twice as bright.
const ZENITH_S10: Bands = [275.0, 145.0, 132.0];

/// The sun's apparent V magnitude.
const SOLAR_MAGNITUDE: f64 = -26.75;

/// A triangle over altitude that holds the layers of all three emitters, m.
const CENTRE_M: f64 = 92_000.0;
const HALF_WIDTH_M: f64 = 8_000.0;

/// Radiance of 1 S10⊙ per unit of solar irradiance, 1/sr.
fn s10_per_sr() -> f64 {
    let square_degree_sr = 1_f64.to_radians().powi(2);
    10_f64.powf(-0.4 * (10.0 - SOLAR_MAGNITUDE)) / square_degree_sr
}

/// The layer, which neither scatters nor absorbs.
pub fn airglow() -> Constituent {
    // A triangle's column is its half width.
    let emission = |band: usize| ZENITH_S10[band] * SOLAR_IRRADIANCE[band] * s10_per_sr() / HALF_WIDTH_M;
    Constituent {
        name: "airglow".to_owned(),
        scattering_per_m: [0.0; BAND_COUNT],
        absorption_per_m: [0.0; BAND_COUNT],
        emission_per_m: std::array::from_fn(emission),
        profile: DensityProfile::Tent { centre_m: CENTRE_M, half_width_m: HALF_WIDTH_M },
        phase: PhaseFunction::Isotropic,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dark_sky_is_airglow_zodiacal_light_and_little_else() {
        // m mag per square arcsecond are 10^(0.4 (27.78 + colour - m)) S10⊙, with 27.78 = 10 + 5 log10(3600) and the sun's
        // V - R = 0.356, B - V = 0.653 (Ramírez et al. 2012, ApJ 752, 5).
        let sky = [(21.0, -0.356, 0.10), (21.9, 0.0, 0.10), (22.7, 0.653, 0.02)];
        for ((magnitude, colour, artificial), glow) in sky.into_iter().zip(ZENITH_S10) {
            let total = 10_f64.powf(0.4 * (10.0 + 5.0 * 3600_f64.log10() + colour - magnitude));
            let natural = total * 10_f64.powf(-0.4 * artificial);
            assert!(((glow + 60.0) / natural - 1.0).abs() < 0.02, "{glow} + 60 of {natural}");
        }
    }

    #[test]
    fn the_zenith_is_as_bright_as_published() {
        // 1 S10⊙ is 1.2e-11 W/m2/sr/nm in V (Leinert et al. 1998, table 2: 1.18e-8 W/m2/sr/µm at 550 nm, within 3 %).
        let green = airglow().emission_per_m[1] * HALF_WIDTH_M;
        assert!((green / (145.0 * 1.2e-11) - 1.0).abs() < 0.03, "{green}");
    }
}
