//! Solver (b): recursive Monte Carlo ray marching as the course notes describe it (Premože 2003, eq. 18 to 21).
//!
//! Biased by its steps and its depth, and exponential in the depth. It is here to be compared with: as steps shrink
//! and depth and directions grow it tends to what [`super::path`] finds.

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;
use welkin_lut::{BAND_COUNT, Bands};

use super::effort::Effort;
use super::field::USUAL_STEP;
use super::light::Emitter;
use super::matter::around;
use super::random::Draw;
use super::shape::{End, Span};
use super::sight_line::depth_between;
use super::single::{emitted, in_scattering};
use super::spectrum;
use super::transport::extinction;
use super::world::World;

/// Repeats of the first round, from which the number still needed is estimated.
const PILOT_REPEATS: u64 = 8;
/// Most repeats, however small the error asked for.
const MOST_REPEATS: u64 = 1 << 16;

/// How finely and how deeply to march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct March {
    /// M, directions from which in-scattered light is gathered at each step.
    pub directions: usize,
    /// Orders of scattering beyond the first; light that matter gives off is scattered so many times at most.
    pub depth: usize,
    /// Largest optical depth of a step: steps shorten where matter is dense.
    pub step_optical_depth: f64,
    /// Fewest steps along a ray, which bound the steps where matter is thin.
    pub fewest_steps: usize,
}

impl fmt::Display for March {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { directions, depth, step_optical_depth, fewest_steps } = self;
        write!(f, "{directions} directions, depth {depth}, steps of optical depth {step_optical_depth} and at least ")?;
        write!(f, "{fewest_steps} of them")
    }
}

/// Mean and standard error of repeated marches along one ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marched {
    /// Mean radiance, W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Bands,
    /// One standard error of the mean; says nothing of the bias.
    pub standard_error: Bands,
}

impl March {
    /// Marches `repeats` ≥ 2 times along the ray from `p` along the unit vector `d`, each time in other directions.
    pub fn radiance(&self, world: &World, p: DVec3, d: DVec3, repeats: u64, seed: u64) -> Marched {
        self.repeated(world, p, d, 0..repeats, (seed, 0))
    }

    /// One march. `draws` selects the random numbers: seed, stream (the number of the ray) and repeat.
    pub fn once(&self, world: &World, p: DVec3, d: DVec3, draws: [u64; 3]) -> Bands {
        let [seed, stream, repeat] = draws;
        self.gather(world, p, d, self.depth, true, &mut Draw::new(seed, stream, repeat))
    }

    /// Marches until the effort is spent. As many repeats as a relative error takes are estimated from a first round,
    /// which is thrown away.
    pub fn estimate(&self, world: &World, p: DVec3, d: DVec3, effort: Effort, draws: (u64, u64)) -> Marched {
        match effort {
            Effort::Walks(repeats) => self.repeated(world, p, d, 0..repeats.max(2), draws),
            Effort::RelativeError(target) => {
                let pilot = self.repeated(world, p, d, 0..PILOT_REPEATS, draws);
                let relative = (0..BAND_COUNT).map(|j| match pilot.standard_error[j] {
                    0.0 => 0.0,
                    error => error / pilot.radiance[j],
                });
                let excess = relative.fold(0.0, f64::max) / target;
                if excess == 0.0 {
                    // Nothing is drawn at random.
                    return pilot;
                }
                let wanted = PILOT_REPEATS as f64 * (1.2 * excess).powi(2);
                let repeats = (wanted.ceil() as u64).clamp(2 * PILOT_REPEATS, MOST_REPEATS);
                self.repeated(world, p, d, PILOT_REPEATS..PILOT_REPEATS + repeats, draws)
            }
        }
    }

    fn repeated(&self, world: &World, p: DVec3, d: DVec3, repeats: Range<u64>, (seed, stream): (u64, u64)) -> Marched {
        let count = (repeats.end - repeats.start) as f64;
        let once = |repeat| self.once(world, p, d, [seed, stream, repeat]);
        let all: Vec<Bands> = repeats.into_par_iter().map(once).collect();
        let mut radiance = spectrum::ZERO;
        all.iter().for_each(|value| spectrum::accumulate(&mut radiance, 1.0 / count, *value));
        let standard_error = std::array::from_fn(|j| {
            let squares: f64 = all.iter().map(|value| (value[j] - radiance[j]).powi(2)).sum();
            (squares / (count * (count - 1.0))).sqrt()
        });
        Marched { radiance, standard_error }
    }

