//! A report's progress on standard error, its pictures, and Ctrl-C.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use welkin::output::OutputError;
use welkin::reference::picture::{Film, Observer};
use welkin::report::{ReportError, Shown, Watcher, save_picture};

use crate::cli::failure::INTERRUPTED;

/// Shows how far a report has come.
pub struct Progress {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
    pictures: PathBuf,
}

impl Progress {
    /// Lets Ctrl-C or a request to terminate end the report: the first gently, the second at once.
    ///
    /// # Errors
    /// Those of the system's signals.
    pub fn new(pictures: PathBuf) -> io::Result<Self> {
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&interrupted);
        ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED.into());
            }
        })
        .map_err(io::Error::other)?;
        const TEMPLATE: &str = "{bar:30} {pos}/{len}  {elapsed} gone, {eta} left  {msg}";
        let style = ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar());
        Ok(Self { bar: ProgressBar::new(0).with_style(style), interrupted, pictures })
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Progress {
    fn advanced(&self, _: u64) {}

    fn paused(&self, _: &Film, _: bool) -> Result<(), OutputError> {
        Ok(())
    }

    fn interrupted(&self) -> &AtomicBool {
        &self.interrupted
    }
}

impl Watcher for Progress {
    fn expects(&self, steps: u64) {
        self.bar.set_position(0);
        self.bar.set_length(steps);
        self.bar.reset_eta();
    }

    fn begins(&self, what: &str) {
        self.bar.set_message(what.to_owned());
        if self.bar.is_hidden() {
            // Not a terminal: a line for each step, for logs.
            eprintln!("{what}");
        }
    }

    fn done(&self) {
        self.bar.inc(1);
    }

    fn shows(&self, picture: &Shown) -> Result<(), ReportError> {
        save_picture(&self.pictures, picture)
    }
}
