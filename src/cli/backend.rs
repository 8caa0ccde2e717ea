//! What computes light, and how it is opened.

use clap::ValueEnum;
use welkin::gpu::{DeviceKind, DeviceRequest, Validation};
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
}

/// Opens a device by a part of its name or its index, else the best one, and says which.
pub fn open_renderer(device: Option<&str>) -> Result<Renderer, Failure> {
    let request = DeviceRequest { device: device.map(str::to_owned), validation: Validation::Off };
    let renderer = Renderer::new(&request).map_err(failure)?;
    let info = renderer.gpu().info();
    match info.kind {
        DeviceKind::Cpu => eprintln!("device: {}, which computes on the CPU: no GPU was found or chosen", info.name),
        _ => eprintln!("device: {}", info.name),
    }
    Ok(renderer)
}

/// Tells a machine without Vulkan from an input that cannot be rendered.
pub fn failure(error: RenderError) -> Failure {
    match &error {
        RenderError::Gpu(gpu) if gpu.is_no_usable_device() => Failure::NoDevice(error.into()),
        RenderError::NoLinearFilter { .. } => Failure::NoDevice(error.into()),
        _ => Failure::Input(error.into()),
    }
}
