//! `welkin reference`: a picture by the path tracer, with its standard error.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::watch::{Checkpoint, Watch};
use super::{Failure, exr_output};
use welkin::output::{AtomicFile, ExrHeader};
use welkin::reference::picture::{
    self, CameraView, Film, Identity, Outcome, Part, Sampling, Shard, expose, write_part,
};
use welkin::scene::Scene;

/// Trace a picture of a scene on the CPU, with the standard error of every pixel
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file
    scene: PathBuf,
    /// Picture to write, an EXR file
    #[arg(short, long, value_name = "FILE", value_parser = exr_output)]
    output: PathBuf,
    /// Walks for each pixel, at least 2; with --max-error the most [default: 256, with --max-error 1048576]
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
}

fn relative_error(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("'{text}' is not a number"))?;
    if value > 0.0 && value < 1.0 { Ok(value) } else { Err(format!("{value} does not lie in ]0, 1[")) }
}

/// Traces the picture.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::read(&arguments.scene)?;
    let sampling = Sampling::new(arguments.samples, arguments.max_error);
    let identity = Identity::new(&scene, arguments.seed, &sampling, arguments.shard);
    let view = CameraView::new(&scene, arguments.seed, sampling.walks_per_batch);
    let checkpoint = picture::path_for(&arguments.output);
    // Made and dropped again: a place that cannot be written is refused before the work.
    AtomicFile::create(&arguments.output)?;
    let mut film = begin(arguments, &checkpoint, &identity, view.pixels())?;
    let watch =
        Watch::new(&film, &sampling, Some(Checkpoint { path: checkpoint.clone(), identity: identity.clone() }))?;
    let started = Instant::now();
    if expose(&&view, &mut film, &sampling.stop(), &watch)? == Outcome::Interrupted {
        picture::save(&checkpoint, &identity, &film)?;
        return Err(Failure::Interrupted(Some(checkpoint)));
    }
    watch.finish();
    let part = Part { identity, frame: view.develop(&film), header: ExrHeader::of_scene(&scene) };
    write_part(AtomicFile::create(&arguments.output)?, &part)?;
    if checkpoint.exists() {
        std::fs::remove_file(&checkpoint)?;
    }
    conclude(arguments, &sampling, &film, started)
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
            Ok(Film::new(arguments.shard, pixels))
        }
    }
}

fn conclude(arguments: &Arguments, sampling: &Sampling, film: &Film, started: Instant) -> Result<(), Failure> {
    let (walks, error) = (film.goal * sampling.walks_per_batch, film.relative_error());
    let seconds = started.elapsed().as_secs_f64();
    eprintln!("{}: {walks} walks a pixel in {seconds:.1} s, relative error {error:.2e}", arguments.output.display());
    match arguments.max_error {
        Some(target) if error > target => Err(Failure::Check(format!(
            "relative error {error:.3e} after {walks} walks a pixel, above the {target:.3e} asked for; \
             the picture is written, more --samples would go further"
        ))),
        _ => Ok(()),
    }
}
