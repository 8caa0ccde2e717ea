//! Rendering in real time.

use std::path::Path;

use welkin::foreground::{Depth, Foreground};
use welkin::output::{DEPTH_CHANNELS, read_exr, read_exr_channel};
use welkin::plan::Outputs;
use welkin::renderer::PendingFrame;
use welkin::scene::{Camera, Scene};

use super::frames::Frames;
use super::{Arguments, Rendered};
use crate::cli::Failure;
use crate::cli::backend::{failure, open_renderer};
use crate::cli::pass_table::Statistics;

pub fn render(arguments: &Arguments, scene: &Scene, outputs: Outputs) -> Result<Rendered, Failure> {
    let foreground = read_foreground(arguments, &scene.camera)?;
    let mut renderer = open_renderer(arguments.device.as_deref())?;
    let chosen = arguments.goal.settings(&arguments.accuracy, scene, outputs, Some(&mut renderer))?;
    let settings = chosen.settings;
    let rendered = match &foreground {
        Some(foreground) => renderer.render_over(scene, settings, outputs, foreground),
        None => renderer.render(scene, settings, outputs),
    };
    let rendered = rendered.map_err(failure)?;
    let statistics = Statistics::new(&scene.name, chosen, Some(renderer.gpu().info()), &rendered.timings);
    Ok(Rendered {
        frame: rendered.frame,
        picture: rendered.picture,
        text: statistics.to_text(),
        json: statistics.to_json(),
    })
}

/// A frame of several, whose pixels are on their way.
pub struct FrameAhead {
    pub number: u32,
    pub scene: Scene,
    pub pixels: PendingFrame,
    pub statistics: Statistics,
}

/// Renders frames one after the other and hands each over before its pixels are there.
pub fn render_frames(
    arguments: &Arguments,
    scene: &Scene,
    outputs: Outputs,
    Frames(numbers): &Frames,
    mut finish: impl FnMut(FrameAhead) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut renderer = open_renderer(arguments.device.as_deref())?;
    let chosen = arguments.goal.settings(&arguments.accuracy, scene, outputs, Some(&mut renderer))?;
    for number in numbers.clone() {
        let scene = Frames::scene_at(scene, number, arguments.frame_rate);
        let pixels = renderer.render_next_pending(&scene, chosen.settings, outputs).map_err(failure)?;
        let name = format!("{}, frame {number}", scene.name);
        let statistics = Statistics::new(&name, chosen.clone(), Some(renderer.gpu().info()), pixels.timings());
        finish(FrameAhead { number, scene, pixels, statistics })?;
    }
    Ok(())
}

/// What stands before the camera, if the user names it.
fn read_foreground(arguments: &Arguments, camera: &Camera) -> Result<Option<Foreground>, Failure> {
    let Some(path) = &arguments.depth else { return Ok(None) };
    let plane = read_exr_channel(path, &DEPTH_CHANNELS)?;
    let check = |path: &Path, (width, height): (u32, u32)| match (width, height) == (camera.width, camera.height) {
        true => Ok(()),
        false => Err(Failure::Input(anyhow::anyhow!(
            "'{}' has {width} x {height} pixels; the scene's camera has {} x {}",
            path.display(),
            camera.width,
            camera.height
        ))),
    };
    check(path, (plane.width, plane.height))?;
    let colour = arguments.colour.as_deref().map(|path| {
        let frame = read_exr(path)?;
        check(path, (frame.width, frame.height)).map(|()| frame.radiance)
    });
    let depth = if arguments.planar_depth { Depth::Planar } else { Depth::Distance };
    let foreground = Foreground::new(camera, depth, &plane.values, colour.transpose()?.as_deref());
    foreground.map(Some).map_err(|error| Failure::Input(error.into()))
}
