//! What three values at the bands say of the wavelengths between and beyond.

use crate::{BAND_WAVELENGTHS_NM, Bands};

/// Steepest power of the wavelength that is continued beyond the bands: that of molecular scattering.
const STEEPEST_POWER: f64 = 4.0;

/// A coefficient at any wavelength from its values in the bands: a power of the wavelength between neighbouring bands,
/// continued beyond them with a power of at most ±4. Where a band is zero no power exists; then linear, and constant
/// beyond. Exact at the bands. Scattering by molecules (λ⁻⁴) and by haze (Ångström's law) are such powers.
pub fn between_bands(bands: Bands, wavelength_nm: f64) -> f64 {
    if let Some(band) = BAND_WAVELENGTHS_NM.iter().position(|&band_nm| band_nm == wavelength_nm) {
        return bands[band];
    }
    if bands.iter().any(|&value| value <= 0.0) {
        return linear(bands, wavelength_nm);
    }
    let [low, high] = neighbours(wavelength_nm);
    let log_ratio = |values: &Bands| (values[high] / values[low]).ln();
    let power = log_ratio(&bands) / log_ratio(&BAND_WAVELENGTHS_NM);
    let nearest = if wavelength_nm < BAND_WAVELENGTHS_NM[low] { low } else { high };
    let inside = (BAND_WAVELENGTHS_NM[2]..=BAND_WAVELENGTHS_NM[0]).contains(&wavelength_nm);
    let power = if inside { power } else { power.clamp(-STEEPEST_POWER, STEEPEST_POWER) };
    bands[nearest] * (wavelength_nm / BAND_WAVELENGTHS_NM[nearest]).powf(power)
}

/// A known spectrum, times what a scene changes of it: `bands` over `known_bands`, linear between the bands and constant
/// beyond. With nothing changed it is the spectrum. A band in which both are zero says nothing and takes the factor of the
/// next; where only the known one is zero the spectrum does not apply, and it is [`between_bands`].
pub fn scaled_between_bands(
    spectrum: impl Fn(f64) -> f64,
    known_bands: Bands,
    bands: Bands,
    wavelength_nm: f64,
) -> f64 {
    let factor = |band: usize| match (known_bands[band], bands[band]) {
        (0.0, 0.0) => Some(None),
        (0.0, _) => None,
        (known, value) => Some(Some(value / known)),
    };
    let [Some(r), Some(g), Some(b)] = [factor(0), factor(1), factor(2)] else {
        return between_bands(bands, wavelength_nm);
    };
    let factors = [r.or(g).or(b), g.or(b).or(r), b.or(g).or(r)].map(|factor| factor.unwrap_or(1.0));
    spectrum(wavelength_nm) * linear(factors, wavelength_nm)
}

/// Linear between the bands, constant beyond.
fn linear(bands: Bands, wavelength_nm: f64) -> f64 {
    let [low, high] = neighbours(wavelength_nm);
    let (from, to) = (BAND_WAVELENGTHS_NM[low], BAND_WAVELENGTHS_NM[high]);
    let share = ((wavelength_nm - from) / (to - from)).clamp(0.0, 1.0);
    bands[low] + (bands[high] - bands[low]) * share
}

/// Bands of shorter and longer wavelength around one, or the two that are nearest.
fn neighbours(wavelength_nm: f64) -> [usize; 2] {
    if wavelength_nm < BAND_WAVELENGTHS_NM[1] { [2, 1] } else { [1, 0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_of_the_wavelength_comes_back_everywhere() {
        for power in [-4.0, -1.42, 0.0, 1.0] {
            let law = |wavelength_nm: f64| 3e-5 * (wavelength_nm / 550.0_f64).powf(power);
            for wavelength_nm in [360.0, 400.0, 440.0, 500.0, 550.0, 600.0, 680.0, 780.0] {
                let value = between_bands(BAND_WAVELENGTHS_NM.map(law), wavelength_nm);
                assert!((value / law(wavelength_nm) - 1.0).abs() < 1e-12, "power {power} at {wavelength_nm} nm");
            }
        }
    }

    #[test]
    fn the_bands_themselves_come_back_exactly() {
        for bands in [[0.1, 0.7, 0.3], [0.0, 2.0, 1.0], [5.802e-6, 13.558e-6, 33.1e-6]] {
            assert_eq!(BAND_WAVELENGTHS_NM.map(|wavelength_nm| between_bands(bands, wavelength_nm)), bands);
        }
    }

    #[test]
    fn a_band_of_zero_makes_it_linear_and_never_negative() {
        let bands = [1.0, 0.0, 4.0];
        assert!((between_bands(bands, 495.0) - 2.0).abs() < 1e-12 && (between_bands(bands, 615.0) - 0.5).abs() < 1e-12);
        assert_eq!((between_bands(bands, 360.0), between_bands(bands, 800.0)), (4.0, 1.0));
    }

    #[test]
    fn a_known_spectrum_is_scaled_by_what_differs_from_it() {
        let (spectrum, known) = (|wavelength_nm: f64| 700.0 - wavelength_nm, [20.0, 150.0, 260.0]);
        let at = |bands| scaled_between_bands(spectrum, known, bands, 495.0);
        assert_eq!(at(known), 205.0);
        assert_eq!(at(known.map(|value| 3.0 * value)), 615.0);
        assert!((at([20.0, 150.0, 520.0]) - 1.5 * 205.0).abs() < 1e-9);
        // Nothing is known of a band that the spectrum has not.
        assert_eq!(scaled_between_bands(spectrum, [0.0, 1.0, 1.0], [1.0, 1.0, 1.0], 495.0), 1.0);
        assert_eq!(scaled_between_bands(spectrum, [0.0, 1.0, 1.0], [0.0, 2.0, 2.0], 690.0), 20.0);
    }
}
