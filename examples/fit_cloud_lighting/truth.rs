//! What the path tracer says of a view, kept in files by content.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec3, UVec3};
use rayon::prelude::*;
use welkin::reference::path::{Budget, FirstOrderBy, View as Ray};
use welkin::reference::{Body, Emitter, GridField, Matter, Shape, World};
use welkin_lut::{Bands, PhaseFunction};

use super::fields::{Cloud, SIZE, extent_m};
use super::views::{PIXELS, View, suns};

/// Walks from one point of a pixel.
const WALKS_PER_BATCH: u64 = 4;

/// A picture of three bands.
#[derive(Debug, Clone)]
pub struct Truth {
    /// Radiance of each pixel, row by row.
    pub mean: Vec<Bands>,
    /// Its standard error.
    pub error: Vec<Bands>,
}

fn world(cloud: &Cloud, phase: &PhaseFunction) -> World {
    let size = UVec3::from_array(SIZE.map(|n| n as u32));
    let field = GridField::new(DVec3::ZERO, extent_m(), size, cloud.extinction_per_m.clone()).expect("a whole grid");
    let matter = Matter {
        scattering_per_m: [1.0; 3],
        extinction_per_m: [1.0; 3],
        emission_per_m: [0.0; 3],
        phase: phase.clone(),
    };
    let mut world = World::stratified(Shape::Plane { height_m: extent_m().z }, [0.0; 3], &[]);
    world.bodies = Arc::new([Body { matter: [matter], field: Arc::new(field) }]);
    world.lights = suns().into_iter().enumerate().map(beam_in_band).collect();
    world
}

/// Bands do not mix in grey matter, so that one set of walks serves three suns.
fn beam_in_band((band, toward): (usize, DVec3)) -> Emitter {
    let mut irradiance = [0.0; 3];
    irradiance[band] = 1.0;
    Emitter::Beam { toward, irradiance }
}

/// The picture, from its file or by so many walks a pixel.
///
/// # Errors
/// When the folder cannot be written or read.
pub fn truth(folder: &Path, cloud: &Cloud, phase: &PhaseFunction, view: View, walks: u64) -> io::Result<Truth> {
    let path = file(folder, cloud, phase, view, walks);
    if let Ok(bytes) = std::fs::read(&path) {
        let numbers: Vec<f64> = bytemuck::pod_collect_to_vec(&bytes);
        let bands: Vec<Bands> = numbers.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let (mean, error) = bands.split_at(PIXELS[0] * PIXELS[1]);
        return Ok(Truth { mean: mean.to_vec(), error: error.to_vec() });
    }
    let world = world(cloud, phase);
    let pixels: Vec<(Bands, Bands)> =
        (0..PIXELS[0] * PIXELS[1]).into_par_iter().map(|pixel| trace(&world, view, pixel, walks)).collect();
    let truth = Truth { mean: pixels.iter().map(|p| p.0).collect(), error: pixels.iter().map(|p| p.1).collect() };
    let numbers: Vec<Bands> = truth.mean.iter().chain(&truth.error).copied().collect();
    std::fs::create_dir_all(folder)?;
    std::fs::write(&path, bytemuck::cast_slice::<Bands, u8>(&numbers))?;
    Ok(truth)
}

fn trace(world: &World, view: View, pixel: usize, walks: u64) -> (Bands, Bands) {
    let (x, y) = (pixel % PIXELS[0], pixel / PIXELS[0]);
    let budget = Budget { batches: 1, walks_per_batch: WALKS_PER_BATCH, seed: 1, stream: pixel as u64, first_batch: 0 };
    let batches = walks / WALKS_PER_BATCH;
    let (mut sum, mut squares) = ([0.0; 3], [0.0; 3]);
    for batch in 0..batches {
        // Spread over the pixel as evenly as a golden-ratio sequence does.
        let inside = |step: f64| (batch as f64 * step + 0.5).fract();
        let across = (x as f64 + inside(0.754_877_666)) / PIXELS[0] as f64;
        let down = (y as f64 + inside(0.569_840_291)) / PIXELS[1] as f64;
        let ray = Ray::new(world, view.start(across, down), view.direction(), FirstOrderBy::Walks);
        let value = ray.batch(&budget, batch).total();
        for band in 0..3 {
            sum[band] += value[band];
            squares[band] += value[band] * value[band];
        }
    }
    let n = batches as f64;
    let error = |band: usize| ((squares[band] / n - (sum[band] / n).powi(2)).max(0.0) / (n - 1.0)).sqrt();
    (sum.map(|s| s / n), [error(0), error(1), error(2)])
}

fn file(folder: &Path, cloud: &Cloud, phase: &PhaseFunction, view: View, walks: u64) -> PathBuf {
    let problem = format!("{phase:?} Suns {:?} {:?} {PIXELS:?} {walks}", view.start(0.0, 0.0), view.direction());
    let mut hash = crc32fast::Hasher::new();
    hash.update(problem.as_bytes());
    hash.update(bytemuck::cast_slice(&cloud.extinction_per_m));
    folder.join(format!("{}-suns-{view:?}-{:08x}.f64", cloud.name(), hash.finalize()).to_lowercase())
}
