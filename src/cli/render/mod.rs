//! `welkin render`: what the scene's camera sees.

mod frames;
mod gpu;
mod reference;

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread::{self, ScopedJoinHandle};

use clap::Args;
use welkin::frame::Frame;
use welkin::output::{AtomicFile, write_exr, write_png};
use welkin::plan::Outputs;
use welkin::scene::Scene;

use frames::{Frames, numbered};
use gpu::FrameAhead;

use super::accuracy::Accuracy;
use super::backend::{Backend, failure};
use super::goal::GoalArguments;
use super::limit::positive;
use super::spectrum::SpectrumArguments;
use super::{Failure, stdout};

/// Render a scene to pictures
///
/// Prints what became of each pass: its time, or why it did not run.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file
    scene: PathBuf,
    #[command(flatten)]
    spectrum: SpectrumArguments,
    /// A picture to write: linear radiance or colour as .exr, what a screen shows as .png; may be given several times
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// What computes light
    #[arg(long, value_enum, default_value = "gpu")]
    backend: Backend,
    #[command(flatten)]
    accuracy: Accuracy,
    /// Render frames A to B - 1, each 1/frame-rate s after the one before: clouds drift, and of a frame's clouds only some
    /// pixels are computed anew. A frame's number stands for # in the outputs' names, or before their endings; gpu backend
    #[arg(long, value_name = "A..B", conflicts_with = "depth")]
    frames: Option<Frames>,
    /// Frames in a second of the scene's time
    #[arg(long, value_name = "N", default_value = "24", requires = "frames", value_parser = positive)]
    frame_rate: f64,
    #[command(flatten)]
    goal: GoalArguments,
    /// The gpu backend's device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Walks of the reference backend for each pixel [default: 256]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..))]
    samples: Option<u64>,
    /// Surfaces of another renderer, before which the air is drawn: an EXR file with the distance along each pixel's ray
    /// in metres (channel distance_m, Z, depth, Y or R), infinite where the sky is; gpu backend
    #[arg(long, value_name = "EXR")]
    depth: Option<PathBuf>,
    /// The depth is measured along the camera's axis instead of the pixel's ray
    #[arg(long, requires = "depth")]
    planar_depth: bool,
    /// Radiance of those surfaces, an EXR file with R, G and B in W/(m2 sr nm); without it they are black
    #[arg(long, value_name = "EXR", requires = "depth")]
    colour: Option<PathBuf>,
    /// Write what was computed, and how long it took, to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// What a backend brings back.
struct Rendered {
    frame: Frame,
    /// sRGB bytes, if a PNG was asked for.
    picture: Option<Vec<u8>>,
    /// What was computed, for people and for programs.
    text: String,
    json: String,
}

/// What a file's name asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Exr,
    Png,
}

/// Renders, and writes what was asked for.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let goal = arguments.goal.given().map(|(option, given)| (option, Backend::Gpu, given));
    arguments.backend.check_options(&goal)?;
    arguments.backend.check_options(&[
        ("--quality", Backend::Gpu, arguments.accuracy.quality.is_some()),
        ("--multiple-scattering", Backend::Gpu, arguments.accuracy.multiple_scattering.is_some()),
        ("--device", Backend::Gpu, arguments.device.is_some()),
        ("--frames", Backend::Gpu, arguments.frames.is_some()),
        ("--depth", Backend::Gpu, arguments.depth.is_some()),
        ("--samples", Backend::Reference, arguments.samples.is_some()),
    ])?;
    let scene = Scene::read_with(&arguments.scene, arguments.spectrum.request())?;
    let formats = arguments.output.iter().map(|path| format_of(path)).collect::<Result<Vec<_>, _>>()?;
    let outputs = Outputs { capture: formats.contains(&Format::Exr), picture: formats.contains(&Format::Png) };
    if let Some(frames) = &arguments.frames {
        return run_frames(arguments, &scene, &formats, outputs, frames);
    }
    // Opened first: a place that cannot be written is said before time is spent.
    let files = arguments.output.iter().map(|path| AtomicFile::create(path)).collect::<Result<Vec<_>, _>>()?;
    let json_file = arguments.json.as_deref().map(AtomicFile::create).transpose()?;
    let rendered = match arguments.backend {
        Backend::Gpu => gpu::render(arguments, &scene, outputs)?,
        Backend::Reference => reference::render(arguments, &scene, outputs)?,
    };
    write_pictures(files, &formats, &rendered.frame, rendered.picture.as_deref(), &scene)?;
    if let Some(file) = json_file {
        file.write_all(format!("{}\n", rendered.json).as_bytes())?;
    }
    Ok(stdout::print(&rendered.text)?)
}

/// Renders frame after frame; the pixels of each come, and are written, while the next is rendered. What they took is one list in
/// the JSON file.
fn run_frames(
    arguments: &Arguments,
    scene: &Scene,
    formats: &[Format],
    outputs: Outputs,
    frames: &Frames,
) -> Result<(), Failure> {
    let json_file = arguments.json.as_deref().map(AtomicFile::create).transpose()?;
    let mut all = Vec::new();
    thread::scope(|threads| {
        let mut writing = None;
        gpu::render_frames(arguments, scene, outputs, frames, |frame| {
            written(writing.take())?;
            let FrameAhead { number, scene, pixels, statistics } = frame;
            let paths = arguments.output.iter().map(|path| numbered(path, number));
            let files = paths.map(|path| AtomicFile::create(&path)).collect::<Result<Vec<_>, _>>()?;
            all.push(statistics.to_json());
            stdout::print(&statistics.to_text())?;
            writing = Some(threads.spawn(move || {
                let rendered = pixels.wait().map_err(failure)?;
                write_pictures(files, formats, &rendered.frame, rendered.picture.as_deref(), &scene)
            }));
            Ok(())
        })?;
        written(writing)
    })?;
    match json_file {
        Some(file) => Ok(file.write_all(format!("[\n{}\n]\n", all.join(",\n")).as_bytes())?),
        None => Ok(()),
    }
}

/// Waits until a frame's files are there.
fn written(writing: Option<ScopedJoinHandle<Result<(), Failure>>>) -> Result<(), Failure> {
    writing.map_or(Ok(()), |writing| writing.join().unwrap_or_else(|panic| resume_unwind(panic)))
}

fn write_pictures(
    files: Vec<AtomicFile>,
    formats: &[Format],
    frame: &Frame,
    picture: Option<&[u8]>,
    scene: &Scene,
) -> Result<(), Failure> {
    for (file, format) in files.into_iter().zip(formats) {
        match format {
            Format::Exr => write_exr(file, frame, scene)?,
            Format::Png => write_png(file, frame.width, frame.height, picture.unwrap_or_default())?,
        }
    }
    Ok(())
}

fn format_of(path: &Path) -> Result<Format, Failure> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("exr") => Ok(Format::Exr),
        Some("png") => Ok(Format::Png),
        _ => Err(Failure::Input(anyhow::anyhow!("output '{}' must end in .exr or .png", path.display()))),
    }
}
