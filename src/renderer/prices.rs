//! What skipped passes would cost if the scene called for them.

use std::collections::BTreeMap;

use super::Renderer;
use crate::passes::RenderError;
use crate::plan::{Decision, MultipleScattering, Outputs, Plan, PlannedPass, Settings};
use crate::scene::{Effect, Scene};

/// What a skipped pass would cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Price {
    /// What the scene would have to have, in words.
    pub with: String,
    /// Milliseconds on the device; none where nothing is measured.
    pub milliseconds: Option<f64>,
    /// Bytes of its results.
    pub bytes: u64,
}

/// The prices of the passes that a plan skips, each from the first of these changes that calls for it: an effect added to
/// the scene, or another treatment of multiple scattering. A pass that none of them calls for has no price, nor has one
/// whose scene the renderer refuses. With a renderer each change is rendered once.
///
/// # Errors
/// Device and shader errors.
pub fn prices(
    mut renderer: Option<&mut Renderer>,
    scene: &Scene,
    settings: Settings,
    outputs: Outputs,
    plan: &Plan,
) -> Result<BTreeMap<&'static str, Price>, RenderError> {
    let mut prices = BTreeMap::new();
    for (with, scene, settings) in changes(scene, settings) {
        let planned = match Renderer::plan(&scene, settings, outputs) {
            Ok(planned) => planned,
            Err(RenderError::Plan(_)) => continue,
            Err(other) => return Err(other),
        };
        let skipped =
            |pass: &&PlannedPass| plan.decision(pass.name) == Some(Decision::Skip) && pass.decision == Decision::Run;
        let new: Vec<_> =
            planned.passes.iter().filter(skipped).filter(|pass| !prices.contains_key(pass.name)).collect();
        if new.is_empty() {
            continue;
        }
        let times = match &mut renderer {
            Some(renderer) => Some(renderer.render(&scene, settings, outputs)?.timings.milliseconds),
            None => None,
        };
        for pass in new {
            let milliseconds = times.as_ref().map(|times| times.get(pass.name).copied().unwrap_or(0.0));
            prices.insert(pass.name, Price { with: with.clone(), milliseconds, bytes: pass.bytes });
        }
    }
    Ok(prices)
}

/// Scenes and settings that call for more, in words.
fn changes(scene: &Scene, settings: Settings) -> Vec<(String, Scene, Settings)> {
    let effects = Effect::ALL.map(|effect| (effect.name().to_owned(), effect.added_to(scene), settings));
    let methods =
        [MultipleScattering::Harmonics, MultipleScattering::SourceFunction, MultipleScattering::IsotropicSeries];
    let treatments = methods.map(|multiple_scattering| {
        let settings = Settings { multiple_scattering, ..settings };
        (format!("--multiple-scattering {multiple_scattering}"), scene.clone(), settings)
    });
    effects.into_iter().chain(treatments).collect()
}
