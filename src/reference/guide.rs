//! Where useful paths lead in twilight: up to the air at the sunward horizon that still has sun.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::shape::Shape;
use super::world::World;

/// Scatterings after which directions are no longer guided.
const GUIDED_ORDERS: usize = 3;
/// Sine of the sun's elevation at a point below which there is twilight.
const SUN_BELOW: f64 = 0.02;
/// Share of the directions drawn from the lobe.
const SHARE: f64 = 0.6;
/// ρ of the wrapped Cauchy distribution of azimuths around the sun's.
const AZIMUTH_CONCENTRATION: f64 = 0.6;
/// Centre of the lobe: sine of its elevation, at the ground and per sine of the horizon's dip.
const CENTRE: [f64; 2] = [0.01, -0.35];
/// Half width of the lobe in the same terms.
const WIDTH: [f64; 2] = [0.015, 0.5];

/// Guides walks towards the sunward horizon.
#[derive(Debug, Clone, Copy)]
pub struct Guide {
    sun: DVec3,
}

/// A lobe of directions, mixed with a vertex's own with a share: wide in azimuth, narrow in elevation.
#[derive(Debug, Clone, Copy)]
pub struct Lobe {
    up: DVec3,
    /// Horizontal, towards the sun.
    forward: DVec3,
    /// Sine of the elevation around which the lobe lies.
    centre: f64,
    /// Half width at half maximum of that sine.
    width: f64,
    /// Probability with which the lobe is used, below 1.
    pub share: f64,
}

impl Guide {
    /// For a planet with a sun; elsewhere there is no twilight.
    pub fn new(world: &World) -> Option<Self> {
        matches!(world.shape, Shape::Sphere { .. }).then_some(())?;
        world.sun().map(|sun| Self { sun })
    }

    /// Whether a walk from a point goes through twilight.
    pub fn spreads(&self, world: &World, at: DVec3) -> bool {
        world.bodies.is_empty() && self.sun.dot(world.shape.up(at)) < SUN_BELOW
    }

    /// Unit vector to the sun.
    pub fn sun(&self) -> DVec3 {
        self.sun
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
        let forward = (self.sun - up * sine).try_normalize()?;
        let (altitude, radius) = (world.shape.altitude(at).max(0.0), world.shape.radius_m());
        let dip = (altitude * (2.0 * radius + altitude)).sqrt() / (radius + altitude);
        Some(Lobe { up, forward, centre: CENTRE[0] + CENTRE[1] * dip, width: WIDTH[0] + WIDTH[1] * dip, share: SHARE })
    }
}

impl Lobe {
    fn tail(&self, sine: f64) -> f64 {
        ((sine - self.centre) / self.width).atan()
    }

    /// A direction from two uniform numbers.
    pub fn sample(&self, u: f64, v: f64) -> DVec3 {
        let (low, high) = (self.tail(-1.0), self.tail(1.0));
        let sine = (self.centre + self.width * (low + (high - low) * u).tan()).clamp(-1.0, 1.0);
        let narrow = (1.0 - AZIMUTH_CONCENTRATION) / (1.0 + AZIMUTH_CONCENTRATION);
        let azimuth = 2.0 * (narrow * (PI * v - FRAC_PI_2).tan()).atan();
        let (s, c) = azimuth.sin_cos();
        let side = self.up.cross(self.forward);
        (self.up * sine + (self.forward * c + side * s) * (1.0 - sine * sine).sqrt()).normalize()
    }

    /// Density of `sample`, 1/sr.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        let rho = AZIMUTH_CONCENTRATION;
        let sine = direction.dot(self.up);
        let x = (sine - self.centre) / self.width;
        let elevation = 1.0 / (self.width * (1.0 + x * x) * (self.tail(1.0) - self.tail(-1.0)));
        let cos_azimuth = direction.dot(self.forward) / (1.0 - sine * sine).max(1e-300).sqrt();
        elevation * (1.0 - rho * rho) / (TAU * (1.0 + rho * rho - 2.0 * rho * cos_azimuth.clamp(-1.0, 1.0)))
    }
}
