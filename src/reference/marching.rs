//! Solver (b): recursive Monte Carlo ray marching as the course notes describe it (Premože 2003, eq. 18 to 21).
//!
//! Biased by its steps and its depth, and exponential in the depth. It is here to be compared with: as steps shrink
//! and depth and directions grow it tends to what [`super::path`] finds.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;
use welkin_lut::Bands;

use super::light::Emitter;
use super::matter::around;
use super::random::Draw;
use super::shape::{End, Span};
use super::single::{depth_between, in_scattering};
use super::spectrum;
use super::transport::extinction;
use super::world::World;

/// How finely and how deeply to march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct March {
    /// M, directions from which in-scattered light is gathered at each step.
    pub directions: usize,
    /// Orders of scattering beyond the first.
    pub depth: usize,
    /// Largest optical depth of a step: steps shorten where matter is dense.
    pub step_optical_depth: f64,
    /// Fewest steps along a ray, which bound the steps where matter is thin.
    pub fewest_steps: usize,
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
        let once = |repeat| self.gather(world, p, d, self.depth, &mut Draw::new(seed, 0, repeat));
        let all: Vec<Bands> = (0..repeats).into_par_iter().map(once).collect();
        let count = repeats as f64;
        let mut radiance = spectrum::ZERO;
        all.iter().for_each(|value| spectrum::accumulate(&mut radiance, 1.0 / count, *value));
        let standard_error = std::array::from_fn(|j| {
            let squares: f64 = all.iter().map(|value| (value[j] - radiance[j]).powi(2)).sum();
            (squares / (count * (count - 1.0))).sqrt()
        });
        Marched { radiance, standard_error }
    }

    /// Radiance arriving at `p` from `d` after at most `depth` + 1 events.
    fn gather(&self, world: &World, p: DVec3, d: DVec3, depth: usize, draw: &mut Draw) -> Bands {
        let Some(span) = world.shape.span(p, d) else { return background(world) };
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
            End::Space => background(world),
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

    /// What a point sends back along a ray per metre: direct light of every lamp, and light from M directions.
    fn source(&self, world: &World, at: DVec3, d: DVec3, depth: usize, draw: &mut Draw) -> Bands {
        let mut total = spectrum::ZERO;
        for (direction, irradiance) in direct(world, at, draw) {
            let response = in_scattering(world, at, d.dot(direction).clamp(-1.0, 1.0));
            spectrum::accumulate(&mut total, 1.0, spectrum::product(response, irradiance));
        }
        if depth > 0 {
            for _ in 0..self.directions {
                let direction = around(DVec3::Z, 1.0 - 2.0 * draw.uniform(), draw.uniform());
                let arriving = self.scattered(world, at, direction, depth, draw);
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
                let arriving = self.scattered(world, at, around(normal, cosine, draw.uniform()), depth, draw);
                spectrum::accumulate(&mut irradiance, cosine * TAU / self.directions as f64, arriving);
            }
        }
        spectrum::product(world.ground_albedo, irradiance).map(|e| e / PI)
    }

    /// L_sc: what arrives from a direction without the lamps themselves, which [`direct`] covers.
    fn scattered(&self, world: &World, at: DVec3, direction: DVec3, depth: usize, draw: &mut Draw) -> Bands {
        let dark =
            World { lights: world.lights.iter().filter(|l| !is_background(l)).cloned().collect(), ..world.clone() };
        self.gather(&dark, at, direction, depth - 1, draw)
    }
}

fn is_background(light: &Emitter) -> bool {
    matches!(light, Emitter::Environment { .. })
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
            let depth = depth_between(world, at, sample.direction, span.start_m, end);
            arriving.push((sample.direction, spectrum::product(sample.irradiance, spectrum::attenuation(depth))));
        }
    }
    arriving
}
