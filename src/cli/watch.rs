//! Watching an exposure: progress on standard error, checkpoints, and Ctrl-C.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::failure::INTERRUPTED;
use welkin::output::OutputError;
use welkin::reference::picture::{self, Film, Identity, Observer, Sampling};

/// Time between two checkpoints, which is at most lost when a machine fails.
const CHECKPOINT_EVERY: Duration = Duration::from_secs(60);

/// Where an exposure's state is kept, and what it belongs to.
pub struct Checkpoint {
    /// The file.
    pub path: PathBuf,
    /// What it belongs to.
    pub identity: Identity,
}

/// Shows what an exposure has reached, and keeps it where there is a checkpoint.
pub struct Watch {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
    saved: Mutex<Instant>,
    checkpoint: Option<Checkpoint>,
    sampling: Sampling,
    samples_name: &'static str,
}

impl Watch {
    /// Watches the exposure of `film`, and lets Ctrl-C or a request to terminate end it: the first gently, with a
    /// checkpoint, the second at once.
    ///
    /// # Errors
    /// Those of the system's signals.
    pub fn new(
        film: &Film,
        sampling: &Sampling,
        samples_name: &'static str,
        checkpoint: Option<Checkpoint>,
    ) -> io::Result<Self> {
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&interrupted);
        ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED.into());
            }
        })
        .map_err(io::Error::other)?;
        let bar = ProgressBar::new(0).with_style(style());
        bar.set_position(film.pixels.iter().map(|pixel| pixel.batches).sum());
        bar.reset_eta();
        let saved = Mutex::new(Instant::now());
        let watch = Self { bar, interrupted, saved, checkpoint, sampling: *sampling, samples_name };
        watch.show(film);
        Ok(watch)
    }

    /// Takes the progress bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn show(&self, film: &Film) {
        let batches = self.sampling.expected_batches(film);
        self.bar.set_length(batches.saturating_mul(film.pixels.len() as u64));
        if film.goal == 0 {
            return;
        }
        let (walks, error) = (film.goal * self.sampling.walks_per_batch, film.relative_error());
        let reached = format!("{walks} {} a pixel, relative error {error:.2e}", self.samples_name);
        self.bar.set_message(reached.clone());
        if self.bar.is_hidden() {
            // Not a terminal: a line for each round, for logs.
            eprintln!("{reached}");
        }
    }
}

fn style() -> ProgressStyle {
    const TEMPLATE: &str = "{bar:30} {percent:>3} %  {elapsed} gone, {eta} left  {msg}";
    ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar())
}

impl Observer for Watch {
    fn advanced(&self, batches: u64) {
        self.bar.inc(batches);
    }

    fn paused(&self, film: &Film, level: bool) -> Result<(), OutputError> {
        if level {
            self.show(film);
        }
        let mut saved = self.saved.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(Checkpoint { path, identity }) = &self.checkpoint
            && saved.elapsed() > CHECKPOINT_EVERY
        {
            picture::save(path, identity, film)?;
            *saved = Instant::now();
        }
        Ok(())
    }

    fn interrupted(&self) -> &AtomicBool {
        &self.interrupted
    }
}
