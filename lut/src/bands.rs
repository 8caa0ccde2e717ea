//! The spectral bands that a scene is simulated in.

/// How many spectral bands a scene carries.
pub const BAND_COUNT: usize = 3;

/// What the bands are called in files and messages, in order of storage.
pub const BAND_NAMES: [&str; BAND_COUNT] = ["r", "g", "b"];

/// One value for each spectral band, by default at 680, 550 and 440 nm.
pub type Bands = [f64; BAND_COUNT];

/// Wavelength in vacuum that each band stands for, nm (as in Hillaire 2020 and Bruneton 2017).
pub const BAND_WAVELENGTHS_NM: Bands = [680.0, 550.0, 440.0];
