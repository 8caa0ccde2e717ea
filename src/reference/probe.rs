//! The reference's answer to single rays through a scene.

use glam::DVec3;
use rayon::prelude::*;
use welkin_lut::{BAND_COUNT, Bands};

use super::path::{Budget, Estimate, FirstOrderBy, View};
use super::single;
use super::world::World;
use crate::probe::{Orders, Ray, RayRadiance};
use crate::scene::{Direction, Scene};

/// Batches behind every standard error.
const BATCHES: u64 = 32;
/// Walks in each batch of the first round, from which the number still needed is estimated.
const PILOT_WALKS: u64 = 64;
/// Fewest walks in each batch of a result: with fewer, batch means are too skewed for a standard error to mean much.
const FEWEST_WALKS: u64 = 128;
/// Most walks in a batch, however small the error asked for.
const MOST_WALKS: u64 = 1 << 22;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effort {
    /// After this many walks for each ray.
    Walks(u64),
    /// When one standard error is below this share of the radiance in every band.
    RelativeError(f64),
}

/// Traces rays through a scene. The rays' sun angles place the first directional light; other lights stay.
pub fn probe(scene: &Scene, rays: &[Ray], orders: Orders, effort: Effort, seed: u64) -> Vec<RayRadiance> {
    probe_world(&World::from_scene(scene), rays, orders, effort, seed)
}

/// The same for a world that is not a scene's.
pub fn probe_world(world: &World, rays: &[Ray], orders: Orders, effort: Effort, seed: u64) -> Vec<RayRadiance> {
    let trace = |(i, ray): (usize, &Ray)| trace(world, ray, orders, effort, seed, i as u64);
    rays.par_iter().enumerate().map(trace).collect()
}

/// The unit vector for angles from the zenith and clockwise from north.
pub fn direction(zenith_rad: f64, azimuth_rad: f64) -> DVec3 {
    let elevation_rad = std::f64::consts::FRAC_PI_2 - zenith_rad;
    Direction { elevation_rad, azimuth_rad }.to_vector()
}

fn trace(world: &World, ray: &Ray, orders: Orders, effort: Effort, seed: u64, stream: u64) -> RayRadiance {
    let world = world.with_sun(direction(ray.sun_zenith_rad, ray.sun_azimuth_rad));
    let position = DVec3::new(0.0, 0.0, ray.altitude_m.max(0.0));
    let toward = direction(ray.view_zenith_rad, ray.view_azimuth_rad);
    if orders == Orders::Single && world.lights.iter().all(single::is_covered) && !single::emits(&world) {
        let first = single::first_order(&world, position, toward, 1e-7);
        return RayRadiance {
            radiance: first.single.value,
            transmittance: first.transmittance,
            standard_error: [0.0; BAND_COUNT],
        };
    }
    let view = View::new(&world, position, toward, FirstOrderBy::Quadrature);
    let estimate = run(&view, effort, orders, seed, stream);
    let (radiance, standard_error) = pick(&estimate, orders);
    RayRadiance { radiance, transmittance: view.first_order().transmittance, standard_error }
}

fn pick(estimate: &Estimate, orders: Orders) -> (Bands, Bands) {
    match orders {
        Orders::All => (estimate.mean.total(), estimate.total_error),
        Orders::Single => (estimate.mean.single, estimate.single_error),
    }
}

/// Spends the effort on one view. The walks that a relative error takes are estimated from a first round, which is
/// then thrown away: a result that decided about its own stop would be biased.
pub fn run(view: &View, effort: Effort, orders: Orders, seed: u64, stream: u64) -> Estimate {
    let budget = |walks_per_batch, first_batch| Budget { batches: BATCHES, walks_per_batch, seed, stream, first_batch };
    match effort {
        Effort::Walks(walks) => view.estimate(&budget(walks.div_ceil(BATCHES), 0)),
        Effort::RelativeError(target) => {
            let mut walks = PILOT_WALKS;
            let mut round = 0;
            loop {
                let estimate = view.estimate(&budget(walks, round * BATCHES));
                let (radiance, error) = pick(&estimate, orders);
                let relative = |j: usize| if error[j] == 0.0 { 0.0 } else { error[j] / radiance[j] };
                let excess = (0..BAND_COUNT).map(relative).fold(0.0, f64::max) / target;
                if (excess <= 1.0 && round > 0) || walks >= MOST_WALKS {
                    return estimate;
                }
                // The error of an error from 32 batches is 13 %; aiming 15 % lower mostly saves a third round.
                let factor = (1.15 * excess).powi(2).clamp(1.0, 1024.0);
                walks = ((walks as f64 * factor).ceil() as u64).clamp(FEWEST_WALKS, MOST_WALKS);
                round += 1;
            }
        }
    }
}
