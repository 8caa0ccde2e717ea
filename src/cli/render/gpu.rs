//! Rendering in real time.

use welkin::plan::{Outputs, Settings};
use welkin::scene::Scene;

use super::{Arguments, Rendered};
use crate::cli::Failure;
use crate::cli::backend::{failure, open_renderer};
use crate::cli::pass_table::Statistics;

pub fn render(arguments: &Arguments, scene: &Scene, outputs: Outputs) -> Result<Rendered, Failure> {
    let quality = arguments.quality.unwrap_or_default();
    let mut renderer = open_renderer(arguments.device.as_deref())?;
    let rendered = renderer.render(scene, Settings::of(quality), outputs).map_err(failure)?;
    let statistics = Statistics::new(&scene.name, quality, Some(renderer.gpu().info()), &rendered.timings);
    Ok(Rendered {
        frame: rendered.frame,
        picture: rendered.picture.unwrap_or_default(),
        text: statistics.to_text(),
        json: statistics.to_json(),
    })
}
