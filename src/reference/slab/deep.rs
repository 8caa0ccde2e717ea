//! Transmittance of thick slabs: walks that know where the light is wanted.
//!
//! Free flights are stretched towards the bottom and directions are drawn in proportion to phase function times
//! [`Asymptotic`] importance (the exponential transform of nuclear shielding; Spanier & Gelbard 1969, section 3.5;
//! Dwivedi 1982, Annals of Nuclear Energy 9), both with exact weights.
//!
//! What a walk scores is the light that leaves less what the asymptotic solution Ψ says that it will bring: each step
//! adds (what leaves + what Ψ promises after the next collision - what Ψ promises now), whose sum along a walk has the
//! same mean for every function Ψ (a control variate). Deep inside, where Ψ solves the transport equation, a step adds
//! nothing; what is left to be estimated is how boundaries differ from it.

use rayon::prelude::*;

use super::asymptotic::Asymptotic;
use super::{BATCHES, Slab, turn};
use crate::reference::quadrature::GaussLegendre;
use crate::reference::random::Draw;

/// Below this share of the importance that it began with, a walk is played for its life.
const ROULETTE_BELOW: f64 = 0.2;
/// The stream of random numbers, another than that of the walks for reflectance.
const STREAM: u64 = 1;
/// Distance above the top at which the light of a deep layer seems to vanish, in transport mean free paths (Hopf 1934).
const EXTRAPOLATED: f64 = 0.7104;

/// A walk between two flights. Its weight is in units of e^(-κ depth), so that it neither fades nor underflows.
#[derive(Debug, Clone, Copy)]
struct Walk {
    depth: f64,
    mu: f64,
    weight: f64,
}

/// Mean over one batch.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Transmitted {
    /// Downward at the bottom after at least one event.
    pub down: f64,
    /// Steps, which is what a walk costs.
    pub steps: f64,
}

/// A slab with its guide.
pub(super) struct Deep<'a> {
    slab: &'a Slab,
    guide: Asymptotic,
    /// Optical distance of the extrapolated boundary above the top.
    beyond: f64,
    /// Factor of Ψ.
    scale: f64,
    /// Mean of Ψ over what the surface reflects, per unit of it, in units of e^(-κτ).
    reflected: f64,
}

impl<'a> Deep<'a> {
    /// Prepares the guide.
    pub fn new(slab: &'a Slab) -> Self {
        let guide = Asymptotic::new(slab.albedo, &slab.phase);
        let transport = 1.0 - slab.albedo * slab.phase.mean_cosine();
        let beyond = EXTRAPOLATED / transport.max(1e-3);
        let mut deep = Self { slab, guide, beyond, scale: 1.0, reflected: 0.0 };
        // Ψ is made to give 1, and what the surface sends back, on average over what leaves at the bottom.
        let rule = GaussLegendre::new(32);
        let mean = |sign: f64| -> f64 {
            let thickness = slab.optical_thickness;
            rule.points.iter().map(|(mu, w)| w * 2.0 * mu * deep.promise(thickness, sign * mu)).sum()
        };
        let (down, up) = (mean(1.0), mean(-1.0));
        deep.scale = 1.0 / (down - slab.surface_albedo * up).max(1e-6 * down);
        deep.reflected = deep.scale * up;
        deep
    }

    /// Means over batches of walks.
    pub fn batches(&self, photons: u64, seed: u64) -> Vec<Transmitted> {
        let walks = photons.div_ceil(BATCHES).max(1);
        (0..BATCHES).into_par_iter().map(|batch| self.batch(walks, seed, batch)).collect()
    }

    fn batch(&self, walks: u64, seed: u64, batch: u64) -> Transmitted {
        let mut draw = Draw::new(seed, STREAM, batch);
        let (mut down, mut steps) = (0.0, 0.0);
        for index in 0..walks {
            draw.start(index);
            let (scored, taken) = self.walk(&mut draw);
            down += scored;
            steps += taken;
        }
        let unit = (-self.guide.kappa * self.slab.optical_thickness).exp();
        Transmitted { down: unit * down / walks as f64, steps: steps / walks as f64 }
    }

