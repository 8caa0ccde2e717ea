//! The truth: the light transport equation on the CPU in `f64`, without tables, mappings or a GPU.
//!
//! It shares the problem with the renderer (scene, medium, phase functions) and nothing of its solution. Three
//! solvers answer the same questions: [`single`] (a, quadrature of single scattering with an error bound),
//! [`marching`] (b, recursive Monte Carlo ray marching) and [`path`] (c, an unbiased path tracer). [`Solver`] has their
//! names.
//!
//! Walks run against the light, from the camera. Equations are those of Premože 2003, sections 4.1 and 4.2.

mod air;
pub mod attenuation;
mod clouds;
mod column;
pub mod disc;
mod effort;
mod field;
mod first_event;
mod grid;
mod guide;
mod layer;
mod light;
mod line;
mod line_event;
pub mod marching;
mod matter;
pub mod path;
pub mod picture;
pub mod probe;
mod quadrature;
mod random;
mod relief;
mod segment;
mod shape;
mod sight_line;
pub mod single;
pub mod slab;
mod solver;
mod spectrum;
mod spread;
mod sunward;
mod tally;
pub mod transport;
mod volumes;
mod walk;
mod world;

pub use effort::Effort;
pub use field::{Body, DensityField};
pub use grid::{GridError, GridField};
pub use light::Emitter;
pub use matter::Matter;
pub use probe::{probe, probe_by};
pub use quadrature::Integral;
pub use shape::Shape;
pub use solver::{Solver, SolverError};
pub use tally::{ORDER_BINS, Tally};
pub use world::World;
