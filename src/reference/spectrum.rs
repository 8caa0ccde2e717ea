//! Arithmetic on values by band.

use welkin_lut::{BAND_COUNT, Bands};

/// No light, no matter.
pub const ZERO: Bands = [0.0; BAND_COUNT];
/// Full transmittance.
pub const ONE: Bands = [1.0; BAND_COUNT];

/// a·b, band by band.
pub fn product(a: Bands, b: Bands) -> Bands {
    std::array::from_fn(|j| a[j] * b[j])
}

/// Adds `factor`·`value` to `total`.
pub fn accumulate(total: &mut Bands, factor: f64, value: Bands) {
    for (sum, v) in total.iter_mut().zip(value) {
        *sum += factor * v;
    }
}

/// e^-τ, band by band.
pub fn attenuation(optical_depth: Bands) -> Bands {
    optical_depth.map(|tau| (-tau).exp())
}

/// Sum over the bands.
pub fn sum(bands: Bands) -> f64 {
    bands.iter().sum()
}

/// Largest value of any band.
pub fn largest(bands: Bands) -> f64 {
    bands.into_iter().fold(0.0, f64::max)
}
