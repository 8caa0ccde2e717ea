//! Frames that follow one another, of which each takes over what still holds of the clouds in the one before.

use super::{Rendered, Renderer, Targets, Timings};
use crate::gpu::NextUse;
use crate::passes::RenderError;
use crate::plan::{CloudSettings, Facts, Moment, Outputs, Sequence, Settings, follows};
use crate::probe::Orders;
use crate::scene::Scene;

/// The frame before.
pub(super) struct Before {
    scene: Scene,
    clouds: CloudSettings,
    index: u32,
    /// What was out of view.
    out_of_view: [bool; 3],
}

impl Renderer {
    /// As [`Renderer::render`], as the next frame of a sequence: of clouds it computes some pixels alone, as many as the
    /// settings say, and follows the others from the frame before. After a cut (another scene, view or quality, and any
    /// frame in between that is no part of the sequence) every pixel is computed, so that nothing stays from before.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_next(
        &mut self,
        scene: &Scene,
        settings: Settings,
        outputs: Outputs,
    ) -> Result<Rendered, RenderError> {
        self.next_frame(scene, settings, |renderer| renderer.render(scene, settings, outputs))
    }

    /// As [`Renderer::render_to`], as the next frame of a sequence.
    ///
    /// # Errors
    /// As [`Renderer::render_to`].
    pub fn render_next_to(
        &mut self,
        scene: &Scene,
        settings: Settings,
        targets: &Targets,
        next: NextUse,
    ) -> Result<Timings, RenderError> {
        self.next_frame(scene, settings, |renderer| renderer.render_to(scene, settings, targets, next))
    }

    /// Renders a frame that may look at the one before. One that fails leaves nothing to look at.
    fn next_frame<T>(
        &mut self,
        scene: &Scene,
        settings: Settings,
        render: impl FnOnce(&mut Self) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        // What was out of view has left nothing that could be followed.
        let out_of_view =
            Facts::new(scene, settings, Orders::All, Outputs::default())?.in_picture().out_of_view.which();
        let is_same = |before: &Before| before.clouds == settings.clouds && before.out_of_view == out_of_view;
        let sequence = match self.before.take() {
            Some(before) if is_same(&before) && follows(&before.scene, scene) => Sequence {
                index: before.index + 1,
                before: Some(Moment { camera: before.scene.camera, time_s: before.scene.time_s }),
                is_still: before.scene == *scene,
            },
            _ => Sequence::CUT,
        };
        self.sequence = Some(sequence);
        let rendered = render(self);
        self.sequence = None;
        let rendered = rendered?;
        let (scene, clouds, index) = (scene.clone(), settings.clouds, sequence.index);
        self.before = Some(Before { scene, clouds, index, out_of_view });
        Ok(rendered)
    }
}
