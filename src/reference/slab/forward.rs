//! Walks with the light whose exits are counted by expectation: reflectance, absorption, and transmittance where the
//! slab is not thick.

use rayon::prelude::*;

use super::{BATCHES, Slab, turn};
use crate::reference::random::Draw;

/// Weight below which a walk is played for its life.
const ROULETTE_BELOW: f64 = 0.1;
/// The stream of random numbers.
const STREAM: u64 = 0;

/// Sums of one batch.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    /// Upward at the top.
    pub up: f64,
    /// Downward at the bottom after at least one event.
    pub down: f64,
    /// Lost in the slab.
    pub absorbed: f64,
    /// Steps, which is what a walk costs.
    pub steps: f64,
}

/// Means over batches of walks.
pub(super) fn batches(slab: &Slab, photons: u64, seed: u64) -> Vec<Sums> {
    let walks = photons.div_ceil(BATCHES).max(1);
    (0..BATCHES).into_par_iter().map(|batch| slab.batch(walks, seed, batch)).collect()
}

impl Slab {
    /// Means over one batch.
    fn batch(&self, walks: u64, seed: u64, batch: u64) -> Sums {
        let mut draw = Draw::new(seed, STREAM, batch);
        let mut sums = Sums::default();
        for index in 0..walks {
            draw.start(index);
            self.walk(&mut draw, &mut sums);
        }
        let mean = |sum: f64| sum / walks as f64;
        Sums { up: mean(sums.up), down: mean(sums.down), absorbed: mean(sums.absorbed), steps: mean(sums.steps) }
    }

    fn walk(&self, draw: &mut Draw, sums: &mut Sums) {
        // Depth below the top in optical units, and the cosine to the downward vertical.
        let (mut depth, mut mu, mut weight) = (0.0, self.mu0, 1.0);
        let mut scattered = false;
        while weight > 0.0 {
            sums.steps += 1.0;
            let to_boundary = if mu > 0.0 { (self.optical_thickness - depth) / mu } else { depth / -mu };
            let leaves = weight * (-to_boundary).exp();
            let collides = weight * -(-to_boundary).exp_m1();
            if mu < 0.0 {
                sums.up += leaves;
            } else if scattered {
                sums.down += leaves;
            }
            // Go on with one of the two that stay in play, with the weight of both.
            let reflected = if mu > 0.0 { leaves * self.surface_albedo } else { 0.0 };
            let survivors = collides * self.albedo;
            sums.absorbed += collides - survivors;
            weight = reflected + survivors;
            scattered = true;
            if draw.uniform() * weight < survivors {
                // Exponential step cut off at the boundary, by inversion.
                let step = -(draw.uniform() * (-to_boundary).exp_m1()).ln_1p();
                depth = (depth + step * mu).clamp(0.0, self.optical_thickness);
                mu = turn(mu, self.phase.sample(draw.uniform()), draw.uniform());
            } else {
                depth = self.optical_thickness;
                mu = -(1.0 - draw.uniform()).sqrt();
            }
            if weight < ROULETTE_BELOW {
                let survives = draw.uniform() * ROULETTE_BELOW < weight;
                weight = if survives { ROULETTE_BELOW } else { 0.0 };
            }
        }
    }
}
