//! The solvers by name, and what each can be asked.

use std::fmt;

use super::light::Emitter;
use super::marching::March;
use super::single::emits;
use super::world::World;
use crate::probe::Orders;

/// How the light transport equation is solved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Solver {
    /// (a) Quadrature of light after at most one event: see [`super::single`].
    Single,
    /// (b) Recursive Monte Carlo ray marching: see [`super::marching`].
    Marching(March),
    /// (c) The unbiased path tracer: see [`super::path`].
    #[default]
    Path,
}

/// What a solver cannot be asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolverError {
    /// Quadrature has no rule for surroundings that shine from everywhere.
    #[error(
        "light {number} of the scene shines from all around, which the single solver does not integrate; it takes \
         directional and point lights, the marching and path solvers take all"
    )]
    Surroundings {
        /// Which light, from 1.
        number: usize,
    },
    /// Emitted light lights the medium as well.
    #[error(
        "matter of the scene gives off light, whose scattering the single solver does not integrate; the marching and \
         path solvers do"
    )]
    Emission,
    /// Marching counts what the ground reflects with what the air scatters.
    #[error("the marching solver does not tell orders apart; the single and path solvers do")]
    Orders,
    /// Rays that end on a black surface are the path tracer's.
    #[error("rays end at a distance, which only the path solver knows")]
    Distance,
    /// Hills and mountains are the path tracer's.
    #[error("the scene has mountains, which only the path solver knows")]
    Relief,
}

impl Solver {
    /// One word: single, marching or path.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Marching(_) => "marching",
            Self::Path => "path",
        }
    }

    /// What one sample of it is called, in the plural.
    pub fn samples_name(&self) -> &'static str {
        match self {
            Self::Single => "evaluations",
            Self::Marching(_) => "marches",
            Self::Path => "walks",
        }
    }

    /// Whether it answers a question about a world's light of these orders.
    ///
    /// # Errors
    /// [`SolverError`] says what it cannot.
    pub fn check(&self, world: &World, orders: Orders) -> Result<(), SolverError> {
        if world.relief.is_some() && *self != Self::Path {
            return Err(SolverError::Relief);
        }
        match self {
            Self::Single => {
                if emits(world) {
                    return Err(SolverError::Emission);
                }
                let surroundings = world.lights.iter().position(|light| matches!(light, Emitter::Environment { .. }));
                surroundings.map_or(Ok(()), |at| Err(SolverError::Surroundings { number: at + 1 }))
            }
            Self::Marching(_) if orders == Orders::Single => Err(SolverError::Orders),
            Self::Marching(_) | Self::Path => Ok(()),
        }
    }
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Single => write!(f, "single: quadrature of light after at most one event"),
            Self::Marching(march) => write!(f, "marching: recursive Monte Carlo ray marching, {march}"),
            Self::Path => write!(f, "path: unbiased path tracer"),
        }
    }
}
