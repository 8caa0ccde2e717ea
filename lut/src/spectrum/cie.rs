//! The CIE 1931 standard observer, 2°.

use super::{EvenTable, LONGEST_NM, SHORTEST_NM};

/// Luminance of Y = 1, cd/m²: 683 lm/W times ∫ȳ dλ.
pub const CANDELA_PER_M2: f64 = 683.002 * Y_INTEGRAL_NM;

/// ∫ȳ dλ by the table's sum, nm.
pub const Y_INTEGRAL_NM: f64 = 106.857_03;

/// Values at 360, 365, .. 830 nm: CIE 018 table 6, as the Colour & Vision Research Laboratory publishes them. The step of
/// 5 nm is the CIE's own for practical work; linear between its values.
#[rustfmt::skip]
const X: [f64; 95] = [
    0.0001299, 0.0002321, 0.0004149, 0.0007416, 0.001368, 0.002236, 0.004243, 0.00765, 0.01431, 0.02319, 0.04351,
    0.07763, 0.13438, 0.21477, 0.2839, 0.3285, 0.34828, 0.34806, 0.3362, 0.3187, 0.2908, 0.2511, 0.19536, 0.1421,
    0.09564, 0.05795001, 0.03201, 0.0147, 0.0049, 0.0024, 0.0093, 0.0291, 0.06327, 0.1096, 0.1655, 0.2257499, 0.2904,
    0.3597, 0.4334499, 0.5120501, 0.5945, 0.6784, 0.7621, 0.8425, 0.9163, 0.9786, 1.0263, 1.0567, 1.0622, 1.0456,
    1.0026, 0.9384, 0.8544499, 0.7514, 0.6424, 0.5419, 0.4479, 0.3608, 0.2835, 0.2187, 0.1649, 0.1212, 0.0874, 0.0636,
    0.04677, 0.0329, 0.0227, 0.01584, 0.01135916, 0.008110916, 0.005790346, 0.004109457, 0.002899327, 0.00204919,
    0.001439971, 0.000999949, 0.000690079, 0.000476021, 0.000332301, 0.000234826, 0.000166151, 0.000117413, 8.3075e-5,
    5.8707e-5, 4.151e-5, 2.9353e-5, 2.0674e-5, 1.456e-5, 1.0254e-5, 7.221e-6, 5.086e-6, 3.582e-6, 2.523e-6, 1.777e-6,
    1.251e-6,
];
#[rustfmt::skip]
const Y: [f64; 95] = [
    3.917e-6, 6.965e-6, 1.239e-5, 2.202e-5, 3.9e-5, 6.4e-5, 0.00012, 0.000217, 0.000396, 0.00064, 0.00121, 0.00218,
    0.004, 0.0073, 0.0116, 0.01684, 0.023, 0.0298, 0.038, 0.048, 0.06, 0.0739, 0.09098, 0.1126, 0.13902, 0.1693,
    0.20802, 0.2586, 0.323, 0.4073, 0.503, 0.6082, 0.71, 0.7932, 0.862, 0.9148501, 0.954, 0.9803, 0.9949501, 1.0, 0.995,
    0.9786, 0.952, 0.9154, 0.87, 0.8163, 0.757, 0.6949, 0.631, 0.5668, 0.503, 0.4412, 0.381, 0.321, 0.265, 0.217, 0.175,
    0.1382, 0.107, 0.0816, 0.061, 0.04458, 0.032, 0.0232, 0.017, 0.01192, 0.00821, 0.005723, 0.004102, 0.002929,
    0.002091, 0.001484, 0.001047, 0.00074, 0.00052, 0.0003611, 0.0002492, 0.0001719, 0.00012, 8.48e-5, 6e-5, 4.24e-5,
    3e-5, 2.12e-5, 1.499e-5, 1.06e-5, 7.466e-6, 5.258e-6, 3.703e-6, 2.608e-6, 1.837e-6, 1.293e-6, 9.11e-7, 6.42e-7,
    4.52e-7,
];
#[rustfmt::skip]
const Z: [f64; 95] = [
    0.0006061, 0.001086, 0.001946, 0.003486, 0.006450001, 0.01054999, 0.02005001, 0.03621, 0.06785001, 0.1102, 0.2074,
    0.3713, 0.6456, 1.0390501, 1.3856, 1.62296, 1.74706, 1.7826, 1.77211, 1.7441, 1.6692, 1.5281, 1.28764, 1.0419,
    0.8129501, 0.6162, 0.46518, 0.3533, 0.272, 0.2123, 0.1582, 0.1117, 0.07824999, 0.05725001, 0.04216, 0.02984, 0.0203,
    0.0134, 0.008749999, 0.005749999, 0.0039, 0.002749999, 0.0021, 0.0018, 0.001650001, 0.0014, 0.0011, 0.001, 0.0008,
    0.0006, 0.00034, 0.00024, 0.00019, 0.0001, 5e-5, 3e-5, 2e-5, 1e-5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    0.0, 0.0, 0.0, 0.0,
];

/// x̄, ȳ and z̄ at a wavelength; zero where there is no colour.
pub fn matching_functions(wavelength_nm: f64) -> [f64; 3] {
    if !(SHORTEST_NM..=LONGEST_NM).contains(&wavelength_nm) {
        return [0.0; 3];
    }
    [&X, &Y, &Z].map(|values| EvenTable { first_nm: SHORTEST_NM, step_nm: 5.0, values }.at(wavelength_nm))
}

/// X, Y and Z of a spectral radiance, by the trapezium rule at every nanometre, over ∫ȳ dλ.
pub fn tristimulus(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for step in 0..=(LONGEST_NM - SHORTEST_NM) as u32 {
        let wavelength_nm = SHORTEST_NM + f64::from(step);
        let radiance = spectrum(wavelength_nm);
        for (sum, value) in sum.iter_mut().zip(matching_functions(wavelength_nm)) {
            *sum += value * radiance / Y_INTEGRAL_NM;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equal_energy_spectrum_is_white_in_the_middle() {
        let [x, y, z] = tristimulus(|_| 1.0);
        let sum = x + y + z;
        // The CIE's own table is so far from thirds.
        assert!((x / sum - 1.0 / 3.0).abs() < 3e-5 && (y / sum - 1.0 / 3.0).abs() < 5e-5, "{x} {y} {z}");
        assert!((y - 1.0).abs() < 1e-6, "{y}");
    }

    #[test]
    fn a_black_body_has_its_published_colour() {
        // Illuminant A, 2848 K with the radiation constant of its time; CIE 015: x = 0.44758, y = 0.40745.
        let planck = |wavelength_nm: f64| wavelength_nm.powi(-5) / ((1.435e7 / (2848.0 * wavelength_nm)).exp() - 1.0);
        let [x, y, z] = tristimulus(planck);
        let sum = x + y + z;
        assert!((x / sum - 0.447_58).abs() < 5e-5 && (y / sum - 0.407_45).abs() < 5e-5, "{} {}", x / sum, y / sum);
    }

    #[test]
    fn green_is_the_brightest_and_nothing_is_seen_beyond_the_ends() {
        assert_eq!(matching_functions(555.0)[1], 1.0);
        assert!((400..700).all(|nm| matching_functions(f64::from(nm))[1] <= 1.0));
        assert_eq!((matching_functions(359.9), matching_functions(830.1)), ([0.0; 3], [0.0; 3]));
    }
}
