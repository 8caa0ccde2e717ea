//! The reference's answer to single rays through a scene.

use glam::DVec3;
use rayon::prelude::*;
use welkin_lut::{BAND_COUNT, Bands};

use super::disc::{first_order_with_discs, is_integrated};
use super::effort::Effort;
use super::path::{Budget, Estimate, FirstOrderBy, View};
use super::single::{emits, first_order_within, is_covered, usual_error};
use super::solver::{Solver, SolverError};
use super::transport::transmittance;
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

/// Traces rays through a scene, over smooth ground, by the path tracer. The rays' sun angles place the first
/// directional light; other lights stay.
pub fn probe(scene: &Scene, rays: &[Ray], orders: Orders, effort: Effort, seed: u64) -> Vec<RayRadiance> {
    probe_world(&World::from_scene(scene).without_relief(), rays, orders, effort, seed)
}

/// The same for a world that is not a scene's.
pub fn probe_world(world: &World, rays: &[Ray], orders: Orders, effort: Effort, seed: u64) -> Vec<RayRadiance> {
    let trace = |(i, ray): (usize, &Ray)| trace(world, ray, orders, effort, seed, i as u64);
    rays.par_iter().enumerate().map(trace).collect()
}

/// The same by any solver. With all orders the single solver answers what arrives after at most one event; the path
/// tracer's light of the first order comes from quadrature where [`is_integrated`] holds for all lights.
///
/// # Errors
/// [`SolverError`] where the solver has no answer.
pub fn probe_by(
    solver: Solver,
    scene: &Scene,
    rays: &[Ray],
    orders: Orders,
    effort: Effort,
    seed: u64,
) -> Result<Vec<RayRadiance>, SolverError> {
    let world = World::from_scene(scene).without_relief();
    solver.check(&world, orders)?;
    if solver != Solver::Path && rays.iter().any(|ray| ray.distance_m < f64::INFINITY) {
        return Err(SolverError::Distance);
    }
    let answer = |(i, ray): (usize, &Ray)| match solver {
        Solver::Path => trace(&world, ray, orders, effort, seed, i as u64),
        Solver::Single => {
            let (world, position, toward) = placed(&world, ray);
            quadrature(&world, position, toward, orders)
        }
        Solver::Marching(march) => {
            let (world, position, toward) = placed(&world, ray);
            let marched = march.estimate(&world, position, toward, effort, (seed, i as u64));
            RayRadiance {
                radiance: marched.radiance,
                transmittance: transmittance(&world, position, toward),
                standard_error: marched.standard_error,
            }
        }
    };
    Ok(rays.par_iter().enumerate().map(answer).collect())
}

/// The world under the ray's sun, and the ray in it.
fn placed(world: &World, ray: &Ray) -> (World, DVec3, DVec3) {
    let world = world.with_sun(direction(ray.sun_zenith_rad, ray.sun_azimuth_rad));
    let toward = direction(ray.view_zenith_rad, ray.view_azimuth_rad);
    (world, DVec3::new(0.0, 0.0, ray.altitude_m.max(0.0)), toward)
}

/// What arrives after at most one event, or after exactly one in the medium.
fn quadrature(world: &World, position: DVec3, toward: DVec3, orders: Orders) -> RayRadiance {
    let first = first_order_with_discs(world, position, toward, usual_error(world));
    let radiance = match orders {
        Orders::Single => first.single.value,
        Orders::All => first.total(),
    };
    RayRadiance { radiance, transmittance: first.transmittance, standard_error: [0.0; BAND_COUNT] }
}

/// The unit vector for angles from the zenith and clockwise from north.
pub fn direction(zenith_rad: f64, azimuth_rad: f64) -> DVec3 {
    let elevation_rad = std::f64::consts::FRAC_PI_2 - zenith_rad;
    Direction { elevation_rad, azimuth_rad }.to_vector()
}

fn trace(world: &World, ray: &Ray, orders: Orders, effort: Effort, seed: u64, stream: u64) -> RayRadiance {
    let (world, position, toward) = placed(world, ray);
    // Emitted light is a light as well, whose scattering is left to walks.
    if orders == Orders::Single && !emits(&world) {
        if ray.distance_m == f64::INFINITY && world.lights.iter().all(is_integrated) {
            return quadrature(&world, position, toward, orders);
        }
        if world.lights.iter().all(is_covered) {
            let first = first_order_within(&world, position, toward, ray.distance_m, usual_error(&world));
            let (radiance, transmittance) = (first.single.value, first.transmittance);
            return RayRadiance { radiance, transmittance, standard_error: [0.0; BAND_COUNT] };
        }
    }
    let view = View::within(&world, position, toward, FirstOrderBy::Quadrature, ray.distance_m);
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
