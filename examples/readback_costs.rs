//! What waiting for a frame's pixels costs beside rendering the next one meanwhile; prints Markdown.
//!
//! `cargo run --release --example readback_costs -- SCENE...`
//!
//! The sun sinks a little with each frame, so that each is computed. Its pixels are turned into what files hold (radiance, transmittance,
//! distance and the picture) before the next frame begins (*waiting*), or by another thread while it is rendered (*pending*). Runs of
//! [`FRAMES`] frames of 1280 x 720 pixels at `medium` take turns; medians of milliseconds a frame that pass, with the least and most.

use std::path::PathBuf;
use std::time::Instant;

use welkin::gpu::DeviceRequest;
use welkin::plan::{Outputs, Quality, Settings};
use welkin::renderer::{Rendered, Renderer};
use welkin::report::Spread;
use welkin::scene::{Light, Scene};

const SIZE: [u32; 2] = [1280, 720];
const FRAMES: u32 = 10;
const ROUNDS: usize = 9;
const OUTPUTS: Outputs = Outputs { capture: true, picture: true };

fn main() -> anyhow::Result<()> {
    println!("| scene | waiting, ms a frame | pending, ms a frame | ratio |\n|---|---|---|---|");
    for path in std::env::args_os().skip(1).map(PathBuf::from) {
        let mut scene = Scene::read(&path)?;
        [scene.camera.width, scene.camera.height] = SIZE;
        let mut renderer = Renderer::new(&DeviceRequest::default())?;
        // Tables, and what the driver compiles.
        run(&mut renderer, &scene, false)?;
        let (mut waiting, mut pending, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            waiting.push(run(&mut renderer, &scene, false)?);
            pending.push(run(&mut renderer, &scene, true)?);
            ratios.extend(pending.last().zip(waiting.last()).map(|(b, a)| b / a));
        }
        let shown = |times: &[f64]| {
            let ends = times.iter().fold([f64::INFINITY, 0.0], |[least, most], &ms| [ms.min(least), ms.max(most)]);
            format!("{:.1} ({:.1} to {:.1})", Spread::of(times).median, ends[0], ends[1])
        };
        let ratio = Spread::of(&ratios).median;
        println!("| {} | {} | {} | {ratio:.3} |", scene.name, shown(&waiting), shown(&pending));
    }
    Ok(())
}

/// Milliseconds a frame of a run.
fn run(renderer: &mut Renderer, scene: &Scene, pending: bool) -> anyhow::Result<f64> {
    let start = Instant::now();
    std::thread::scope(|threads| -> anyhow::Result<()> {
        let mut reading: Option<std::thread::ScopedJoinHandle<anyhow::Result<Rendered>>> = None;
        for frame in 0..FRAMES {
            let pixels = renderer.render_next_pending(&at(scene, frame), Settings::of(Quality::Medium), OUTPUTS)?;
            if pending {
                finish(reading.take())?;
                reading = Some(threads.spawn(move || Ok(pixels.wait()?)));
            } else {
                pixels.wait()?;
            }
        }
        finish(reading)
    })?;
    Ok(1e3 * start.elapsed().as_secs_f64() / f64::from(FRAMES))
}

fn finish(reading: Option<std::thread::ScopedJoinHandle<anyhow::Result<Rendered>>>) -> anyhow::Result<()> {
    let Some(reading) = reading else { return Ok(()) };
    reading.join().map_err(|_| anyhow::anyhow!("the thread that reads a frame panicked"))??;
    Ok(())
}

/// The scene at a frame.
fn at(scene: &Scene, frame: u32) -> Scene {
    let mut scene = scene.clone();
    for light in &mut scene.lights {
        if let Light::Directional(light) = light {
            light.direction.elevation_rad -= 0.002 * f64::from(frame);
        }
    }
    scene
}
