//! From nothing to the first picture.

use std::path::Path;

use serde::Serialize;

use super::Stopwatch;
use crate::gpu::{DeviceRequest, Gpu};
use crate::passes::RenderError;
use crate::plan::{Outputs, Settings};
use crate::renderer::Renderer;
use crate::scene::Scene;

/// What opening a device and rendering one frame have cost.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Start {
    /// Processor time, ms.
    pub processor_ms: f64,
    /// Time that passed, ms.
    pub wall_ms: f64,
}

/// Opens a device of its own, with pipelines from a folder, and renders one frame.
///
/// # Errors
/// As [`Renderer::new`] and [`Renderer::render`].
pub fn start(
    device: Option<&str>,
    pipelines: Option<&Path>,
    scene: &Scene,
    settings: Settings,
) -> Result<Start, RenderError> {
    let stopwatch = Stopwatch::start();
    let request = DeviceRequest {
        device: device.map(str::to_owned),
        pipeline_cache: pipelines.map(Path::to_owned),
        ..DeviceRequest::default()
    };
    let mut renderer = Renderer::on(Gpu::new(&request)?)?;
    renderer.compute(scene, settings, Outputs::default())?;
    Ok(Start { processor_ms: stopwatch.processor_ms(), wall_ms: stopwatch.wall_ms() })
}
