//! Sunlight outside the air.

use super::EvenTable;

/// Means over 10 nm from 360, 370, .. nm on, W·m⁻²·nm⁻¹, at one astronomical unit: the extraterrestrial column of ASTM
/// G173-03, as Bruneton 2017 averaged it ("A Qualitative and Quantitative Evaluation of 8 Clear Sky Models", TVCG 23).
const MEANS: [f64; 48] = [
    1.11776, 1.14259, 1.01249, 1.14716, 1.72765, 1.73054, 1.6887, 1.61253, 1.91198, 2.03474, 2.02042, 2.02212, 1.93377,
    1.95809, 1.91686, 1.8298, 1.8685, 1.8931, 1.85149, 1.8504, 1.8341, 1.8345, 1.8147, 1.78158, 1.7533, 1.6965,
    1.68194, 1.64654, 1.6048, 1.52143, 1.55622, 1.5113, 1.474, 1.4482, 1.41018, 1.36775, 1.34188, 1.31429, 1.28303,
    1.26758, 1.2367, 1.2082, 1.18737, 1.14683, 1.12362, 1.1058, 1.07124, 1.04992,
];

/// Irradiance normal to the beam at one astronomical unit, W·m⁻²·nm⁻¹, between the centres of means over 10 nm.
///
/// What game engines have for their bands at 680, 550 and 440 nm are the means over the 10 nm *above* those
/// wavelengths, so this function takes their values at 685, 555 and 445 nm.
pub fn irradiance(wavelength_nm: f64) -> f64 {
    EvenTable { first_nm: 365.0, step_nm: 10.0, values: &MEANS }.at(wavelength_nm)
}

#[cfg(test)]
mod tests {
    use super::irradiance;

    #[test]
    fn the_engines_bands_are_means_over_the_ten_nanometres_above() {
        assert_eq!([685.0, 555.0, 445.0].map(irradiance), [1.474, 1.8504, 1.91198]);
    }
}