    /// Radiance arriving at `p` from `d` after at most `depth` + 1 events; `open` tells whether the surroundings behind
    /// the medium count.
    fn gather(&self, world: &World, p: DVec3, d: DVec3, depth: usize, open: bool, draw: &mut Draw) -> Bands {
        let behind = if open { background(world) } else { spectrum::ZERO };
        let Some(span) = world.shape.span(p, d) else { return behind };
        let mut radiance = spectrum::ZERO;
        let mut transmittance = spectrum::ONE;
        let mut t = span.start_m;
        while t < span.end_m {
            let step = self.step(world, p, d, t, &span);
            let at = p + d * (t + 0.5 * step);
            let c = extinction(world, p, d, t + 0.5 * step);
            let here = spectrum::product(transmittance, spectrum::attenuation(c.map(|c| 0.5 * c * step)));
            let source = self.source(world, at, d, depth, draw);
            spectrum::accumulate(&mut radiance, step, spectrum::product(here, source));
            transmittance = spectrum::product(transmittance, spectrum::attenuation(c.map(|c| c * step)));
            t += step;
        }
        let behind = match span.end {
            End::Ground => self.ground(world, p + d * span.end_m, depth, draw),
            End::Space => behind,
        };
        spectrum::accumulate(&mut radiance, 1.0, spectrum::product(transmittance, behind));
        radiance
    }

    /// Length of the step that starts at `t_m`. Density is looked up at its start and at its end, so that a step does
    /// not leap into a cloud.
    fn step(&self, world: &World, p: DVec3, d: DVec3, t_m: f64, span: &Span) -> f64 {
        let longest = ((span.end_m - span.start_m) / self.fewest_steps as f64).min(span.end_m - t_m);
        let fits = |at: f64| self.step_optical_depth / spectrum::largest(extinction(world, p, d, at));
        let first = longest.min(fits(t_m));
        first.min(fits(t_m + first).max(0.1 * first))
    }

    /// What a point sends back along a ray per metre: its own light, direct light of every lamp, and light from M
    /// directions.
    fn source(&self, world: &World, at: DVec3, d: DVec3, depth: usize, draw: &mut Draw) -> Bands {
        let mut total = emitted(world, at);
        for (direction, irradiance) in direct(world, at, draw) {
            let response = in_scattering(world, at, d.dot(direction).clamp(-1.0, 1.0));
            spectrum::accumulate(&mut total, 1.0, spectrum::product(response, irradiance));
        }
        if depth > 0 {
            for _ in 0..self.directions {
                let direction = around(DVec3::Z, 1.0 - 2.0 * draw.uniform(), draw.uniform());
                // The lights themselves and the surroundings are what `direct` covers.
                let arriving = self.gather(world, at, direction, depth - 1, false, draw);
                let response = in_scattering(world, at, d.dot(direction).clamp(-1.0, 1.0));
                spectrum::accumulate(
                    &mut total,
                    4.0 * PI / self.directions as f64,
                    spectrum::product(response, arriving),
                );
            }
        }
        total
    }

    /// Light reflected by the ground.
    fn ground(&self, world: &World, at: DVec3, depth: usize, draw: &mut Draw) -> Bands {
        let normal = world.shape.up(at);
        let mut irradiance = spectrum::ZERO;
        for (direction, beam) in direct(world, at, draw) {
            spectrum::accumulate(&mut irradiance, normal.dot(direction).max(0.0), beam);
        }
        if depth > 0 {
            for _ in 0..self.directions {
                let cosine = draw.uniform();
                let direction = around(normal, cosine, draw.uniform());
                let arriving = self.gather(world, at, direction, depth - 1, false, draw);
                spectrum::accumulate(&mut irradiance, cosine * TAU / self.directions as f64, arriving);
            }
        }
        spectrum::product(world.ground_albedo, irradiance).map(|e| e / PI)
    }
}

/// Radiance of space.
fn background(world: &World) -> Bands {
    let mut total = spectrum::ZERO;
    for light in &world.lights {
        if let Emitter::Environment { radiance } = light {
            spectrum::accumulate(&mut total, 1.0, *radiance);
        }
    }
    total
}

/// One direction to every lamp and what arrives from there, its shadow ray included (eq. 19).
fn direct(world: &World, at: DVec3, draw: &mut Draw) -> Vec<(DVec3, Bands)> {
    let mut arriving = Vec::with_capacity(world.lights.len());
    for light in &world.lights {
        let sample = light.sample(at, draw.uniform(), draw.uniform());
        let Some(span) = world.shape.span(at, sample.direction) else {
            arriving.push((sample.direction, sample.irradiance));
            continue;
        };
        if span.end == End::Space || span.end_m >= sample.distance_m {
            let end = span.end_m.min(sample.distance_m);
            let depth = depth_between(world, at, sample.direction, (span.start_m, end), USUAL_STEP);
            arriving.push((sample.direction, spectrum::product(sample.irradiance, spectrum::attenuation(depth))));
        }
    }
    arriving
}
