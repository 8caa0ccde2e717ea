//! What a bake and the reference cost.

use serde::Serialize;
use welkin_lut::bake::BakeSettings;

use super::Stopwatch;
use crate::passes::RenderError;
use crate::probe::{Orders, Ray};
use crate::reference::{Effort, probe};
use crate::renderer::Renderer;
use crate::scene::Scene;

/// What a piece of work has cost.
#[derive(Debug, Clone, Serialize)]
pub struct WorkCost {
    /// What it is called.
    pub name: String,
    /// How much was done: texels, or walks.
    pub size: f64,
    /// Processor time, ms.
    pub processor_ms: f64,
    /// Time that passed, ms.
    pub wall_ms: f64,
}

/// The tables of a pack, by a device.
///
/// # Errors
/// As [`Renderer::bake`].
pub fn bake_cost(renderer: &mut Renderer, scene: &Scene, settings: &BakeSettings) -> Result<WorkCost, RenderError> {
    // Pipelines are made.
    renderer.bake(scene, settings)?;
    let stopwatch = Stopwatch::start();
    let (_, set) = renderer.bake(scene, settings)?;
    let texels: u32 = [&set.transmittance, &set.multiple_scattering, &set.scattering]
        .iter()
        .map(|table| table.size().iter().product::<u32>())
        .sum();
    Ok(done("bake on the device", f64::from(texels), &stopwatch))
}

/// Walks of the path tracer from the ground into every direction, on `cores` threads.
///
/// # Panics
/// When the system gives no threads.
pub fn reference_cost(scene: &Scene, walks: u64, cores: usize) -> WorkCost {
    let rays: Vec<Ray> = (0..RAYS).map(ray).collect();
    let threads = rayon::ThreadPoolBuilder::new().num_threads(cores).build().expect("threads");
    let stopwatch = Stopwatch::start();
    threads.install(|| probe(scene, &rays, Orders::All, Effort::Walks(walks), 1));
    done(&format!("reference on {cores} cores"), (RAYS as u64 * walks) as f64, &stopwatch)
}

/// Directions over the sky.
const RAYS: usize = 16;

fn ray(index: usize) -> Ray {
    let turn = index as f64 / RAYS as f64;
    Ray {
        altitude_m: 2.0,
        view_zenith_rad: 1.5 * turn,
        view_azimuth_rad: 3.0 * (0.618 * index as f64).fract(),
        sun_zenith_rad: 1.0,
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
    }
}

fn done(name: &str, size: f64, stopwatch: &Stopwatch) -> WorkCost {
    let name = name.to_owned();
    WorkCost { name, size, processor_ms: stopwatch.processor_ms(), wall_ms: stopwatch.wall_ms() }
}
