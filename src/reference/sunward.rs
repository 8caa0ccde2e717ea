//! Extra walks towards the sun where matter scatters sharply forward.
//!
//! Droplets send half of what they scatter into a degree or two. So half of the sunlight in a cloud reaches a walk on the
//! rare occasions that it heads almost for the sun and collides once more: bright specks that thousands of walks do not
//! average out. Here every event also starts, at a rate, a walk whose direction is drawn from the sharpest phase function
//! around the sun, and the balance heuristic shares the light between both (detector directional importance sampling,
//! Buras & Mayer 2011, with several samples instead of one, so that weights do not spread from event to event).

use glam::DVec3;
use welkin_lut::PhaseFunction;

use super::matter::around;
use super::random::Draw;
use super::world::World;

/// Extra walks for each event.
pub const RATE: f64 = 0.25;
/// Phase functions whose peak is this much above the mean are sharp.
const SHARP: f64 = 20.0;
/// What a walk is worth in the peak around the sun: its next event finds as much light as dozens elsewhere, sr.
const WORTH_SR: f64 = 0.6;

/// Directions around the sun.
#[derive(Debug, Clone, Copy)]
pub struct Sunward<'a> {
    toward: DVec3,
    phase: &'a PhaseFunction,
}

impl<'a> Sunward<'a> {
    /// For a world with a sun and bodies of which one scatters sharply.
    pub fn new(world: &'a World) -> Option<Self> {
        let toward = world.sun()?;
        let peak = |phase: &PhaseFunction| phase.value(1.0) * 4.0 * std::f64::consts::PI;
        let phases = world.bodies.iter().map(|body| &body.matter[0].phase);
        let phase = phases.max_by(|a, b| peak(a).total_cmp(&peak(b)))?;
        (peak(phase) > SHARP).then_some(Self { toward, phase })
    }

    /// A direction.
    pub fn sample(&self, draw: &mut Draw) -> DVec3 {
        let cosine = self.phase.sample(draw.uniform());
        around(self.toward, cosine, draw.uniform()).normalize()
    }

    /// Its density, 1/sr.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        self.phase.value(direction.dot(self.toward).clamp(-1.0, 1.0))
    }

    /// How much longer than another a walk in a direction is worth following.
    pub fn worth(&self, direction: DVec3) -> f64 {
        1.0 + WORTH_SR * self.pdf(direction)
    }
}
