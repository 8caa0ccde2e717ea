//! Light in clouds by discrete ordinates on nested grids: where it is solved, and the passes that solve it.
//!
//! Passes in a row, each for every level of a [`Grid`]:
//!
//! ```text
//!                      -> ordinates_extinction   c' of fine texels, which the caller fills
//! ordinates_depth      -> ordinates_depth        optical depth towards the sun
//! ordinates_source     -> ordinates_source       mean c' and first scattered sunlight of cells
//! ordinates_sweep      -> ordinates_radiance     radiance by direction and cell, relaxed in place
//! ordinates_moments    -> ordinates_sunlight, ordinates_skylight   its mean and flux
//! ```
//!
//! Two fields are solved at once: of the sun with unit irradiance on a plane normal to the beam, and of a sky of radiance
//! 1; the ground reflects both. View rays read them through the WGSL module `welkin::ordinates_light`.

pub mod coefficients;
mod grid;
mod problem;
mod volumes;

pub use grid::{Coverage, Grid, Level, Sides};
pub use problem::{Directions, Problem};
pub use volumes::{Start, Volumes};
