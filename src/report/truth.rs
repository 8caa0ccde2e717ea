//! Truths of a report: small pictures by the path tracer, kept on disk under what they are of.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::ReportError;
use crate::frame::Frame;
use crate::output::OutputError;
use crate::reference::Solver;
use crate::reference::picture::{self, CameraView, Film, Identity, Observer, Outcome, Sampling, Shard, expose};
use crate::scene::Scene;

/// The seed of truths; the solvers that are compared with them have others.
const SEED: u64 = 0x7275_7468;
/// Fewest walks: batches of as many as [`Sampling`] gives to large numbers.
const FEWEST_WALKS: u64 = 256;
/// Time between two checkpoints.
const SAVE_EVERY: Duration = Duration::from_secs(20);

/// A small picture with its standard errors.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The picture; `standard_error` is there.
    pub frame: Frame,
    /// Walks for each pixel.
    pub walks: u64,
}

/// Finds or traces the truth of a scene, with at least so many walks a pixel, or to a relative standard error (the root of its mean
/// square) that they need not be spent on.
///
/// The cache's files are named by the fingerprint of planet, air, clouds, lights, terrain and camera; a truth with fewer
/// walks is continued, one with more is taken as it is. An interruption leaves a checkpoint there.
///
/// # Errors
/// [`ReportError::Interrupted`]; those of the disk; [`ReportError::Solver`].
pub fn truth(
    scene: &Scene,
    walks: u64,
    error: Option<f64>,
    cache: &Path,
    observer: &impl Observer,
) -> Result<Truth, ReportError> {
    let sampling = Sampling::new(Some(walks.max(FEWEST_WALKS)), error);
    let identity = Identity::new(scene, &Solver::Path, SEED, &sampling, Shard::WHOLE);
    let view = CameraView::new(scene, Solver::Path, SEED, sampling.walks_per_batch)?;
    std::fs::create_dir_all(cache).map_err(|source| ReportError::Cache { path: cache.to_owned(), source })?;
    let path = cache.join(format!("truth-{}.film", identity.fingerprint));
    let mut film = match path.exists() {
        true => picture::load(&path, &identity)?,
        false => Film::new(Shard::WHOLE, view.pixels()),
    };
    let is_enough =
        film.goal >= sampling.stop().most_batches || error.is_some_and(|error| film.relative_error() <= error);
    if !(film.is_level() && is_enough) {
        let keeper =
            Keeper { inner: observer, path: path.clone(), identity: &identity, saved: Mutex::new(Instant::now()) };
        let outcome = expose(&&view, &mut film, &sampling.stop(), &keeper)?;
        picture::save(&path, &identity, &film)?;
        if outcome == Outcome::Interrupted {
            return Err(ReportError::Interrupted);
        }
    }
    Ok(Truth { frame: view.develop(&film), walks: film.goal * sampling.walks_per_batch })
}

/// Saves the film now and then, and passes everything on.
struct Keeper<'a, O> {
    inner: &'a O,
    path: PathBuf,
    identity: &'a Identity,
    saved: Mutex<Instant>,
}

impl<O: Observer> Observer for Keeper<'_, O> {
    fn advanced(&self, batches: u64) {
        self.inner.advanced(batches);
    }

    fn paused(&self, film: &Film, level: bool) -> Result<(), OutputError> {
        let mut saved = self.saved.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if saved.elapsed() > SAVE_EVERY {
            picture::save(&self.path, self.identity, film)?;
            *saved = Instant::now();
        }
        self.inner.paused(film, level)
    }

    fn interrupted(&self) -> &AtomicBool {
        self.inner.interrupted()
    }
}
