//! `welkin window`: fly through a scene.

use std::env;
use std::path::PathBuf;

use clap::Args;
use welkin::window::{self, FOLDER_VARIABLE, Options, WindowError};

use super::Failure;
use super::backend::{announce, device_request};

/// Fly through a scene in a window
///
/// F1 shows the keys. Pictures are written with the scene that `welkin render` makes them of.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file; by default an example
    scene: Option<PathBuf>,
    /// The device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Where pictures are written
    #[arg(long, value_name = "DIR", default_value = ".")]
    pictures: PathBuf,
    /// Shaders to use, and to compile again whenever one is edited, as in shaders/wgsl
    #[arg(long, value_name = "DIR")]
    shaders: Option<PathBuf>,
}

/// Opens the window and waits until it is closed.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let options = Options {
        scene: arguments.scene.clone(),
        request: device_request(arguments.device.as_deref()),
        opened: Box::new(announce),
        pictures: arguments.pictures.clone(),
        shaders: arguments.shaders.clone(),
        settings: env::var_os(FOLDER_VARIABLE).map(PathBuf::from),
    };
    window::run(options).map_err(failure)
}

fn failure(error: WindowError) -> Failure {
    if error.is_no_display_or_device() { Failure::NoDevice(error.into()) } else { Failure::Input(error.into()) }
}
