//! What froxels for what an engine draws with light passing through add to its frames; prints Markdown.
//!
//! `cargo run --release --example froxel_costs -- SCENE...`
//!
//! A camera turns a little with each frame; frames with and without froxels take turns, each from the beginning of its commands to its
//! end on the device. Medians of milliseconds that pass, of frames of 1280 x 720 pixels and froxels of 80 x 45 x 32 and 160 x 90 x 32, at `medium`.

#[path = "vulkan_host/engine.rs"]
#[allow(dead_code)]
mod engine;
#[path = "vulkan_host/frames.rs"]
#[allow(dead_code)]
mod frames;
#[path = "vulkan_host/glass.rs"]
#[allow(dead_code)]
mod glass;
#[path = "vulkan_host/images.rs"]
mod images;

use std::path::PathBuf;
use std::time::Instant;

use ash::vk;
use engine::Engine;
use glass::Froxels;
use welkin::gpu::HostUse;
use welkin::plan::{FroxelGrid, Quality, Settings};
use welkin::renderer::{HostFrame, Renderer};
use welkin::scene::Scene;

const SIZE: [u32; 2] = [1280, 720];
const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const ROUNDS: usize = 5;

fn main() -> anyhow::Result<()> {
    println!("| scene | frame, ms | with 80 x 45 x 32 froxels | with 160 x 90 x 32 |\n|---|---|---|---|");
    for path in std::env::args_os().skip(1).map(PathBuf::from) {
        let mut scene = Scene::read(&path)?;
        [scene.camera.width, scene.camera.height] = SIZE;
        let milliseconds = measure(&scene)?;
        let [without, coarse, fine] = milliseconds.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        });
        println!("| {} | {without:.0} | {coarse:.0} | {fine:.0} |", scene.name);
    }
    Ok(())
}

/// Milliseconds of frames without froxels, with few and with many.
fn measure(scene: &Scene) -> anyhow::Result<[Vec<f64>; 3]> {
    let engine = Engine::new(SIZE, FORMAT, false)?;
    let gpu = frames::open(&engine)?;
    let sizes = [[80, 45, 32], [160, 90, 32]].map(|size| FroxelGrid { size, near_m: 100.0, far_m: 50_000.0 });
    let froxels = [Froxels::of_grid(&engine, FORMAT, sizes[0])?, Froxels::of_grid(&engine, FORMAT, sizes[1])?];
    let without = frames::frame(&engine, &gpu, 1.0)?;
    let with = |index: usize| -> anyhow::Result<HostFrame> {
        Ok(HostFrame { froxels: Some(froxels[index].for_welkin(&gpu)?), ..without.clone() })
    };
    let ways = [without.clone(), with(0)?, with(1)?];
    // A renderer each, so that none of them makes what another has just made.
    let mut renderers = [Renderer::on(gpu.clone())?, Renderer::on(gpu.clone())?, Renderer::on(gpu)?];
    let mut milliseconds = [const { Vec::new() }; 3];
    let mut left = [HostUse::default(); 2];
    // The first frames make tables and compile.
    for round in 0..ROUNDS + 2 {
        let mut turned = scene.clone();
        turned.camera.direction.azimuth_rad += 0.01 * round as f64;
        for ((way, renderer), times) in ways.iter().zip(&mut renderers).zip(&mut milliseconds) {
            let start = Instant::now();
            let settings = Settings::of(Quality::Medium);
            let recorded = frames::record(&engine, &engine.slots[0], renderer, &turned, settings, way, &mut left)?;
            engine.submit(&engine.slots[0])?;
            engine.finish()?;
            drop(recorded);
            if round >= 2 {
                times.push(1e3 * start.elapsed().as_secs_f64());
            }
        }
    }
    drop((renderers, ways, without));
    froxels.iter().for_each(|froxels| froxels.destroy(&engine));
    engine.close().iter().for_each(|message| eprintln!("{message}"));
    Ok(milliseconds)
}
