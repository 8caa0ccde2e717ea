//! Frames that follow one another, of which each takes over what still holds of the clouds in the one before.

use super::{PendingFrame, Rendered, Renderer, Targets, Timings};
use crate::gpu::NextUse;
use crate::passes::RenderError;
use crate::passes::ordinates;
use crate::plan::{CloudSettings, Facts, Moment, Outputs, Sequence, Settings, follows, light_in_clouds_moved};
use crate::probe::Orders;
use crate::scene::Scene;

/// The frame before.
pub(super) struct Before {
    scene: Scene,
    clouds: CloudSettings,
    index: u32,
    settling: Option<u32>,
    /// What was out of view.
    out_of_view: [bool; 3],
    /// Whose light in clouds is solved for.
    solved_light: usize,
}

impl Before {
    /// Frames since clouds or lights have last moved, now that there is another frame.
    fn settling_until(&self, now: &Scene) -> Option<u32> {
        match light_in_clouds_moved(&self.scene, now) {
            true => Some(0),
            false => self.settling.map(|frames| frames.saturating_add(1)),
        }
    }
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
        self.render_next_pending(scene, settings, outputs)?.wait()
    }

    /// The same without waiting for the pixels, as [`Renderer::render_pending`].
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_next_pending(
        &mut self,
        scene: &Scene,
        settings: Settings,
        outputs: Outputs,
    ) -> Result<PendingFrame, RenderError> {
        self.next_frame(scene, settings, |renderer| renderer.render_pending(scene, settings, outputs))
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
    pub(super) fn next_frame<T>(
        &mut self,
        scene: &Scene,
        settings: Settings,
        render: impl FnOnce(&mut Self) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        // What was out of view has left nothing that could be followed.
        let facts = Facts::new(scene, settings, Orders::All, Outputs::default())?.in_picture();
        let (out_of_view, solved_light) = (facts.out_of_view.which(), ordinates::light(&facts));
        let is_same = |before: &Before| {
            (before.clouds, before.out_of_view, before.solved_light) == (settings.clouds, out_of_view, solved_light)
        };
        let sequence = match self.before.take() {
            Some(before) if is_same(&before) && follows(&before.scene, scene) => Sequence {
                index: before.index + 1,
                before: Some(Moment { camera: before.scene.camera, time_s: before.scene.time_s }),
                is_still: before.scene == *scene,
                settling: before.settling_until(scene),
            },
            _ => Sequence::CUT,
        };
        self.sequence = Some(sequence);
        let rendered = render(self);
        self.sequence = None;
        let rendered = rendered?;
        let (scene, clouds, Sequence { index, settling, .. }) = (scene.clone(), settings.clouds, sequence);
        self.before = Some(Before { scene, clouds, index, settling, out_of_view, solved_light });
        Ok(rendered)
    }
}
