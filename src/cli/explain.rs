//! `welkin explain`: the plan, and what each of its passes costs.

use std::path::PathBuf;

use clap::Args;
use welkin::plan::Outputs;
use welkin::renderer::{Renderer, Timings};
use welkin::scene::Scene;

use super::accuracy::Accuracy;
use super::backend::{failure, open_renderer};
use super::pass_table::Statistics;
use super::{Failure, stdout};

/// Say which passes a scene calls for, and why the others do not run
///
/// The scene is rendered once to measure what each pass costs. Without a Vulkan device the plan is the same, but
/// without times.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file
    scene: PathBuf,
    #[command(flatten)]
    accuracy: Accuracy,
    /// The device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Prints the plan.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::read(&arguments.scene)?;
    let (settings, quality) = (arguments.accuracy.settings(), arguments.accuracy.quality());
    let outputs = Outputs { capture: false, picture: true };
    let statistics = match open_renderer(arguments.device.as_deref()) {
        Ok(mut renderer) => {
            let timings = renderer.render(&scene, settings, outputs).map_err(failure)?.timings;
            Statistics::new(&scene.name, quality, Some(renderer.gpu().info()), &timings)
        }
        // A device that was asked for by name must be there.
        Err(Failure::NoDevice(error)) if arguments.device.is_none() => {
            eprintln!("note: nothing is measured: {error:#}");
            let timings = Timings::unmeasured(Renderer::plan(&scene, settings, outputs).map_err(failure)?);
            Statistics::new(&scene.name, quality, None, &timings)
        }
        Err(other) => return Err(other),
    };
    let text = if arguments.json { statistics.to_json() } else { statistics.to_text() };
    Ok(stdout::print(&text)?)
}
