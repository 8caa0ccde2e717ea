//! What each pass of a first frame costs.

use std::collections::BTreeMap;

use serde::Serialize;

use super::Series;
use crate::gpu::{Clock, DeviceKind, Gpu};
use crate::passes::{RenderError, ShaderSources};
use crate::plan::{Outputs, Settings};
use crate::renderer::Renderer;
use crate::scene::Scene;

/// What a pass costs.
#[derive(Debug, Serialize)]
pub struct PassCost {
    /// Its name.
    pub name: &'static str,
    /// Processor time where the device is a CPU, else the device's, ms.
    pub milliseconds: Series,
    /// Bytes of its results.
    pub bytes: u64,
}

/// Measures every pass of a scene's first frame with a picture, `rounds` times.
///
/// # Errors
/// As [`Renderer::render`].
pub fn pass_costs(
    gpu: &Gpu,
    shaders: &ShaderSources,
    scene: &Scene,
    settings: Settings,
    rounds: u32,
) -> Result<Vec<PassCost>, RenderError> {
    let mut renderer = Renderer::with_shaders(gpu.clone(), shaders.clone())?;
    if gpu.info().kind == DeviceKind::Cpu {
        renderer.set_clock(Clock::Processor);
    }
    let outputs = Outputs { capture: false, picture: true };
    let mut costs: BTreeMap<&'static str, PassCost> = BTreeMap::new();
    let mut order = Vec::new();
    // The first round makes the pipelines.
    for round in 0..=rounds {
        renderer.forget();
        let timings = renderer.compute(scene, settings, outputs)?;
        for pass in timings.plan.passes.iter().filter(|pass| timings.milliseconds.contains_key(pass.name)) {
            let cost = costs.entry(pass.name).or_insert_with(|| {
                order.push(pass.name);
                PassCost { name: pass.name, milliseconds: Series::default(), bytes: pass.bytes }
            });
            if round > 0 {
                cost.milliseconds.values.push(timings.milliseconds[pass.name]);
            }
        }
    }
    Ok(order.into_iter().filter_map(|name| costs.remove(name)).collect())
}
