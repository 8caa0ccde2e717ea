//! The renderer as the report measures it.

use welkin::passes::RenderError;
use welkin::plan::{Outputs, Settings};
use welkin::renderer::Renderer;
use welkin::report::{Measure, Measured};
use welkin::scene::Scene;

/// A renderer that forgets before each picture what it has computed.
pub struct Device(pub Renderer);

impl Measure for Device {
    type Error = RenderError;

    fn measure(&mut self, scene: &Scene, settings: Settings) -> Result<Measured, RenderError> {
        let compiled = self.0.compiled_pipelines();
        self.0.forget();
        let mut rendered = self.0.render(scene, settings, Outputs::default())?;
        // Drivers that compute on the CPU compile at a pipeline's first dispatch, within the time of its pass.
        if self.0.compiled_pipelines() > compiled {
            self.0.forget();
            rendered = self.0.render(scene, settings, Outputs::default())?;
        }
        Ok(Measured { frame: rendered.frame, milliseconds: rendered.timings.milliseconds })
    }
}
