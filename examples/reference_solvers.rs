//! The reference's three solvers on the same rays: accuracy against time.
//!
//! `cargo run --release --example reference_solvers` prints a Markdown table for one ray through the clear sky and one
//! through a patchy cloud. Truth is a long run of the path tracer, whose own standard error heads each table.

#[path = "../tests/reference/tables.rs"]
mod tables;

use std::sync::Arc;
use std::time::Instant;

use glam::{DVec3, UVec3};
use welkin::probe::Orders;
use welkin::reference::marching::March;
use welkin::reference::path::{FirstOrderBy, View};
use welkin::reference::probe::{direction, run};
use welkin::reference::single::first_order;
use welkin::reference::{Body, Effort, Emitter, GridField, Matter, Shape, World};
use welkin_lut::PhaseFunction;

/// The band that is compared: green.
const BAND: usize = 1;
/// Walks behind the truth.
const TRUTH_WALKS: u64 = 1 << 22;
/// Repeats of each march: their spread is the noise of one.
const REPEATS: u64 = 16;

fn main() {
    let sky = tables::earth("B", 0.3).with_sun(direction(60_f64.to_radians(), 0.0));
    compare("Clear sky, sun at 60°, from 500 m", &sky, DVec3::new(0.0, 0.0, 500.0), direction(0.8, 1.5));
    let d = DVec3::new(0.8, 0.5, -0.3).normalize();
    compare("Patchy cloud, mean optical thickness about 5", &cloud(), DVec3::splat(0.5) - d * 3.0, d);
}

/// A cube of one metre with uneven filling of albedo 1 under a beam.
fn cloud() -> World {
    let samples = (0..16 * 16 * 16).map(|voxel: u32| f64::from((voxel * 2_654_435) % 97) / 97.0).collect();
    let field = GridField::new(DVec3::ZERO, DVec3::ONE, UVec3::splat(16), samples).expect("a grid");
    let matter = Matter {
        scattering_per_m: [10.0; 3],
        extinction_per_m: [10.0; 3],
        emission_per_m: [0.0; 3],
        phase: PhaseFunction::HenyeyGreenstein { g: 0.85 },
    };
    let shape = Shape::Box { min_m: DVec3::ZERO, max_m: DVec3::ONE };
    let mut world = World::stratified(shape, [0.0; 3], &[]);
    world.bodies = Arc::new([Body { matter: [matter], field: Arc::new(field) }]);
    let toward = DVec3::new(0.3, -0.5, 0.9).normalize();
    world.lights.push(Emitter::Beam { toward, irradiance: [1.0; 3] });
    world
}

fn compare(title: &str, world: &World, p: DVec3, d: DVec3) {
    let view = View::new(world, p, d, FirstOrderBy::Quadrature);
    let truth = run(&view, Effort::Walks(TRUTH_WALKS), Orders::All, 99, 0);
    let (value, error) = (truth.mean.total()[BAND], truth.total_error[BAND]);
    println!("\n**{title}** (truth {value:.5e} ± {:.3} %)\n", 100.0 * error / value);
    println!("| solver | setting | off by % | of which noise % | ms |\n|---|---|---|---|---|");
    let row = |solver: &str, setting: String, radiance: f64, noise: f64, seconds: f64| {
        let off = 100.0 * (radiance / value - 1.0);
        println!("| {solver} | {setting} | {off:+.3} | {:.3} | {:.3} |", 100.0 * noise / value, 1e3 * seconds);
    };
    for relative in [1e-2, 1e-5] {
        let start = Instant::now();
        let first = first_order(world, p, d, relative);
        let radiance = first.single.value[BAND] + first.ground[BAND];
        row("(a) single", format!("error bound {relative:.0e}"), radiance, 0.0, start.elapsed().as_secs_f64());
    }
    for (depth, directions, fewest_steps) in [(0, 1, 40), (1, 8, 20), (1, 32, 40), (2, 4, 12), (3, 2, 8)] {
        let march = March { directions, depth, step_optical_depth: 0.3, fewest_steps };
        let start = Instant::now();
        let marched = march.radiance(world, p, d, REPEATS, 1);
        let seconds = start.elapsed().as_secs_f64() / REPEATS as f64;
        let noise = marched.standard_error[BAND] * (REPEATS as f64).sqrt();
        let setting = format!("depth {depth}, {directions} directions, ≥ {fewest_steps} steps");
        row("(b) marching", setting, marched.radiance[BAND], noise, seconds);
    }
    for walks in [1 << 10, 1 << 13, 1 << 16] {
        let start = Instant::now();
        let view = View::new(world, p, d, FirstOrderBy::Quadrature);
        let estimate = run(&view, Effort::Walks(walks), Orders::All, 1, 0);
        let seconds = start.elapsed().as_secs_f64();
        row("(c) path", format!("{walks} walks"), estimate.mean.total()[BAND], estimate.total_error[BAND], seconds);
    }
}
