//! What settings take on this device.

use std::collections::BTreeMap;

use super::Renderer;
use crate::passes::RenderError;
use crate::plan::{LadderStep, Outputs};
use crate::scene::Scene;

/// Pictures of which the shortest counts: what else a machine does only ever makes them longer, and the first may compile.
const RUNS: usize = 2;

impl Renderer {
    /// Milliseconds of each pass of a first picture, all tables included, with the settings of a step of the ladder.
    /// Forgets what earlier frames have computed.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn step_times(
        &mut self,
        scene: &Scene,
        step: LadderStep,
        outputs: Outputs,
    ) -> Result<BTreeMap<String, f64>, RenderError> {
        let mut runs = Vec::new();
        for _ in 0..RUNS {
            self.forget();
            runs.push(self.compute(scene, step.settings(), outputs)?.milliseconds);
        }
        self.forget();
        let total = |times: &BTreeMap<String, f64>| times.values().sum::<f64>();
        Ok(runs.into_iter().min_by(|a, b| total(a).total_cmp(&total(b))).unwrap_or_default())
    }
}
