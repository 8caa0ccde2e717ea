//! How much sunlight the moon sends on, by phase and wavelength.

use std::f64::consts::PI;

/// Solid angle of the moon at its mean distance, to which the ROLO model refers, sr.
const MEAN_SOLID_ANGLE_SR: f64 = 6.4177e-5;

/// Kieffer and Stone 2005 ("The Spectral Irradiance of the Moon", AJ 129, 2887), table 4, the visible bands: wavelength in
/// nm, a0 .. a3 of the phase angle in radians, d1 .. d3 of the opposition's brightening. The terms of libration and of the
/// asymmetry between waxing and waning, up to 7 and 5 %, are left out.
const ROLO: [[f64; 8]; 16] = [
    [350.0, -2.67511, -1.78539, 0.50612, -0.25578, 0.34185, 0.01441, -0.01602],
    [355.1, -2.71924, -1.74298, 0.44523, -0.23315, 0.33875, 0.01612, -0.00996],
    [405.0, -2.35754, -1.72134, 0.40337, -0.21105, 0.35235, -0.03818, -0.00006],
    [412.3, -2.34185, -1.74337, 0.42156, -0.21512, 0.36591, -0.05902, 0.00080],
    [414.4, -2.43367, -1.72184, 0.43600, -0.22675, 0.35558, -0.03247, -0.00503],
    [441.6, -2.31964, -1.72114, 0.37286, -0.19304, 0.37935, -0.09562, 0.00970],
    [465.8, -2.35085, -1.66538, 0.41802, -0.22541, 0.33450, -0.02546, -0.00484],
    [475.0, -2.28999, -1.63180, 0.36193, -0.20381, 0.33024, -0.03131, 0.00222],
    [486.9, -2.23351, -1.68573, 0.37632, -0.19877, 0.36590, -0.08945, 0.00678],
    [544.0, -2.13864, -1.60613, 0.27886, -0.16426, 0.37190, -0.10629, 0.01428],
    [549.1, -2.10782, -1.66736, 0.41697, -0.22026, 0.36814, -0.09815, 0.0],
    [553.8, -2.12504, -1.65970, 0.38409, -0.20655, 0.37206, -0.10745, 0.00347],
    [665.1, -1.88914, -1.58096, 0.30477, -0.17908, 0.37141, -0.13514, 0.01248],
    [693.1, -1.89410, -1.58509, 0.28080, -0.16427, 0.39109, -0.17048, 0.01754],
    [703.6, -1.92103, -1.60151, 0.36924, -0.20567, 0.37155, -0.13989, 0.00412],
    [774.8, -1.80271, -1.59357, 0.36351, -0.20326, 0.36908, -0.16182, 0.00830],
];

/// The same for all bands, degrees.
const P: [f64; 4] = [4.06054, 12.8802, -30.5858, 16.7498];

/// Below this phase angle the full moon would stand in the Earth's shadow, and the model has no data, rad.
const SMALLEST_PHASE_RAD: f64 = 1.55 * PI / 180.0;

/// The Earth's geometric albedo (Mallama et al. 2017, Icarus 282, 19, V band).
const EARTH_GEOMETRIC_ALBEDO: f64 = 0.434;

/// (Radius of the Earth over the distance of the moon)².
const EARTH_SIZE_SQUARED: f64 = (6371.0 / 384_400.0) * (6371.0 / 384_400.0);

fn reflectance_in_band(row: &[f64; 8], phase_rad: f64) -> f64 {
    let [_, a0, a1, a2, a3, d1, d2, d3] = *row;
    let (g, degrees) = (phase_rad, phase_rad.to_degrees());
    let opposition = d1 * (-degrees / P[0]).exp() + d2 * (-degrees / P[1]).exp() + d3 * ((degrees - P[2]) / P[3]).cos();
    (a0 + g * (a1 + g * (a2 + g * a3)) + opposition).exp()
}