    /// One walk: its score in units of e^(-κτ), and its steps.
    fn walk(&self, draw: &mut Draw) -> (f64, f64) {
        let mut walk = Walk { depth: 0.0, mu: self.slab.mu0, weight: 1.0 };
        let begun_with = self.guide.importance(walk.mu);
        let (mut score, mut steps) = (0.0, 0.0);
        // Direct light does not count, nor has anything been promised yet.
        let (mut counts, mut promised) = (0.0, 0.0);
        while walk.weight > 0.0 {
            steps += 1.0;
            let Walk { depth, mu, weight } = walk;
            let left = self.slab.optical_thickness - depth;
            let length = if mu > 0.0 { left / mu } else { depth / -mu };
            let leaves = if mu > 0.0 { (left * (self.guide.kappa - 1.0 / mu)).exp() } else { 0.0 };
            let sent_back = leaves * self.slab.surface_albedo;
            score +=
                weight * (counts * leaves + sent_back * self.reflected + self.after_flight(&walk, length) - promised);
            // Go on with one of the two that stay in play, with the weight of both.
            let collided =
                self.slab.albedo * reach(1.0 - self.guide.kappa * mu, length) * self.guide.after_scattering(mu);
            let both = collided + sent_back;
            let survives = self.roulette(weight * both, begun_with, draw);
            if survives == 0.0 {
                break;
            }
            if draw.uniform() * both < collided {
                walk = self.collide(&walk, length, draw);
                // The chance of this branch was collided / both.
                walk.weight *= both / collided * survives;
            } else {
                let mu = -(1.0 - draw.uniform()).sqrt();
                walk = Walk { depth: self.slab.optical_thickness, mu, weight: weight * both * survives };
            }
            counts = 1.0;
            promised = self.scale * self.promise(walk.depth, walk.mu);
        }
        (score, steps)
    }

    /// Ψ over its factor, in units of e^(κ (depth - τ)): the growing solution less the falling one that makes it vanish
    /// above the top.
    fn promise(&self, depth: f64, mu: f64) -> f64 {
        let falling = (-2.0 * self.guide.kappa * (depth + self.beyond)).exp();
        self.guide.importance(mu) - falling * self.guide.importance(-mu)
    }

    /// The mean of Ψ after the collision that ends a flight, in the same units: ∫ e^-s W ∫P Ψ dω' ds up to the boundary.
    fn after_flight(&self, walk: &Walk, length: f64) -> f64 {
        let Self { slab, guide, .. } = self;
        let falling = (-2.0 * guide.kappa * (walk.depth + self.beyond)).exp();
        let tilt = guide.kappa * walk.mu;
        let growing = guide.after_scattering(walk.mu) * reach(1.0 - tilt, length);
        self.scale * slab.albedo * (growing - falling * guide.after_scattering(-walk.mu) * reach(1.0 + tilt, length))
    }

    /// Flies to a collision before the boundary `length` away, and turns.
    fn collide(&self, walk: &Walk, length: f64, draw: &mut Draw) -> Walk {
        // A flight of density ∝ e^(-stretched s), cut off at the boundary. In units of e^(-κ depth) its weight is what
        // the density is short of 1.
        let stretched = 1.0 - self.guide.kappa * walk.mu;
        let within = -(-stretched * length).exp_m1();
        let flight = -(-draw.uniform() * within).ln_1p() / stretched;
        let depth = (walk.depth + flight * walk.mu).clamp(0.0, self.slab.optical_thickness);
        let mut mu = turn(walk.mu, self.slab.phase.sample(draw.uniform()), draw.uniform());
        let mut importance = self.guide.importance(mu);
        while draw.uniform() * self.guide.most >= importance {
            mu = turn(walk.mu, self.slab.phase.sample(draw.uniform()), draw.uniform());
            importance = self.guide.importance(mu);
        }
        let turned = self.slab.albedo * self.guide.after_scattering(walk.mu) / importance;
        Walk { depth, mu, weight: walk.weight * within / stretched * turned }
    }

    /// Factor of the weight: 1, or 0, or what survival is worth.
    fn roulette(&self, importance: f64, begun_with: f64, draw: &mut Draw) -> f64 {
        let share = importance / (ROULETTE_BELOW * begun_with);
        if share >= 1.0 {
            1.0
        } else if draw.uniform() < share {
            1.0 / share
        } else {
            0.0
        }
    }
}

/// ∫ e^(-rate s) ds from 0 to `length`.
pub(super) fn reach(rate: f64, length: f64) -> f64 {
    -(-rate * length).exp_m1() / rate
}
