//! Why a report cannot be made.

use std::path::PathBuf;

use crate::output::OutputError;
use crate::reference::SolverError;
use crate::reference::picture::CheckpointError;

/// Why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// Somebody asked it to end; what was measured is kept, and the same command goes on.
    #[error("interrupted")]
    Interrupted,
    /// The folder of truths cannot be used.
    #[error("cannot use the folder '{}' for references; choose another with --cache", path.display())]
    Cache {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The list of what has been measured cannot be used.
    #[error("cannot use '{}': {problem}; delete it to begin again, or choose another --out", path.display())]
    Ledger {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// The scene is black: nothing is relative to anything.
    #[error("scene '{0}' is black, so no error is relative to anything; leave it out of the folder")]
    Black(String),
    /// A candidate could not be rendered.
    #[error("scene '{scene}' with settings '{settings}'")]
    Render {
        /// The scene.
        scene: String,
        /// The settings' name.
        settings: String,
        /// What the renderer says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A plot could not be drawn.
    #[error("cannot draw a plot: {0}")]
    Plot(String),
    /// The path tracer does not know the scene.
    #[error(transparent)]
    Solver(#[from] SolverError),
    /// A kept reference cannot be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A table cannot be written.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// Results have no JSON form.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

impl<E: std::error::Error + Send + Sync> From<plotters::drawing::DrawingAreaErrorKind<E>> for ReportError {
    fn from(error: plotters::drawing::DrawingAreaErrorKind<E>) -> Self {
        Self::Plot(error.to_string())
    }
}
