//! `welkin explain`: the plan, and what each of its passes costs.

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use welkin::plan::{Outputs, Settings};
use welkin::renderer::{Price, Renderer, Timings, prices};
use welkin::scene::Scene;

use super::accuracy::Accuracy;
use super::backend::{failure, open_renderer};
use super::goal::GoalArguments;
use super::pass_table::Statistics;
use super::{Failure, stdout};

/// Say which passes a scene calls for, and why the others do not run
///
/// The scene is rendered once to measure what each pass costs, and then with clouds, with mountains, with airglow and by
/// other treatments of multiple scattering, to measure what skipped passes would cost. Without a Vulkan device the plan is
/// the same, but without times.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file
    scene: PathBuf,
    #[command(flatten)]
    accuracy: Accuracy,
    #[command(flatten)]
    goal: GoalArguments,
    /// The device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Leave out what skipped passes would cost
    #[arg(long)]
    no_prices: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What is asked of the renderer: a picture to look at.
const OUTPUTS: Outputs = Outputs { capture: false, picture: true };

/// Prints the plan.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::read(&arguments.scene)?;
    let choose =
        |renderer: Option<&mut Renderer>| arguments.goal.settings(&arguments.accuracy, &scene, OUTPUTS, renderer);
    let statistics = match open_renderer(arguments.device.as_deref()) {
        Ok(mut renderer) => {
            let chosen = choose(Some(&mut renderer))?;
            let timings = renderer.render(&scene, chosen.settings, OUTPUTS).map_err(failure)?.timings;
            let prices = price(arguments, Some(&mut renderer), &scene, chosen.settings, &timings)?;
            Statistics::new(&scene.name, chosen, Some(renderer.gpu().info()), &timings).with_prices(&prices)
        }
        // A device that was asked for by name must be there.
        Err(Failure::NoDevice(error)) if arguments.device.is_none() => {
            eprintln!("note: nothing is measured: {error:#}");
            let chosen = choose(None)?;
            let timings = Timings::unmeasured(Renderer::plan(&scene, chosen.settings, OUTPUTS).map_err(failure)?);
            let prices = price(arguments, None, &scene, chosen.settings, &timings)?;
            Statistics::new(&scene.name, chosen, None, &timings).with_prices(&prices)
        }
        Err(other) => return Err(other),
    };
    let text = if arguments.json { statistics.to_json() } else { statistics.to_text() };
    Ok(stdout::print(&text)?)
}

fn price(
    arguments: &Arguments,
    renderer: Option<&mut Renderer>,
    scene: &Scene,
    settings: Settings,
    timings: &Timings,
) -> Result<BTreeMap<&'static str, Price>, Failure> {
    if arguments.no_prices {
        return Ok(BTreeMap::new());
    }
    prices(renderer, scene, settings, OUTPUTS, &timings.plan).map_err(failure)
}
