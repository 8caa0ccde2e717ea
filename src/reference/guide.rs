//! Where useful paths lead in twilight: up to the air at the sunward horizon that still has sun.

use std::f64::consts::PI;

use glam::DVec3;

use super::matter::around;
use super::shape::Shape;
use super::world::World;

/// Scatterings after which walks are no longer guided.
const GUIDED_ORDERS: usize = 3;
/// Sine of the sun's elevation at a vertex below which its next direction is guided.
const SUN_BELOW: f64 = -0.035;
/// Share of the directions drawn from the lobe.
const SHARE: f64 = 0.5;
/// Mean cosine of the lobe.
const CONCENTRATION: f64 = 0.8;
/// Elevation of the lobe's axis, rad.
const ELEVATION_RAD: f64 = 0.07;

/// Guides walks towards the sunward horizon.
#[derive(Debug, Clone, Copy)]
pub struct Guide {
    sun: DVec3,
}

/// A Henyey-Greenstein lobe of directions, mixed with a vertex's own with a share.
#[derive(Debug, Clone, Copy)]
pub struct Lobe {
    axis: DVec3,
    /// Probability with which the lobe is used, below 1.
    pub share: f64,
}

impl Guide {
    /// For a planet with a sun; elsewhere there is no twilight.
    pub fn new(world: &World) -> Option<Self> {
        matches!(world.shape, Shape::Sphere { .. }).then_some(())?;
        world.sun().map(|sun| Self { sun })
    }

    /// The lobe at a point, if directions there are guided. It does not depend on the walk's weight or direction.
    pub fn lobe(&self, world: &World, at: DVec3, order: usize) -> Option<Lobe> {
        if order >= GUIDED_ORDERS {
            return None;
        }
        let up = world.shape.up(at);
        let sine = self.sun.dot(up);
        if sine > SUN_BELOW {
            return None;
        }
        let horizontal = (self.sun - up * sine).try_normalize()?;
        let (s, c) = ELEVATION_RAD.sin_cos();
        Some(Lobe { axis: horizontal * c + up * s, share: SHARE })
    }
}

impl Lobe {
    /// A direction from two uniform numbers.
    pub fn sample(&self, u: f64, turn: f64) -> DVec3 {
        let g = CONCENTRATION;
        let ratio = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
        let cosine = ((1.0 + g * g - ratio * ratio) / (2.0 * g)).clamp(-1.0, 1.0);
        around(self.axis, cosine, turn).normalize()
    }

    /// Density of `sample`, 1/sr.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        let g = CONCENTRATION;
        let d = 1.0 + g * g - 2.0 * g * self.axis.dot(direction);
        (1.0 - g * g) / (4.0 * PI * d * d.sqrt())
    }
}
