//! The families of methods of the course notes on a homogeneous slab, from one scattering to as many streams as are asked
//! for: to be compared with, in error and in time.

mod matrix;
mod ordinates;
mod single;
mod two_stream;

pub use ordinates::DiscreteOrdinates;
pub use single::SingleScattering;
pub use two_stream::{Closure, TwoStream};

use super::Slab;

/// Fluxes without any noise, as fractions of the beam's through a horizontal plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluxes {
    /// Upward at the top.
    pub reflectance: f64,
    /// Downward at the bottom after at least one scattering or reflection.
    pub diffuse_transmittance: f64,
}

/// A way to find them.
pub trait SlabMethod {
    /// What it is called in reports.
    fn name(&self) -> String;

    /// Of a slab.
    fn fluxes(&self, slab: &Slab) -> Fluxes;
}

/// From the simplest to the best.
pub fn all() -> Vec<Box<dyn SlabMethod + Send + Sync>> {
    let two_stream = |closure, delta| Box::new(TwoStream { closure, delta }) as Box<dyn SlabMethod + Send + Sync>;
    let mut all: Vec<Box<dyn SlabMethod + Send + Sync>> = vec![
        Box::new(SingleScattering),
        two_stream(Closure::Quadrature, false),
        two_stream(Closure::Quadrature, true),
        two_stream(Closure::Eddington, false),
        two_stream(Closure::Eddington, true),
    ];
    all.extend(
        [2, 4, 8, 16].map(|streams| Box::new(DiscreteOrdinates { streams }) as Box<dyn SlabMethod + Send + Sync>),
    );
    all
}

/// A slab without its strongest forward scattering, which counts as if it had not been scattered (Joseph, Wiscombe & Weinman
/// 1976, J. Atmos. Sci. 33, 2452): optical thickness and albedo, for a share of all scattering.
fn without_forward_peak(slab: &Slab, share: f64) -> (f64, f64) {
    let left = 1.0 - slab.albedo * share;
    (left * slab.optical_thickness, if left > 0.0 { (1.0 - share) * slab.albedo / left } else { 0.0 })
}
