//! `welkin bench`: what frames cost.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde::Serialize;
use welkin::bench::{
    Fit, FrameCase, FrameCost, Growth, Motion, PassCost, WorkCost, bake_cost, frame_costs, growth_of_frames,
    growth_of_reference, growth_of_tables, pass_costs, peak_memory_bytes, reference_cost, start,
};
use welkin::gpu::Gpu;
use welkin::passes::{RenderError, ShaderSources};
use welkin::plan::{NamedSettings, Quality, TableFormat, bake_settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

use super::backend::{announce, device_request, failure};
use super::{Failure, stdout};

/// Measure what frames of scenes cost, and each of their passes
///
/// Times are processor time of all threads, which on a machine that others keep busy says the most. Cases are measured in
/// turn, over and over. Frames stay on the device, as linear radiance.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene files
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Sizes of the picture, pixels; several with commas
    #[arg(long, value_name = "WxH", value_delimiter = ',', value_parser = size, default_value = "1280x720")]
    size: Vec<[u32; 2]>,
    /// Qualities: low, medium, high or ultra; several with commas. Also bevy-sizes, the sizes and samples of Bevy's
    /// atmosphere, and bevy-steps, with its quadrature and isotropic series too
    #[arg(long, value_name = "Q", value_delimiter = ',', default_value = "medium")]
    quality: Vec<NamedSettings>,
    /// What changes from frame to frame; several with commas
    #[arg(long, value_enum, value_delimiter = ',', default_value = "still,turn,sun,anew")]
    motion: Vec<Moves>,
    /// Measure each pass of the first frame as well
    #[arg(long)]
    passes: bool,
    /// Measure starts, tables for engines at quality low, and the reference as well
    #[arg(long)]
    work: bool,
    /// Measure how costs grow: tables with their texels, and the reference with its walks and cores; frames grow with their
    /// pixels where there are several sizes, also without this
    #[arg(long)]
    growth: bool,
    /// How often each case is measured
    #[arg(long, value_name = "N", default_value_t = 7)]
    rounds: u32,
    /// Frames of one measurement
    #[arg(long, value_name = "N", default_value_t = 4)]
    frames: u32,
    /// By how much pixels may differ from what they would be if each were evaluated for itself; 0 evaluates each
    #[arg(long, value_name = "SHARE")]
    lattice_tolerance: Option<f64>,
    /// Thousandths by which fog and volumes between marched pixels may differ from marched ones; 0 marches each
    #[arg(long, value_name = "PERMILLE")]
    media_lattice: Option<u32>,
    /// Keep tables as half floats
    #[arg(long)]
    half_tables: bool,
    /// Shaders from a folder, in place of the built-in ones
    #[arg(long, value_name = "DIR")]
    shaders: Option<PathBuf>,
    /// The device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// [`Motion`] as clap knows it.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Moves {
    /// Nothing
    Still,
    /// The camera turns
    Turn,
    /// The camera climbs
    Fly,
    /// The lights rise or set
    Sun,
    /// Everything is computed anew
    Anew,
}

impl Moves {
    fn motion(self) -> Motion {
        match self {
            Self::Still => Motion::Still,
            Self::Turn => Motion::Turn,
            Self::Fly => Motion::Fly,
            Self::Sun => Motion::Sun,
            Self::Anew => Motion::Anew,
        }
    }
}

/// All that was measured.
#[derive(Debug, Serialize)]
struct Measured {
    device: String,
    driver: String,
    frames: Vec<FrameCost>,
    passes: Vec<ScenePasses>,
    work: Vec<WorkCost>,
    growth: Vec<Growth>,
    peak_memory_bytes: Option<u64>,
}

#[derive(Debug, Serialize)]
struct ScenePasses {
    name: String,
    passes: Vec<PassCost>,
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides
        .filter(|sides| sides.iter().all(|side| (1..=16384).contains(side)))
        .ok_or_else(|| format!("'{text}' is no size of a picture; write width and height in pixels, as in 1280x720"))
}

/// Measures.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut cases = Vec::new();
    for path in &arguments.scenes {
        let scene = Scene::read(path)?;
        for (&[width, height], &named, motion) in combinations(arguments) {
            let mut scene = scene.clone();
            (scene.camera.width, scene.camera.height) = (width, height);
            let mut settings = named.settings();
            settings.lattice_tolerance = arguments.lattice_tolerance.unwrap_or(settings.lattice_tolerance);
            let volumes = &mut settings.volumes;
            volumes.lattice_permille = arguments.media_lattice.unwrap_or(volumes.lattice_permille);
            if arguments.half_tables {
                settings.table_format = TableFormat::Float16;
            }
            let name = format!("{}, {named}, {}", scene.name, motion.name());
            cases.push(FrameCase { name, scene, settings, motion, frames: arguments.frames });
        }
    }
    let gpu = Gpu::new(&device_request(arguments.device.as_deref())).map_err(RenderError::from).map_err(failure)?;
    announce(&gpu);
    let shaders = match &arguments.shaders {
        Some(folder) => ShaderSources::from_directory(folder).map_err(RenderError::from).map_err(failure)?,
        None => ShaderSources::embedded(),
    };
    let mut passes = Vec::new();
    if arguments.passes {
        for case in cases.iter().filter(|case| case.motion == arguments.motion[0].motion()) {
            let costs = pass_costs(&gpu, &shaders, &case.scene, case.settings, arguments.rounds).map_err(failure)?;
            passes.push(ScenePasses { name: case.name.clone(), passes: costs });
        }
    }
    let work = if arguments.work { work(arguments, &gpu)? } else { Vec::new() };
    let frames = frame_costs(&gpu, &shaders, cases, arguments.rounds).map_err(failure)?;
    let mut growth = growth_of_frames(&frames);
    if arguments.growth {
        for path in &arguments.scenes {
            let scene = Scene::read(path)?;
            for named in &arguments.quality {
                let tables = growth_of_tables(&gpu, &shaders, &scene, named.settings(), arguments.rounds);
                growth.extend(tables.map_err(failure)?);
            }
            growth.extend(growth_of_reference(&scene));
        }
    }
    let info = gpu.info();
    let (device, driver) = (info.name.clone(), format!("{} {}", info.driver, info.driver_version));
    let measured = Measured { device, driver, frames, passes, work, growth, peak_memory_bytes: peak_memory_bytes() };
    Ok(stdout::print(&if arguments.json { to_json(&measured) } else { to_markdown(&measured) })?)
}

