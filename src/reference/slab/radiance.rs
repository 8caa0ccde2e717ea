//! Radiance that leaves a slab in one direction.
//!
//! Walks run with the light, and every collision after the first sends its share towards the observer by expectation;
//! the first is added in closed form. Walks for light below a thick slab know where they are wanted, as those of
//! [`super::deep`].

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::asymptotic::Asymptotic;
use super::{BATCHES, Measured, PILOT_WALKS, Slab, count, deep, measure};
use crate::reference::matter::around;
use crate::reference::random::Draw;

/// Below this share of the importance that it began with, a walk is played for its life.
const ROULETTE_BELOW: f64 = 0.2;
/// The stream of random numbers, another than those of the walks for fluxes.
const STREAM: u64 = 2;

/// The side on which light leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Upward at the top.
    Top,
    /// Downward at the bottom, before it meets the surface.
    Bottom,
}

/// A direction of light that leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exit {
    /// Where.
    pub side: Side,
    /// Cosine of the angle to the vertical, in ]0, 1].
    pub mu: f64,
    /// Azimuth of the light's travel from that of the beam's, rad.
    pub azimuth_rad: f64,
}

impl Slab {
    /// Diffuse radiance for a beam of irradiance 1 on a plane normal to it, 1/sr, from as many walks as bring one
    /// standard error below `relative_error` of it, within the bound of [`Slab::fluxes_to`].
    ///
    /// A round decides how many walks the next one has and is thrown away. The first may miss the rare walks that bring
    /// most of the light and expect too few; a result that is not good enough is taken for such a round, once.
    pub fn radiance_to(&self, exit: &Exit, relative_error: f64, seed: u64) -> Measured {
        let seen = Seen::new(self, exit);
        let excess = |m: &Measured| if m.value > 0.0 { m.standard_error / (relative_error * m.value) } else { 0.0 };
        let (pilot, steps) = seen.measure(PILOT_WALKS, !seed);
        let walks = count(excess(&pilot), steps);
        let (measured, steps) = seen.measure(walks, seed);
        if excess(&measured) <= 1.0 {
            return measured;
        }
        // As if the first round had had so much larger an error.
        let share = (walks as f64 / PILOT_WALKS as f64).sqrt();
        seen.measure(count(excess(&measured) * share, steps), !seed.rotate_left(1)).0
    }
}

/// A walk between two flights; z of its direction points down. Its weight is in units of e^(-κ depth).
#[derive(Debug, Clone, Copy)]
struct Walk {
    depth: f64,
    direction: DVec3,
    weight: f64,
}

/// A slab as seen in one direction.
struct Seen<'a> {
    slab: &'a Slab,
    exit: Exit,
    /// In which the light leaves; z points down.
    direction: DVec3,
    /// Leads walks to the bottom.
    guide: Option<Asymptotic>,
}

impl<'a> Seen<'a> {
    fn new(slab: &'a Slab, exit: &Exit) -> Self {
        let sine = (1.0 - exit.mu * exit.mu).max(0.0).sqrt();
        let down = if exit.side == Side::Bottom { exit.mu } else { -exit.mu };
        let direction = DVec3::new(sine * exit.azimuth_rad.cos(), sine * exit.azimuth_rad.sin(), down);
        let guided = exit.side == Side::Bottom && slab.optical_thickness > super::DEEP;
        let guide = guided.then(|| Asymptotic::new(slab.albedo, &slab.phase));
        Self { slab, exit: *exit, direction, guide }
    }

    /// Radiance, and steps of a walk.
    fn measure(&self, photons: u64, seed: u64) -> (Measured, f64) {
        let walks = photons.div_ceil(BATCHES).max(1);
        let batches: Vec<(f64, f64)> =
            (0..BATCHES).into_par_iter().map(|batch| self.batch(walks, seed, batch)).collect();
        let mut measured = measure(&batches.iter().map(|batch| batch.0).collect::<Vec<_>>());
        measured.value += self.first_order();
        (measured, batches.iter().map(|batch| batch.1).sum::<f64>() / BATCHES as f64)
    }

    fn batch(&self, walks: u64, seed: u64, batch: u64) -> (f64, f64) {
        let mut draw = Draw::new(seed, STREAM, batch);
        let (mut score, mut steps) = (0.0, 0.0);
        for index in 0..walks {
            draw.start(index);
            let (scored, taken) = self.walk(&mut draw);
            score += scored;
            steps += taken;
        }
        // A walk stands for the flux through a horizontal plane.
        (self.slab.mu0 * self.in_score_units().recip() * score / walks as f64, steps / walks as f64)
    }

    fn kappa(&self) -> f64 {
        self.guide.as_ref().map_or(0.0, |guide| guide.kappa)
    }

    /// What weights are divided by where they are scored: at the bottom they are of the order of e^(-κτ).
    fn in_score_units(&self) -> f64 {
        (self.kappa() * self.slab.optical_thickness).exp()
    }

    fn beam(&self) -> DVec3 {
        DVec3::new((1.0 - self.slab.mu0 * self.slab.mu0).max(0.0).sqrt(), 0.0, self.slab.mu0)
    }

