//! An engine of its own that has welkin draw its sky: `engine.rs` makes the device, the images and the command buffers, as
//! any engine on Vulkan does, `frames.rs` is what it takes to embed the renderer, and `glass.rs` draws what light passes
//! through, in the light of the air before it.
//!
//! `cargo run --release --example vulkan_host -- scenes/noon.toml out.png`

mod engine;
mod frames;
mod glass;
mod images;

use std::path::PathBuf;

use anyhow::{Context as _, bail};
use ash::vk;
use welkin::frame::Frame;
use welkin::output::display;
use welkin::plan::{Quality, Settings};
use welkin::scene::Scene;

use engine::Engine;
use glass::{Froxels, PANES};

fn main() -> anyhow::Result<()> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [scene, picture] = arguments.as_slice() else { bail!("usage: vulkan_host SCENE PICTURE.png") };
    let scene = Scene::read(scene)?;
    let size = [scene.camera.width, scene.camera.height];
    let engine = Engine::new(size, vk::Format::R16G16B16A16_SFLOAT, false)?;
    let froxels = Froxels::new(&engine, vk::Format::R16G16B16A16_SFLOAT)?;
    let scenes = std::slice::from_ref(&scene);
    let mut drawn = frames::render(&engine, Some(&froxels), scenes, Settings::of(Quality::Medium), 1.0)?.remove(0);
    let [radiance, _] = froxels.read(&engine)?;
    glass::draw(&engine, &mut drawn, &PANES, &froxels.grid, &radiance);
    let mut frame = Frame::new(size[0], size[1]);
    frame.radiance = drawn.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    let bytes = display::picture(&frame, display::exposed_bands(&scene), scene.display.tone_map);
    froxels.destroy(&engine);
    for message in engine.close() {
        eprintln!("{message}");
    }
    image::save_buffer(picture, &bytes, size[0], size[1], image::ColorType::Rgb8)
        .with_context(|| format!("cannot write '{}'", picture.display()))
}
