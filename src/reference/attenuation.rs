//! Diffuse attenuation K, measured in a simulated light field: how fast irradiance falls with depth.
//!
//! K is an apparent property (Premože 2003, section 4, "Optical properties"): it depends on the light field, not on the
//! medium alone.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;
use welkin_lut::{BAND_COUNT, Bands};

use super::field::USUAL_STEP;
use super::light::Emitter;
use super::matter::around;
use super::random::Draw;
use super::sight_line::depth_between;
use super::spectrum;
use super::tally::Tally;
use super::walk::{State, Walker};
use super::world::World;

/// Independent batches behind the standard errors.
const BATCHES: u64 = 64;

/// Diffuse attenuation between two heights, 1/m, and one standard error of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiffuseAttenuation {
    /// K = ln(E_d(upper) / E_d(lower)) / distance.
    pub per_m: Bands,
    /// One standard error.
    pub standard_error: Bands,
}

/// Measures K from the downward irradiance E_d at two heights above the world's origin, with `walks` walks at each.
pub fn diffuse_attenuation(world: &World, upper_m: f64, lower_m: f64, walks: u64, seed: u64) -> DiffuseAttenuation {
    let per_batch = walks.div_ceil(BATCHES);
    let measure = |height_m: f64, stream: u64| -> Vec<Bands> {
        let batch = |batch| irradiance(world, height_m, per_batch, Draw::new(seed, stream, batch));
        (0..BATCHES).into_par_iter().map(batch).collect()
    };
    let (upper, lower) = (statistics(&measure(upper_m, 0)), statistics(&measure(lower_m, 1)));
    let distance = upper_m - lower_m;
    DiffuseAttenuation {
        per_m: std::array::from_fn(|j| (upper.0[j] / lower.0[j]).ln() / distance),
        // First-order propagation of two independent relative errors.
        standard_error: std::array::from_fn(|j| (upper.1[j] / upper.0[j]).hypot(lower.1[j] / lower.0[j]) / distance),
    }
}

/// Downward irradiance on a horizontal plane, W·m⁻²·nm⁻¹: one batch of an unbiased estimate.
fn irradiance(world: &World, height_m: f64, walks: u64, draw: Draw) -> Bands {
    let at = DVec3::new(0.0, 0.0, height_m);
    let up = world.shape.up(at);
    let mut walker = Walker::new(world, draw);
    let mut tally = Tally::default();
    for index in 0..walks {
        walker.draw.start(index);
        let direction = around(up, (1.0 - walker.draw.uniform()).sqrt(), walker.draw.uniform());
        let state = State {
            position: at,
            direction,
            weight: [PI; BAND_COUNT],
            order: 0,
            ground: false,
            pdf_per_sr: None,
            reach_m: f64::INFINITY,
            reference: PI * BAND_COUNT as f64,
        };
        walker.follow(state, &mut tally);
    }
    let mut total = tally.total().map(|sum| sum / walks as f64);
    for light in &world.lights {
        if let Emitter::Beam { toward, irradiance } = light
            && let Some(span) = world.shape.span(at, *toward)
            && !world.shape.blocked(at, *toward)
        {
            let depth = depth_between(world, at, *toward, (span.start_m, span.end_m), USUAL_STEP);
            let direct = spectrum::product(*irradiance, spectrum::attenuation(depth));
            spectrum::accumulate(&mut total, up.dot(*toward).max(0.0), direct);
        }
    }
    total
}

/// Mean and standard error.
fn statistics(batches: &[Bands]) -> (Bands, Bands) {
    let count = batches.len() as f64;
    let mean: Bands = std::array::from_fn(|j| batches.iter().map(|b| b[j]).sum::<f64>() / count);
    let variance = |j: usize| batches.iter().map(|b| (b[j] - mean[j]).powi(2)).sum::<f64>() / (count * (count - 1.0));
    (mean, std::array::from_fn(|j| variance(j).sqrt()))
}
