//! `welkin render`: what the scene's camera sees.

use std::path::{Path, PathBuf};

use clap::Args;
use welkin::output::{AtomicFile, write_exr, write_png};
use welkin::plan::{Outputs, Quality, Settings};
use welkin::renderer::Rendered;
use welkin::scene::Scene;

use super::backend::{failure, open_renderer};
use super::pass_table::Statistics;
use super::{Failure, stdout};

/// Render a scene to pictures
///
/// Prints what became of each pass: its time, or why it did not run.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// A picture to write: linear radiance as .exr, what a screen shows as .png; may be given several times
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// How accurate: low, medium, high or ultra
    #[arg(long, value_name = "Q", default_value_t)]
    quality: Quality,
    /// The device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Write what became of each pass to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// What a file's name asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Exr,
    Png,
}

/// Renders, and writes what was asked for.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::read(&arguments.scene)?;
    let formats = arguments.output.iter().map(|path| format_of(path)).collect::<Result<Vec<_>, _>>()?;
    // Opened first: a place that cannot be written is said before time is spent.
    let files = arguments.output.iter().map(|path| AtomicFile::create(path)).collect::<Result<Vec<_>, _>>()?;
    let statistics_file = arguments.json.as_deref().map(AtomicFile::create).transpose()?;
    let mut renderer = open_renderer(arguments.device.as_deref())?;
    let outputs = Outputs { capture: formats.contains(&Format::Exr), picture: formats.contains(&Format::Png) };
    let rendered = renderer.render(&scene, Settings::of(arguments.quality), outputs).map_err(failure)?;
    for (file, format) in files.into_iter().zip(formats) {
        write(file, format, &rendered, &scene)?;
    }
    let device = renderer.gpu().info();
    let statistics = Statistics::new(&scene.name, arguments.quality, Some(device), &rendered.timings);
    if let Some(file) = statistics_file {
        file.write_all(format!("{}\n", statistics.to_json()).as_bytes())?;
    }
    Ok(stdout::print(&statistics.to_text())?)
}

fn format_of(path: &Path) -> Result<Format, Failure> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("exr") => Ok(Format::Exr),
        Some("png") => Ok(Format::Png),
        _ => Err(Failure::Input(anyhow::anyhow!("output '{}' must end in .exr or .png", path.display()))),
    }
}

fn write(file: AtomicFile, format: Format, rendered: &Rendered, scene: &Scene) -> Result<(), Failure> {
    let frame = &rendered.frame;
    match format {
        Format::Exr => Ok(write_exr(file, frame, scene)?),
        // Asked for above, so that it is there.
        Format::Png => Ok(write_png(file, frame.width, frame.height, rendered.picture.as_deref().unwrap_or_default())?),
    }
}
