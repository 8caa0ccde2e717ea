//! Absorption by ozone: the Chappuis band, which makes the twilight sky blue.

use super::EvenTable;

/// Means over 10 nm from 360, 370, .. nm on, m², at 233 K: Serdyuchenko et al. 2014 (Atmos. Meas. Tech. 7, 625), as Bruneton
/// 2017 averaged them ("A Qualitative and Quantitative Evaluation of 8 Clear Sky Models", TVCG 23).
const MEANS: [f64; 48] = [
    1.18e-27, 2.182e-28, 2.818e-28, 6.636e-28, 1.527e-27, 2.763e-27, 5.52e-27, 8.451e-27, 1.582e-26, 2.316e-26,
    3.669e-26, 4.924e-26, 7.752e-26, 9.016e-26, 1.48e-25, 1.602e-25, 2.139e-25, 2.755e-25, 3.091e-25, 3.5e-25,
    4.266e-25, 4.672e-25, 4.398e-25, 4.701e-25, 5.019e-25, 4.305e-25, 3.74e-25, 3.215e-25, 2.662e-25, 2.238e-25,
    1.852e-25, 1.473e-25, 1.209e-25, 9.423e-26, 7.455e-26, 6.566e-26, 5.105e-26, 4.15e-26, 4.228e-26, 3.237e-26,
    2.451e-26, 2.801e-26, 2.534e-26, 1.624e-26, 1.465e-26, 2.078e-26, 1.383e-26, 7.105e-27,
];

/// Absorption cross section of a molecule, m², between the centres of means over 10 nm. As with the sun
/// ([`solar::irradiance`](super::solar::irradiance)), the engines' bands have the means above their wavelengths.
pub fn cross_section_m2(wavelength_nm: f64) -> f64 {
    EvenTable { first_nm: 365.0, step_nm: 10.0, values: &MEANS }.at(wavelength_nm)
}

#[cfg(test)]
mod tests {
    use super::cross_section_m2;

    #[test]
    fn the_engines_bands_are_means_over_the_ten_nanometres_above() {
        let rounded = [1.21e-25, 3.50e-25, 1.58e-26];
        for (computed, rounded) in [685.0, 555.0, 445.0].map(cross_section_m2).iter().zip(rounded) {
            assert!((computed / rounded - 1.0).abs() < 2e-3, "{computed} against {rounded}");
        }
    }

    #[test]
    fn absorption_is_strongest_in_the_orange() {
        let strongest = (360..830).max_by(|&a, &b| cross_section_m2(a.into()).total_cmp(&cross_section_m2(b.into())));
        assert_eq!(strongest, Some(605));
    }
}