fn combinations(arguments: &Arguments) -> impl Iterator<Item = (&[u32; 2], &NamedSettings, Motion)> {
    let with_quality = arguments.size.iter().flat_map(|size| arguments.quality.iter().map(move |q| (size, q)));
    with_quality.flat_map(|(size, quality)| arguments.motion.iter().map(move |m| (size, quality, m.motion())))
}

/// How costs grow with size.
fn growth_rows(all: &[Growth]) -> Vec<String> {
    let row = |growth: &Growth| {
        let (first, last) = (growth.points.first()?, growth.points.last()?);
        let Fit { exponent, bend } = growth.fit()?;
        let steps: Vec<_> = growth.steps().iter().map(|step| format!("{step:.2}")).collect();
        let bends = growth.bend().map_or("–".to_owned(), |size| format!("{size:.0}"));
        Some(format!(
            "| {}, by {} | {:.0}–{:.0} | {:.2}–{:.2} | {exponent:.2}, within {bend:.2} | {} | {bends} |",
            growth.name,
            growth.unit,
            first.0,
            last.0,
            first.1,
            last.1,
            steps.join(", "),
        ))
    };
    let heads =
        ["| what | sizes | ms | exponent, factor | from size to size | bends at |", "|---|---|---|---|---|---|"];
    let head = heads.into_iter().map(str::to_owned);
    if all.is_empty() {
        Vec::new()
    } else {
        std::iter::once(String::new()).chain(head).chain(all.iter().filter_map(row)).collect()
    }
}

/// Starts with an empty folder of pipelines and with a filled one, tables for engines, and the reference.
fn work(arguments: &Arguments, gpu: &Gpu) -> Result<Vec<WorkCost>, Failure> {
    let mut all = Vec::new();
    for path in &arguments.scenes {
        let (scene, settings) = (Scene::read(path)?, arguments.quality[0].settings());
        let folder = tempfile::tempdir()?;
        for name in ["cold start to the first frame", "warm start to the first frame"] {
            let start = start(arguments.device.as_deref(), Some(folder.path()), &scene, settings).map_err(failure)?;
            let (name, size) = (format!("{}: {name}", scene.name), 1.0);
            all.push(WorkCost { name, size, processor_ms: start.processor_ms, wall_ms: start.wall_ms });
        }
        let mut renderer = Renderer::on(gpu.clone()).map_err(failure)?;
        all.push(bake_cost(&mut renderer, &scene, &bake_settings(Quality::Low)).map_err(failure)?);
        for (walks, cores) in [(64, 1), (256, 1), (256, 2)] {
            all.push(reference_cost(&scene, walks, cores));
        }
    }
    Ok(all)
}

fn to_json(measured: &Measured) -> String {
    // Strings and numbers always have a JSON form.
    serde_json::to_string_pretty(measured).unwrap_or_default()
}

fn to_markdown(measured: &Measured) -> String {
    let mut lines = vec![format!("{} ({}).", measured.device, measured.driver), String::new()];
    for scene in &measured.passes {
        lines.extend([format!("{}:", scene.name), String::new()]);
        lines.extend(["| pass | ms | ± % | bytes |".to_owned(), "|---|---|---|---|".to_owned()]);
        lines.extend(scene.passes.iter().map(|pass| {
            let (ms, spread) = (pass.milliseconds.median(), 100.0 * pass.milliseconds.spread());
            format!("| {} | {ms:.2} | {spread:.0} | {} |", pass.name, pass.bytes)
        }));
        lines.push(String::new());
    }
    lines.extend(["| frame | processor ms | ± % | ns a pixel | bytes | passes that run |".to_owned()]);
    lines.push("|---|---|---|---|---|---|".to_owned());
    lines.extend(measured.frames.iter().map(|cost| {
        let (ms, spread) = (cost.processor_ms.median(), 100.0 * cost.processor_ms.spread());
        let ([width, height], per_pixel_ns) = (cost.size, 1e6 * ms / cost.pixels());
        let ran = if cost.ran.is_empty() { "none".to_owned() } else { cost.ran.join(", ") };
        let (name, bytes) = (&cost.name, cost.bytes);
        format!("| {name}, {width} x {height} | {ms:.2} | {spread:.0} | {per_pixel_ns:.1} | {bytes} | {ran} |")
    }));
    lines.extend(growth_rows(&measured.growth));
    if !measured.work.is_empty() {
        lines.extend([String::new(), "| work | size | processor ms | ms that passed |".to_owned()]);
        lines.push("|---|---|---|---|".to_owned());
        let line = |work: &WorkCost| {
            format!("| {} | {} | {:.0} | {:.0} |", work.name, work.size, work.processor_ms, work.wall_ms)
        };
        lines.extend(measured.work.iter().map(line));
    }
    if let Some(bytes) = measured.peak_memory_bytes {
        lines.extend([String::new(), format!("Peak memory of the process: {:.0} MiB.", bytes as f64 / 1048576.0)]);
    }
    lines.join("\n")
}
