//! Embedding the renderer: what an engine adds to its frames for a sky.

use ash::vk;
use welkin::gpu::{Gpu, HostCommands, HostDevice, HostImage, HostRecorded, HostUse};
use welkin::plan::Settings;
use welkin::renderer::{DepthBuffer, HostDepth, HostFrame, HostedFrame, Renderer};
use welkin::scene::Scene;

use super::engine::{COPIED_COLOUR, DRAWN_COLOUR, DRAWN_DEPTH, Engine, NEAR_M, Slot};
use super::glass::Froxels;

/// Opens welkin on the engine's device.
pub fn open(engine: &Engine) -> anyhow::Result<Gpu> {
    let host = HostDevice {
        instance: engine.instance.clone(),
        api_version: vk::API_VERSION_1_3,
        physical_device: engine.physical_device,
        device: engine.device.clone(),
        queue_family: engine.queue_family,
        features: engine.features,
        debug_utils: false,
        pipeline_cache: None,
    };
    // SAFETY: the handles are the engine's, which closes its device last.
    Ok(unsafe { Gpu::on_host(host) }?)
}

/// The engine's images as welkin knows them. They are made once, and anew when the engine makes its images anew.
pub fn frame(engine: &Engine, gpu: &Gpu, units_per_radiance: f64) -> anyhow::Result<HostFrame> {
    let Engine { colour, depth, size, .. } = engine;
    // SAFETY: the images are the engine's, which destroys them when all frames are done and welkin is gone.
    let (colour, depth) = unsafe {
        (
            gpu.host_image("colour", colour.raw, colour.format, *size)?,
            gpu.host_image("depth", depth.raw, depth.format, *size)?,
        )
    };
    Ok(HostFrame {
        colour: HostImage { image: colour, before: DRAWN_COLOUR, after: Some(COPIED_COLOUR) },
        depth: Some(HostDepth {
            // What the engine does with its depth next, it knows itself.
            image: HostImage { image: depth, before: DRAWN_DEPTH, after: None },
            buffer: DepthBuffer::Perspective { near_m: NEAR_M, far_m: f64::INFINITY, reversed: true },
        }),
        froxels: None,
        units_per_radiance,
    })
}

/// Records a frame: the engine's walls, then the sky. `left` is how the frame before has left colour and depth.
pub fn record(
    engine: &Engine,
    slot: &Slot,
    renderer: &mut Renderer,
    scene: &Scene,
    settings: Settings,
    frame: &HostFrame,
    left: &mut [HostUse; 2],
) -> anyhow::Result<HostedFrame> {
    engine.begin(slot)?;
    engine.draw_walls(slot, *left);
    // SAFETY: the command buffer is being recorded outside of a rendering; frames are submitted in order, to one queue, or
    // given up; what is returned is dropped after the slot's fence.
    let commands = unsafe { HostCommands::new(slot.commands) };
    let hosted = renderer.record_frame(commands, scene, settings, frame)?;
    *left = [hosted.left.colour, hosted.left.depth.unwrap_or_default()];
    Ok(hosted)
}

/// Renders a frame for each scene, two of them in flight, and returns the pictures. Froxels hold what the last of them has found.
pub fn render(
    engine: &Engine,
    froxels: Option<&Froxels>,
    scenes: &[Scene],
    settings: Settings,
    units_per_radiance: f64,
) -> anyhow::Result<Vec<Vec<[f32; 4]>>> {
    let gpu = open(engine)?;
    let images = froxels.map(|froxels| froxels.for_welkin(&gpu)).transpose()?;
    let frame = HostFrame { froxels: images, ..frame(engine, &gpu, units_per_radiance)? };
    let mut renderer = Renderer::on(gpu)?;
    let mut left = [HostUse::default(); 2];
    let mut in_flight: [Option<HostRecorded>; 2] = [None, None];
    let mut pictures = Vec::new();
    for (index, scene) in scenes.iter().enumerate() {
        let slot = &engine.slots[index % 2];
        // The slot's frame before: once its picture is there, the device has done it.
        if in_flight[index % 2].is_some() {
            pictures.push(engine.picture(slot)?);
            in_flight[index % 2] = None;
        }
        in_flight[index % 2] = Some(record(engine, slot, &mut renderer, scene, settings, &frame, &mut left)?.recorded);
        if let Some(froxels) = froxels {
            froxels.copy(engine, slot);
        }
        engine.submit(slot)?;
    }
    // The renderer may go before its frames are done; what they need lives on in them.
    drop((renderer, frame));
    for index in pictures.len()..scenes.len() {
        pictures.push(engine.picture(&engine.slots[index % 2])?);
    }
    engine.finish()?;
    Ok(pictures)
}