/// A_k, disc-equivalent reflectance at a wavelength in nm and a phase angle in [0, π] (0 full, π new), between the bands
/// linear in wavelength. Fitted from 1.55 to 97°; beyond, where the moon is a crescent, it is extrapolated.
fn disc_reflectance(wavelength_nm: f64, phase_rad: f64) -> f64 {
    let phase_rad = phase_rad.max(SMALLEST_PHASE_RAD);
    let next = ROLO.partition_point(|row| row[0] < wavelength_nm).clamp(1, ROLO.len() - 1);
    let (low, high) = (&ROLO[next - 1], &ROLO[next]);
    let share = ((wavelength_nm - low[0]) / (high[0] - low[0])).clamp(0.0, 1.0);
    (1.0 - share) * reflectance_in_band(low, phase_rad) + share * reflectance_in_band(high, phase_rad)
}

/// Irradiance from the sunlit part of the moon at its mean distance, relative to the sun's (Kieffer and Stone, eq. 8).
pub fn sunlit_share(wavelength_nm: f64, phase_rad: f64) -> f64 {
    disc_reflectance(wavelength_nm, phase_rad) * MEAN_SOLID_ANGLE_SR / PI
}

/// Irradiance from moonlight that the Earth has lit, relative to the sun's: the moon reflects it straight back, under a
/// phase angle of 0, and sees the Earth, taken as a Lambertian sphere, in the phase opposite to its own.
pub fn earthlit_share(wavelength_nm: f64, phase_rad: f64) -> f64 {
    let earth_phase_rad = PI - phase_rad;
    let lambert = (earth_phase_rad.sin() + (PI - earth_phase_rad) * earth_phase_rad.cos()) / PI;
    EARTH_GEOMETRIC_ALBEDO * EARTH_SIZE_SQUARED * lambert.max(0.0) * sunlit_share(wavelength_nm, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_full_moon_is_four_hundred_thousand_times_fainter_than_the_sun() {
        // -12.73 against -26.75 mag (Allen 1976; Krisciunas and Schaefer 1991): 2.5e-6, brighter still at opposition.
        let share = sunlit_share(550.0, 3_f64.to_radians());
        assert!((share / 2.5e-6 - 1.0).abs() < 0.1, "{share}");
    }

    #[test]
    fn the_phase_law_is_that_of_the_eye() {
        // V = -12.73 + 0.026 |α| + 4e-9 α⁴ (Krisciunas and Schaefer 1991, eq. 9), α in degrees. Their law is rounder than
        // ROLO's; they keep within a fifth up to where ROLO's data end.
        let ratio = |degrees: f64| sunlit_share(550.0, degrees.to_radians()) / sunlit_share(550.0, 10_f64.to_radians());
        let eye = |a: f64| 10_f64.powf(-0.4 * (0.026 * a + 4e-9 * a.powi(4)));
        for degrees in [30.0, 60.0, 90.0] {
            let off = ratio(degrees) / (eye(degrees) / eye(10.0)) - 1.0;
            assert!(off.abs() < 0.2, "{off} at {degrees}°");
        }
        // A half moon sends a tenth of a full one.
        let half = sunlit_share(550.0, 0.5 * PI) / sunlit_share(550.0, 3_f64.to_radians());
        assert!((0.07..0.11).contains(&half), "{half}");
    }

    #[test]
    fn moonlight_is_redder_than_sunlight() {
        // B - V is 0.92 against the sun's 0.65 (Allen 1976): 0.27 mag.
        let ratio = sunlit_share(440.0, 0.2) / sunlit_share(550.0, 0.2);
        assert!((-2.5 * ratio.log10() - 0.27).abs() < 0.06, "{}", -2.5 * ratio.log10());
        assert!(sunlit_share(680.0, 0.2) > 1.1 * sunlit_share(550.0, 0.2));
    }

    #[test]
    fn a_young_moon_holds_the_old_one_ten_thousand_times_fainter_than_a_full_moon() {
        // Goode et al. 2001 (GRL 28, 1671): earthshine is about 1e-4 of moonlight.
        let share = earthlit_share(550.0, 170_f64.to_radians()) / sunlit_share(550.0, 0.1);
        assert!((0.7e-4..2.5e-4).contains(&share), "{share}");
        assert!(earthlit_share(550.0, 0.0) < 1e-15);
    }
}
