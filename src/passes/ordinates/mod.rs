//! Light in clouds by discrete ordinates on nested grids: where it is solved, and the passes that solve it.
//!
//! Passes in a row, each for every level of a [`Grid`]:
//!
//! ```text
//! ordinates_extinction -> ordinates_extinction   mean c' of fine texels: of the scene's clouds, or the caller fills it
//!                         ordinates_passing      c' with which they let light through, the same
//! ordinates_depth      -> ordinates_depth        optical depth towards the sun
//! ordinates_source     -> ordinates_source       c' and first scattered sunlight of cells
//! ordinates_sweep      -> ordinates_radiance     radiance by direction and cell, relaxed in place
//! ordinates_moments    -> ordinates_sunlight, ordinates_skylight   its mean and flux
//! ```
//!
//! Two fields are solved at once: of the sun with unit irradiance on a plane normal to the beam, and of a sky of radiance
//! 1; the ground reflects both. View rays read them through the WGSL module `welkin::ordinates_light`.

pub mod coefficients;
mod following;
mod grid;
mod passes;
mod problem;
mod scene;
mod volumes;

pub use grid::{Coverage, Grid, Level, Sides};
pub use passes::{EXTINCTION, LIGHT};
pub use problem::{Directions, Problem};
pub use scene::{light, problem};
pub use volumes::{Start, Volumes};
