//! Spectra of light and matter, and how they become colour.
//!
//! Wavelengths are in vacuum and in nanometres. Everything here is a fact of the problem, shared by every way of solving it:
//! the CIE's colour matching functions ([`cie`]), the sun ([`solar`]), ozone and molecules ([`ozone`], [`molecular`]), the
//! wavelengths worth computing ([`rule`]), what the three bands stand for ([`three_bands`]) and RGB spaces
//! ([`ColourSpace`]).
//!
//! Tristimulus values are divided by ∫ȳ dλ, so that a spectral radiance which is the same at all wavelengths is its own Y,
//! and colours keep the unit W·m⁻²·sr⁻¹·nm⁻¹. Y times [`cie::CANDELA_PER_M2`] is the luminance.

mod channels;
pub mod cie;
mod colour_space;
mod interpolation;
pub mod molecular;
pub mod ozone;
pub mod rule;
pub mod solar;
mod table;
pub mod three_bands;

pub use channels::{Channels, UnknownChannels};
pub use colour_space::{ColourSpace, adaptation};
pub use interpolation::{between_bands, scaled_between_bands};
pub use rule::{SpectralNode, SpectralRule};
pub use table::EvenTable;

/// Shortest wavelength at which there is colour, nm: where the colour matching functions begin.
pub const SHORTEST_NM: f64 = 360.0;

/// Longest wavelength at which there is colour, nm.
pub const LONGEST_NM: f64 = 830.0;
