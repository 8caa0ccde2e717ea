//! Atmospheric media and the lookup tables made from them.
//!
//! This crate holds the *problem*: what a medium is ([`Medium`]), how it scatters ([`PhaseFunction`]), the planet
//! it lies on ([`Planet`]), geometry that stays exact near the ground ([`geometry`]), spectra and colour ([`spectrum`]) and the
//! mappings between table texels and physical parameters ([`mapping`]). It knows nothing of Vulkan, windows or command lines, so that an
//! engine can depend on it alone.
//!
//! Units are SI throughout: metres, 1/m, radians, W·m⁻²·sr⁻¹·nm⁻¹. Everything is `f64`.
#![forbid(unsafe_code)]

pub mod bake;
mod bands;
pub mod cloud;
pub mod forward_peak;
pub mod geometry;
pub mod height_field;
pub mod lamp_field;
mod legendre;
pub mod mapping;
mod medium;
pub mod pack;
pub mod phase;
mod planet;
mod profile;
pub mod quadrature;
pub mod sky_tables;
pub mod slab_field;
pub mod spectrum;
mod table;
pub mod volume;

pub use bands::{BAND_COUNT, BAND_NAMES, BAND_WAVELENGTHS_NM, Bands};
pub use medium::{Constituent, Medium, MediumError};
pub use phase::{DropletFit, PhaseError, PhaseFunction, TabulatedPhase};
pub use planet::{Planet, PlanetError};
pub use profile::{DensityProfile, ProfileError};
pub use table::Table;
