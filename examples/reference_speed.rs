//! Times the reference on two problems that other renderers can be given as well; `benches/mitsuba/compare.py` runs it.
//!
//! `reference_speed slab TAU ALBEDO G MU0 PHOTONS SEED` prints {seconds, reflectance, standard_error}.
//! `reference_speed grid FILE N SIGMA_T ALBEDO G WIDTH SAMPLES SEED` prints {seconds, pixels}: FILE holds N³ densities in
//! [0, 1] as little-endian f32, x first, in the cube [-1, 1]³; the light comes from (1, 2, 3)/√14 with irradiance 1;
//! the camera is orthographic, looks along +y and frames the cube's side with WIDTH² pixels, x to the right, top first.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use glam::{DVec3, UVec3};
use rayon::prelude::*;
use welkin::reference::path::{Budget, FirstOrderBy, View};
use welkin::reference::slab::Slab;
use welkin::reference::{Body, Emitter, GridField, Matter, Shape, World};
use welkin_lut::PhaseFunction;

/// Walks from one point of a pixel.
const WALKS_PER_BATCH: u64 = 4;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize| -> Result<f64, Box<dyn Error>> {
        let text = arguments.get(i).ok_or("too few arguments; see the head of the source")?;
        Ok(text.parse().map_err(|_| format!("argument '{text}' is not a number"))?)
    };
    match arguments.first().map(String::as_str) {
        Some("slab") => {
            let slab = Slab {
                optical_thickness: number(1)?,
                albedo: number(2)?,
                phase: PhaseFunction::HenyeyGreenstein { g: number(3)? },
                mu0: number(4)?,
                surface_albedo: 0.0,
            };
            let started = Instant::now();
            let fluxes = slab.fluxes(number(5)? as u64, number(6)? as u64);
            let seconds = started.elapsed().as_secs_f64();
            let (value, error) = (fluxes.reflectance.value, fluxes.reflectance.standard_error);
            let result = serde_json::json!({"seconds": seconds, "reflectance": value, "standard_error": error});
            println!("{result}");
            Ok(())
        }
        Some("grid") => {
            let world = cloud(&arguments[1], number(2)? as u32, number(3)?, number(4)?, number(5)?)?;
            let (width, batches) = (number(6)? as usize, number(7)? as u64 / WALKS_PER_BATCH);
            let started = Instant::now();
            let pixels = picture(&world, width, batches, number(8)? as u64);
            let seconds = started.elapsed().as_secs_f64();
            println!("{}", serde_json::json!({"seconds": seconds, "pixels": pixels}));
            Ok(())
        }
        _ => Err("the first argument must be 'slab' or 'grid'".into()),
    }
}

fn cloud(file: &str, size: u32, extinction: f64, albedo: f64, g: f64) -> Result<World, Box<dyn Error>> {
    let bytes = std::fs::read(file).map_err(|error| format!("{file}: {error}"))?;
    let values = bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))).collect();
    let (min_m, max_m) = (DVec3::splat(-1.0), DVec3::splat(1.0));
    let field = Arc::new(GridField::new(min_m, max_m, UVec3::splat(size), values)?.for_extinction(extinction));
    let matter = Matter {
        scattering_per_m: [albedo * extinction; 3],
        extinction_per_m: [extinction; 3],
        emission_per_m: [0.0; 3],
        phase: PhaseFunction::HenyeyGreenstein { g },
    };
    let mut world = World::stratified(Shape::Box { min_m, max_m }, [0.0; 3], &[]);
    world.bodies = Arc::new([Body { matter: [matter], field }]);
    world.lights = vec![Emitter::Beam { toward: DVec3::new(1.0, 2.0, 3.0).normalize(), irradiance: [1.0; 3] }];
    Ok(world)
}

fn picture(world: &World, width: usize, batches: u64, seed: u64) -> Vec<f64> {
    let pixel = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let budget = Budget { batches, walks_per_batch: WALKS_PER_BATCH, seed, stream: pixel as u64, first_batch: 0 };
        let batch = |batch: u64| {
            // Spread over the pixel as evenly as a golden-ratio sequence does.
            let inside = |step: f64, shift: f64| (batch as f64 * step + shift + seed as f64 * 0.381_966).fract();
            let across = (x as f64 + inside(0.754_877_666, 0.5)) / width as f64;
            let down = (y as f64 + inside(0.569_840_291, 0.5)) / width as f64;
            let position = DVec3::new(2.0 * across - 1.0, -2.0, 1.0 - 2.0 * down);
            View::new(world, position, DVec3::Y, FirstOrderBy::Walks).batch(&budget, batch).total()[0]
        };
        (0..batches).map(batch).sum::<f64>() / batches as f64
    };
    (0..width * width).into_par_iter().map(pixel).collect()
}
