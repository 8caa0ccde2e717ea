//! `welkin reference`: a picture on the CPU, with its standard error.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::limit::relative_error;
use super::solver::{SolverArguments, check_sampling};
use super::spectrum::SpectrumArguments;
use super::watch::{Checkpoint, Watch};
use super::{Failure, exr_output};
use welkin::output::{AtomicFile, ExrHeader};
use welkin::reference::Solver;
use welkin::reference::picture::{
    self, CameraView, Film, Identity, Outcome, Part, Sampling, Shard, expose, write_part,
};
use welkin::scene::Scene;

/// Trace a picture of a scene on the CPU, with the standard error of every pixel
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file
    scene: PathBuf,
    #[command(flatten)]
    spectrum: SpectrumArguments,
    /// Picture to write, an EXR file
    #[arg(short, long, value_name = "FILE", value_parser = exr_output)]
    output: PathBuf,
    /// Walks (or marches) for each pixel, at least 2; with --max-error the most [default: 256, with --max-error 1048576]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..))]
    samples: Option<u64>,
    /// Stop at this relative error (root mean square over pixels of the standard error over the radiance)
    #[arg(long, value_name = "ERROR", value_parser = relative_error)]
    max_error: Option<f64>,
    /// Go on from the checkpoint of an interrupted run, to the same result
    #[arg(long)]
    resume: bool,
    /// Trace part I of N; `welkin merge` joins the parts
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    shard: Shard,
    /// Seed of the random numbers; another seed is another, independent picture
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    solver: SolverArguments,
}

/// Traces the picture.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let solver = arguments.solver.solver()?;
    let random = [("--samples", arguments.samples.is_some()), ("--max-error", arguments.max_error.is_some())];
    check_sampling(&solver, &random)?;
    let scene = Scene::read_with(&arguments.scene, arguments.spectrum.request())?;
    let sampling = match solver {
        Solver::Single => Sampling::without_noise(),
        _ => Sampling::new(arguments.samples, arguments.max_error),
    };
    let identity = Identity::new(&scene, &solver, arguments.seed, &sampling, arguments.shard);
    let view = CameraView::new(&scene, solver, arguments.seed, sampling.walks_per_batch)?;
    let checkpoint = picture::path_for(&arguments.output);
    // Made and dropped again: a place that cannot be written is refused before the work.
    AtomicFile::create(&arguments.output)?;
    let mut film = begin(arguments, &checkpoint, &identity, view.pixels())?;
    let watch = Watch::new(
        &film,
        &sampling,
        solver.samples_name(),
        Some(Checkpoint { path: checkpoint.clone(), identity: identity.clone() }),
    )?;
    let started = Instant::now();
    if expose(&&view, &mut film, &sampling.stop(), &watch)? == Outcome::Interrupted {
        picture::save(&checkpoint, &identity, &film)?;
        return Err(Failure::Interrupted(Some(checkpoint)));
    }
    watch.finish();
    let part = Part {
        identity,
        frame: view.develop(&film),
        header: ExrHeader::of_scene(&scene).with_text("solver", &solver.to_string()),
    };
    write_part(AtomicFile::create(&arguments.output)?, &part)?;
    if checkpoint.exists() {
        std::fs::remove_file(&checkpoint)?;
    }
    conclude(arguments, &solver, &sampling, &film, started)
}

fn begin(arguments: &Arguments, checkpoint: &Path, identity: &Identity, pixels: usize) -> Result<Film, Failure> {
    match (checkpoint.exists(), arguments.resume) {
        (true, true) => Ok(picture::load(checkpoint, identity)?),
        (exists, resume) => {
            if exists {
                eprintln!("note: beginning again; --resume goes on from '{}'", checkpoint.display());
            } else if resume {
                eprintln!("note: there is no checkpoint '{}'; beginning from the start", checkpoint.display());
            }
            Ok(Film::with_room(arguments.shard, pixels)?)
        }
    }
}

fn conclude(
    arguments: &Arguments,
    solver: &Solver,
    sampling: &Sampling,
    film: &Film,
    started: Instant,
) -> Result<(), Failure> {
    let (walks, error) = (film.goal * sampling.walks_per_batch, film.relative_error());
    let seconds = started.elapsed().as_secs_f64();
    let (file, samples) = (arguments.output.display(), solver.samples_name());
    eprintln!("solver: {solver}");
    eprintln!("{file}: {walks} {samples} a pixel in {seconds:.1} s, relative error {error:.2e}");
    match arguments.max_error {
        Some(target) if error > target => Err(Failure::Check(format!(
            "relative error {error:.3e} after {walks} {samples} a pixel, above the {target:.3e} asked for; \
             the picture is written, more --samples would go further"
        ))),
        _ => Ok(()),
    }
}
