//! `welkin report`: what accuracy costs in time.

mod machine;
mod measure;
mod progress;

use std::path::{Path, PathBuf};

use clap::Args;
use welkin::output::AtomicFile;
use welkin::plan::{Quality, Rung, SceneKind, SceneTraits};
use welkin::report::{
    self, Breadth, Case, ReportError, Request, Study, file_name, markdown, page, passes_csv, plot, points_csv,
    random_scene, results_schema, slab_plot,
};
use welkin::scene::Scene;

use super::Failure;
use super::backend::{cache_folder, open_renderer};
use super::limit::positive;
use measure::Device;
use progress::Progress;

/// Measure errors and times of all settings on a folder of scenes
///
/// Every scene is rendered with every setting that trades accuracy for time, from nothing, several times, and compared with
/// the path tracer along a grid of pixels. Writes report.html (one page that holds everything), report.json with its schema,
/// report.csv, passes.csv, and docs/ with a short page and its plots. References are kept and continued; what has been
/// measured is kept in the folder, so that the same command goes on after an interruption.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of scene files, whose subfolders are not read; may be given several times
    #[arg(long, value_name = "DIR", default_value = "scenes")]
    scenes: Vec<PathBuf>,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Fewer settings, fewer walks, one repetition
    #[arg(long)]
    quick: bool,
    /// Scenes drawn at random beside those of the folder, from which errors of other scenes are learned
    #[arg(long, value_name = "N", default_value_t = 0)]
    random: u64,
    /// How often each picture is rendered [default: 5, with --quick 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: Option<u32>,
    /// The dearest settings to measure [default: ultra, with --quick high]
    #[arg(long, value_name = "Q")]
    dearest: Option<Quality>,
    /// Most walks of the path tracer for each pixel of a reference; a sixteenth of it through clouds [default: 32768, with
    /// --quick 4096]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(256..))]
    walks: Option<u64>,
    /// Relative standard error of a reference (root mean square over its pixels) at which it needs no more walks, as in 0.01
    #[arg(long, value_name = "E", value_parser = positive)]
    truth_error: Option<f64>,
    /// Folder in which references are kept [default: the platform's for what can be made again]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Also write what settings for an error or a time are chosen from (src/goal/measured_front.json) to a file
    #[arg(long, value_name = "JSON")]
    learn: Option<PathBuf>,
    /// The device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
}

/// Measures and writes.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let pictures = arguments.out.join("pictures");
    let images = arguments.out.join("docs").join("images");
    for folder in [&pictures, &images] {
        std::fs::create_dir_all(folder).map_err(|source| {
            Failure::Input(anyhow::Error::new(source).context(format!("cannot make the folder '{}'", folder.display())))
        })?;
    }
    let cases = cases(arguments)?;
    let renderer = open_renderer(arguments.device.as_deref())?;
    let provenance = machine::provenance(renderer.gpu().info());
    let cache = match &arguments.cache {
        Some(folder) => folder.clone(),
        None => cache_folder().ok_or_else(no_cache)?.join("references"),
    };
    let repeats = arguments.repeats.unwrap_or(if arguments.quick { 1 } else { 5 });
    let (ledger, program) = (arguments.out.join("measured.jsonl"), machine::program()?);
    let slab_walks: &[u64] = if arguments.quick { &[1_000, 10_000] } else { &[1_000, 10_000, 100_000, 1_000_000] };
    let request = Request { cases, slab_walks, repeats, cache, ledger, program, provenance };
    let progress = Progress::new(pictures.clone())?;
    let study = report::study(&request, &mut Device(renderer), &progress).map_err(failure)?;
    progress.finish();
    write(&study, arguments, &pictures, &images)?;
    eprintln!("written: {}", arguments.out.join("report.html").display());
    Ok(())
}

/// Scenes of the folder, and random ones.
fn cases(arguments: &Arguments) -> Result<Vec<Case>, Failure> {
    let mut scenes = Vec::new();
    for folder in &arguments.scenes {
        for path in scene_files(folder)? {
            scenes.push((Scene::read(&path)?, false));
        }
    }
    for number in 1..=arguments.random {
        scenes.push((random_scene(number)?, true));
    }
    if let Some(twice) =
        (1..scenes.len()).find(|&i| scenes[..i].iter().any(|(other, _)| other.name == scenes[i].0.name))
    {
        let name = &scenes[twice].0.name;
        return Err(Failure::Input(anyhow::anyhow!("two scenes are called '{name}'; give one another `name`")));
    }
    let dearest = arguments.dearest.unwrap_or(if arguments.quick { Quality::High } else { Quality::Ultra });
    let vary: &[Quality] = if arguments.quick { &[] } else { &[Quality::Low, Quality::Medium, Quality::High] };
    let walks = arguments.walks.unwrap_or(if arguments.quick { 4096 } else { 32768 });
    let case = |(scene, random): (Scene, bool)| {
        let clouds = SceneTraits::of(&scene).kind == SceneKind::Clouds;
        Case {
            walks: if clouds { walks / 16 } else { walks },
            truth_error: arguments.truth_error,
            breadth: Breadth { dearest: Rung::of(dearest), vary: if random { &[] } else { vary } },
            solver_walks: if random { &[] } else { &[4, 16, 64] },
            scene,
            random,
        }
    };
    Ok(scenes.into_iter().map(case).collect())
}

/// The scene files of a folder, by name.
fn scene_files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let cannot = |source: std::io::Error| {
        Failure::Input(anyhow::Error::new(source).context(format!("cannot read the folder '{}'", folder.display())))
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        if path.is_file() && path.extension().is_some_and(|ending| ending == "toml") {
            paths.push(path);
        }
    }
    paths.sort();
    if paths.is_empty() {
        let folder = folder.display();
        return Err(Failure::Input(anyhow::anyhow!("there is no scene file (.toml) in the folder '{folder}'")));
    }
    Ok(paths)
}

fn write(study: &Study, arguments: &Arguments, pictures: &Path, images: &Path) -> Result<(), Failure> {
    let out = &arguments.out;
    let file = |name: &str, bytes: &[u8]| AtomicFile::create(&out.join(name))?.write_all(bytes);
    for scene in study.scenes.iter().filter(|scene| !scene.random) {
        let svg = plot(scene).map_err(failure)?;
        AtomicFile::create(&images.join(format!("cost-{}.svg", file_name(&scene.scene))))?.write_all(svg.as_bytes())?;
    }
    let svg = slab_plot(&study.slabs).map_err(failure)?;
    AtomicFile::create(&images.join("cost-slabs.svg"))?.write_all(svg.as_bytes())?;
    file("report.json", format!("{:#}\n", serde_json::to_value(study)?).as_bytes())?;
    file("report.schema.json", format!("{:#}\n", results_schema()).as_bytes())?;
    file("report.csv", &points_csv(study).map_err(failure)?)?;
    file("passes.csv", &passes_csv(study).map_err(failure)?)?;
    file("docs/cost.md", markdown(study, &machine::command_line()).as_bytes())?;
    if let Some(path) = &arguments.learn {
        AtomicFile::create(path)?
            .write_all(format!("{}\n", serde_json::to_string(&report::learn(study))?).as_bytes())?;
    }
    // Last: who sees the page finds all that it was made from.
    Ok(file("report.html", page(study, pictures).map_err(failure)?.as_bytes())?)
}

fn no_cache() -> Failure {
    Failure::Input(anyhow::anyhow!("there is no folder for what can be made again; name one with --cache"))
}

fn failure(error: ReportError) -> Failure {
    match error {
        ReportError::Interrupted => Failure::Paused,
        other => Failure::Input(other.into()),
    }
}