    /// Scattered once: W P(Θ) μ0 times ∫ e^(-τ'/μ0) e^(-rest/μ) dτ' / (μ μ0).
    fn first_order(&self) -> f64 {
        let (mu, mu0, thickness) = (self.exit.mu, self.slab.mu0, self.slab.optical_thickness);
        let depths = match self.exit.side {
            Side::Top => deep::reach(1.0 / mu + 1.0 / mu0, thickness),
            Side::Bottom => {
                let rate = (1.0 / mu0 - 1.0 / mu).abs();
                let along = if rate * thickness < 1e-9 { thickness } else { deep::reach(rate, thickness) };
                (-thickness / mu.max(mu0)).exp() * along
            }
        };
        self.slab.albedo * self.slab.phase.value(self.beam().dot(self.direction)) * depths / mu
    }

    /// One walk: its score, and its steps.
    fn walk(&self, draw: &mut Draw) -> (f64, f64) {
        let slab = self.slab;
        let mut walk = Walk { depth: 0.0, direction: self.beam(), weight: 1.0 };
        let begun_with = self.importance(walk.direction.z);
        let (mut score, mut steps) = (0.0, 0.0);
        let mut is_first = true;
        loop {
            steps += 1.0;
            let mu = walk.direction.z;
            let left = slab.optical_thickness - walk.depth;
            let length = if mu > 0.0 { left / mu } else { walk.depth / -mu };
            let tilted = 1.0 - self.kappa() * mu;
            let leaves = if mu > 0.0 { (-tilted * length).exp() } else { 0.0 };
            let sent_back = walk.weight * leaves * slab.surface_albedo;
            score += sent_back * self.sent_by_surface();
            // Go on with one of the two that stay in play, with the importance of both.
            let importance = self.after_scattering(mu);
            let collides = walk.weight * slab.albedo * deep::reach(tilted, length) * importance;
            let both = sent_back + collides;
            let survives = self.roulette(both, begun_with, draw);
            if survives == 0.0 {
                return (score, steps);
            }
            if draw.uniform() * both < collides {
                // A flight of density ∝ e^(-tilted s), cut off at the boundary.
                let within = -(-tilted * length).exp_m1();
                let flight = -(-draw.uniform() * within).ln_1p() / tilted;
                walk.depth = (walk.depth + flight * mu).clamp(0.0, slab.optical_thickness);
                walk.weight = both * survives / importance;
                if !is_first {
                    score += walk.weight * self.sent_by_collision(&walk);
                }
                self.turn(&mut walk, draw);
            } else {
                let (up, turn) = ((1.0 - draw.uniform()).sqrt(), TAU * draw.uniform());
                let sine = (1.0 - up * up).max(0.0).sqrt();
                let direction = DVec3::new(sine * turn.cos(), sine * turn.sin(), -up);
                walk = Walk { depth: slab.optical_thickness, direction, weight: both * survives };
            }
            is_first = false;
        }
    }

    /// What a collision sends to the observer, per unit of its weight, in the units of the score.
    fn sent_by_collision(&self, walk: &Walk) -> f64 {
        let Exit { side, mu, .. } = self.exit;
        let left = self.slab.optical_thickness - walk.depth;
        let exponent = match side {
            Side::Top => -walk.depth / mu,
            Side::Bottom => left * (self.kappa() - 1.0 / mu),
        };
        self.slab.phase.value(walk.direction.dot(self.direction)) * exponent.exp() / mu
    }

    /// The same of light that the surface reflects.
    fn sent_by_surface(&self) -> f64 {
        match self.exit.side {
            Side::Top => (-self.slab.optical_thickness / self.exit.mu).exp() / PI,
            Side::Bottom => 0.0,
        }
    }

    /// Turns in proportion to phase function times importance.
    fn turn(&self, walk: &mut Walk, draw: &mut Draw) {
        let from = walk.direction;
        loop {
            let direction = around(from, self.slab.phase.sample(draw.uniform()), draw.uniform());
            // A walk along the layer would never leave it.
            walk.direction = DVec3 { z: if direction.z == 0.0 { f64::MIN_POSITIVE } else { direction.z }, ..direction };
            let Some(guide) = &self.guide else { return };
            let importance = guide.importance(walk.direction.z);
            if draw.uniform() * guide.most < importance {
                walk.weight *= guide.after_scattering(from.z) / importance;
                return;
            }
        }
    }

    fn importance(&self, mu: f64) -> f64 {
        self.guide.as_ref().map_or(1.0, |guide| guide.importance(mu))
    }

    fn after_scattering(&self, mu: f64) -> f64 {
        self.guide.as_ref().map_or(1.0, |guide| guide.after_scattering(mu))
    }

    /// Factor of the weight: 1, or 0, or what survival is worth.
    fn roulette(&self, weight: f64, begun_with: f64, draw: &mut Draw) -> f64 {
        let share = weight / (ROULETTE_BELOW * begun_with);
        if share >= 1.0 {
            1.0
        } else if draw.uniform() < share {
            1.0 / share
        } else {
            0.0
        }
    }
}
