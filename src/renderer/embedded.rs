//! Frames inside of an engine: on its device, into its command buffers and images.

use super::Renderer;
use crate::gpu::{HostCommands, HostRecorded};
use crate::passes::{CLOUDS, FRAME, HOST_COLOUR, HOST_FROXELS, HOST_SURFACE, RenderError, TABLES};
use crate::passes::{HostFrame, HostFroxels, HostLeft, HostRecording};
use crate::plan::{Facts, FroxelGrid, Outputs, Plan, PlanError, Settings, Surface};
use crate::probe::Orders;
use crate::scene::Scene;

/// A frame that is recorded.
pub struct HostedFrame {
    /// What the device uses until it has done the frame.
    pub recorded: HostRecorded,
    /// How the host's images are left.
    pub left: HostLeft,
    /// What the frame runs.
    pub plan: Plan,
}

impl Renderer {
    /// Records what the scene's camera sees into a command buffer of a host's: sky, ground and clouds where its depth image
    /// shows no surface, and the air before its surfaces; what lies before the froxels that it asks for; for a renderer on a device of [`crate::gpu::Gpu::on_host`].
    /// Nothing is submitted or waited for, so any number of frames may be in flight. Frames follow one another as with
    /// [`Renderer::render_next`]. The scene's camera must be that of the host.
    ///
    /// # Errors
    /// As [`Renderer::render`]; [`RenderError::Target`] and [`RenderError::Foreground`] for images that do not fit.
    /// After an error the command buffer holds a part of a frame and must be reset, not submitted.
    pub fn record_frame(
        &mut self,
        commands: HostCommands,
        scene: &Scene,
        settings: Settings,
        frame: &HostFrame,
    ) -> Result<HostedFrame, RenderError> {
        if scene.spectrum.group_count() > 1 {
            let what = "a frame for a host has three bands and the scene more wavelengths".to_owned();
            return Err(PlanError::Unsupported { what }.into());
        }
        frame.check(&scene.camera)?;
        self.foregrounds += 1;
        let surface = frame.depth.as_ref().map(|_| Surface::Given(self.foregrounds));
        let froxels = frame.froxels.as_ref().map(HostFroxels::grid);
        self.resources.host = Some(HostRecording { commands: Some(commands), frame: frame.clone(), recorded: None });
        let plan =
            self.next_frame(scene, settings, |renderer| renderer.record_passes(scene, settings, surface, froxels));
        let host = self.resources.host.take();
        let plan = plan?;
        let (recorded, left) = host.and_then(|host| host.recorded).expect("what has run has recorded the host's frame");
        Ok(HostedFrame { recorded, left, plan })
    }

    /// Gives up a frame that was recorded last and is not submitted. The next one computes everything anew.
    pub fn abandon(&mut self, recorded: HostRecorded) {
        drop(recorded);
        self.resources.forget();
        self.forget();
    }

    fn record_passes(
        &mut self,
        scene: &Scene,
        settings: Settings,
        surface: Option<Surface>,
        froxels: Option<FroxelGrid>,
    ) -> Result<Plan, RenderError> {
        let mut facts = Facts::new(scene, settings, Orders::All, Outputs::default())?.in_picture();
        if surface.is_some() {
            facts = facts.with_surface(surface);
        }
        facts = facts.with_froxels(froxels);
        let before = TABLES.iter().chain(&CLOUDS).chain([&HOST_SURFACE]);
        let passes: Vec<_> = before.chain(&FRAME).chain([&HOST_COLOUR]).chain(&HOST_FROXELS).collect();
        // The host's images are others, or hold something else, in every frame.
        for pass in [&HOST_COLOUR, &HOST_FROXELS[1]] {
            self.history.forget(pass.declaration.name);
        }
        Ok(self.execute("frame", &facts, &passes)?.plan)
    }
}
