//! Local media as densities in space: banks of fog over the ground, boxes and ellipsoids of smoke, mist or glowing gas.
//! The definition that the real-time renderer and the reference share.
//!
//! A [`Volume`] is a form filled with one kind of matter, whose density may follow an edge, noise and a grid.
//! [`VolumeField`] is the chain from a place to that density, on the numbers of [`VolumeParameters`]; noise comes from the
//! clouds' tiles of bytes, so that host and device see the same.

mod field;
mod form;
mod grid;
mod parameters;

pub use field::VolumeField;
pub use form::{FogProfile, Volume, VolumeForm, VolumeNoise};
pub use grid::{VolumeGrid, VolumeGridError};
pub use parameters::{VolumeKind, VolumeParameters};
