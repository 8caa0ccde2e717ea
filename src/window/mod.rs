//! The window: flying through a sky, with a panel for everything that makes it.
//!
//! The sky is computed by a thread of its own (`sky.rs`), which leaves pictures on the device; the window shows the last one
//! that is done with the panel on top, whenever either changes, and never waits for the sky.

mod aim;
mod app;
mod capture;
mod comparison;
mod day;
mod document;
mod fly;
mod graph;
mod held;
mod history;
mod interface;
mod panel;
mod resolution;
mod scenes;
mod session;
mod settings;
mod shortcuts;
mod sky;
mod truth;
mod watch;
mod wipe;

use std::path::{Path, PathBuf};

use winit::error::EventLoopError;
use winit::event_loop::EventLoop;

use crate::gpu::{DeviceRequest, Gpu, GpuError};
use crate::passes::RenderError;
use crate::scene::SceneError;

use app::{App, Event};
use document::Document;

pub use settings::FOLDER_VARIABLE;

/// What the window is opened with.
pub struct Options {
    /// The scene's file; by default an example.
    pub scene: Option<PathBuf>,
    /// The device.
    pub request: DeviceRequest,
    /// Called when the device is open.
    pub opened: Box<dyn FnOnce(&Gpu)>,
    /// Where pictures go.
    pub pictures: PathBuf,
    /// A folder of shaders that somebody edits, in place of those that the program was built with.
    pub shaders: Option<PathBuf>,
    /// A folder for the settings: see [`FOLDER_VARIABLE`].
    pub settings: Option<PathBuf>,
}

/// Why the window closed with a failure.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// There is nowhere to show it.
    #[error("no display to open a window on ({0}); `welkin render` makes pictures without one")]
    NoDisplay(String),
    /// The scene's file.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The device or what it renders.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The panel.
    #[error(transparent)]
    Interface(#[from] interface::InterfaceError),
    /// The window's events.
    #[error("the window: {0}")]
    Events(String),
}

impl From<GpuError> for WindowError {
    fn from(error: GpuError) -> Self {
        Self::Render(error.into())
    }
}

impl WindowError {
    /// Whether this machine cannot show a window at all.
    pub fn is_no_display_or_device(&self) -> bool {
        match self {
            Self::NoDisplay(_) => true,
            Self::Render(RenderError::Gpu(error)) => error.is_no_usable_device(),
            Self::Render(RenderError::NoLinearFilter { .. }) => true,
            _ => false,
        }
    }
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// [`WindowError`].
pub fn run(options: Options) -> Result<(), WindowError> {
    // Before anything is opened: a scene that is none costs no window.
    let document = read(options.scene.as_deref())?;
    let events = EventLoop::<Event>::with_user_event().build().map_err(|error| match error {
        EventLoopError::Os(error) => WindowError::NoDisplay(last_line(&error.to_string())),
        EventLoopError::NotSupported(error) => WindowError::NoDisplay(error.to_string()),
        error => WindowError::Events(error.to_string()),
    })?;
    let mut app = App::new(options, document, events.create_proxy());
    let ended = events.run_app(&mut app);
    app.close();
    app.failure.take().map_or(Ok(()), Err)?;
    ended.map_err(|error| WindowError::Events(error.to_string()))
}

/// The document of a scene's file, or of the first example.
fn read(path: Option<&Path>) -> Result<Document, SceneError> {
    let Some(path) = path else {
        let (name, text) = scenes::FIRST;
        return Document::new(text, Path::new(&format!("{name}.toml")));
    };
    let text = std::fs::read_to_string(path).map_err(|source| SceneError::Read { path: path.to_owned(), source })?;
    Document::new(&text, path)
}

/// winit's messages begin with the place in its source.
fn last_line(text: &str) -> String {
    text.rsplit(": ").next().unwrap_or(text).to_owned()
}
