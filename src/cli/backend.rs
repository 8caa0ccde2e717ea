//! What computes light, and how it is opened.

use std::env;
use std::path::PathBuf;
use std::sync::OnceLock;

use clap::ValueEnum;
use welkin::gpu::{DeviceKind, DeviceRequest, Gpu, Validation, ValidationLog};
use welkin::passes::RenderError;
use welkin::renderer::Renderer;

use super::Failure;

/// What computes light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// Tables on a Vulkan device, in real time
    Gpu,
    /// The path tracer on the CPU
    Reference,
}

impl Backend {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gpu => "gpu",
            Self::Reference => "reference",
        }
    }

    /// Refuses options that this backend would not heed: each with whose it is and whether it was given.
    pub fn check_options(self, options: &[(&str, Self, bool)]) -> Result<(), Failure> {
        match options.iter().find(|(_, owner, given)| *given && *owner != self) {
            Some((option, owner, _)) => Err(Failure::Input(anyhow::anyhow!(
                "{option} says nothing to the {} backend; leave it out or choose --backend {}",
                self.name(),
                owner.name()
            ))),
            None => Ok(()),
        }
    }
}

/// When this environment variable is set, the validation layer watches, and a single message of it fails the command.
const VALIDATION_VARIABLE: &str = "WELKIN_VALIDATION";

/// Names a folder for what can be made again.
const CACHE_VARIABLE: &str = "WELKIN_CACHE";

static VALIDATION_LOG: OnceLock<ValidationLog> = OnceLock::new();

/// Fails when the validation layer has had something to say, also while the device was closed.
pub fn check_validation() -> Result<(), Failure> {
    let messages = VALIDATION_LOG.get().map(ValidationLog::messages).unwrap_or_default();
    match messages.first() {
        Some(first) => {
            Err(Failure::Check(format!("{} messages of the validation layer; the first: {first}", messages.len())))
        }
        None => Ok(()),
    }
}

/// Opens a device by a part of its name or its index, else the best one, and says which.
pub fn open_renderer(device: Option<&str>) -> Result<Renderer, Failure> {
    let renderer = Renderer::new(&device_request(device)).map_err(failure)?;
    announce(renderer.gpu());
    Ok(renderer)
}

/// What is asked of a device by a part of its name or its index, or of the best one.
pub fn device_request(device: Option<&str>) -> DeviceRequest {
    let validation = if env::var_os(VALIDATION_VARIABLE).is_some() { Validation::On } else { Validation::Off };
    let device = device.map(str::to_owned);
    DeviceRequest { device, validation, pipeline_cache: cache_folder(), ..DeviceRequest::default() }
}

/// Says which device was opened, and keeps its messages.
pub fn announce(gpu: &Gpu) {
    // Kept for `check_validation`; a command opens one device.
    let _ = VALIDATION_LOG.set(gpu.validation_log());
    let info = gpu.info();
    match info.kind {
        DeviceKind::Cpu => eprintln!("device: {}, which computes on the CPU: no GPU was found or chosen", info.name),
        _ => eprintln!("device: {}", info.name),
    }
}

/// Where compiled pipelines and references are kept: the platform's place for what can be made again, unless
/// the variable names another folder; an empty one keeps nothing.
pub fn cache_folder() -> Option<PathBuf> {
    match env::var_os(CACHE_VARIABLE) {
        Some(folder) => (!folder.is_empty()).then(|| folder.into()),
        None => directories::ProjectDirs::from("", "", "welkin").map(|places| places.cache_dir().to_owned()),
    }
}

/// Tells a machine without Vulkan from an input that cannot be rendered.
pub fn failure(error: RenderError) -> Failure {
    match &error {
        RenderError::Gpu(gpu) if gpu.is_no_usable_device() => Failure::NoDevice(error.into()),
        RenderError::NoLinearFilter { .. } => Failure::NoDevice(error.into()),
        _ => Failure::Input(error.into()),
    }
}
