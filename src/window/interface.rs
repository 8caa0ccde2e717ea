//! egui in this window: its input from winit, its shapes to the presenter.

use std::collections::VecDeque;

use egui::{ClippedPrimitive, Context, FullOutput, TextureId, TexturesDelta, ViewportId};
use egui_ash_renderer::{DynamicRendering, Options, Renderer, RendererError};
use winit::event::WindowEvent;
use winit::window::Window;

use crate::gpu::{FRAMES_IN_FLIGHT, GpuError, OverlayTarget, Placed, Presenter};

/// Why the panel could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum InterfaceError {
    /// The device failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The panel's renderer failed.
    #[error("drawing the panel: {0}")]
    Panel(#[from] RendererError),
}

/// egui with its renderer.
pub struct Interface {
    context: Context,
    state: egui_winit::State,
    renderer: Option<Renderer>,
    primitives: Vec<ClippedPrimitive>,
    pixels_per_point: f32,
    /// Textures that frames in flight may still read.
    unused: VecDeque<Vec<TextureId>>,
    /// Changes to textures that are not yet on the device.
    changes: TexturesDelta,
}

impl Interface {
    /// For a window.
    pub fn new(window: &Window) -> Self {
        let context = Context::default();
        super::panel::style(&context);
        let scale = Some(window.scale_factor() as f32);
        let state = egui_winit::State::new(context.clone(), ViewportId::ROOT, window, scale, window.theme(), None);
        Self {
            context,
            state,
            renderer: None,
            primitives: Vec::new(),
            pixels_per_point: 1.0,
            unused: VecDeque::new(),
            changes: TexturesDelta::default(),
        }
    }

    /// egui itself.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// Passes an event on; says whether egui keeps it for itself, and whether it wants to be drawn again.
    pub fn on_event(&mut self, window: &Window, event: &WindowEvent) -> (bool, bool) {
        let response = self.state.on_window_event(window, event);
        (response.consumed, response.repaint)
    }

    /// Lays out the panel; says after how many seconds it wants to be drawn again.
    pub fn run(&mut self, window: &Window, panel: impl FnMut(&Context)) -> f64 {
        let input = self.state.take_egui_input(window);
        let FullOutput { platform_output, textures_delta, shapes, pixels_per_point, viewport_output } =
            self.context.run(input, panel);
        self.state.handle_platform_output(window, platform_output);
        self.primitives = self.context.tessellate(shapes, pixels_per_point);
        self.pixels_per_point = pixels_per_point;
        self.changes.append(textures_delta);
        let delay = viewport_output.get(&ViewportId::ROOT).map(|output| output.repaint_delay);
        delay.map_or(f64::INFINITY, |delay| delay.as_secs_f64())
    }

    /// Shows pictures with the panel on top; says whether anything could be shown.
    ///
    /// # Errors
    /// Those of the device.
    pub fn present(&mut self, presenter: &mut Presenter, pictures: &[Placed]) -> Result<bool, InterfaceError> {
        self.start(presenter)?;
        let Some(renderer) = &mut self.renderer else { return Ok(false) };
        let changes = std::mem::take(&mut self.changes);
        if !changes.set.is_empty() {
            presenter.upload(|queue, pool| renderer.set_textures(queue, pool, &changes.set))?;
        }
        let (primitives, pixels_per_point) = (&self.primitives, self.pixels_per_point);
        let shown = presenter.present(pictures, |target: &OverlayTarget| {
            renderer.cmd_draw(target.commands, target.extent, pixels_per_point, primitives)?;
            Ok::<_, InterfaceError>(())
        })?;
        self.unused.push_back(changes.free);
        if self.unused.len() > FRAMES_IN_FLIGHT + 1
            && let Some(free) = self.unused.pop_front()
        {
            renderer.free_textures(&free)?;
        }
        Ok(shown)
    }

    /// Makes the renderer when there is something to draw on.
    fn start(&mut self, presenter: &Presenter) -> Result<(), InterfaceError> {
        let (Some(color_attachment_format), None) = (presenter.format(), &self.renderer) else { return Ok(()) };
        let raw = presenter.raw_device();
        let (instance, hardware, device) = (raw.instance, raw.physical_device, raw.device.clone());
        let rendering = DynamicRendering { color_attachment_format, depth_attachment_format: None };
        let options = Options { in_flight_frames: FRAMES_IN_FLIGHT + 1, ..Options::default() };
        self.renderer = Some(Renderer::with_default_allocator(instance, hardware, device, rendering, options)?);
        Ok(())
    }

    /// Gives up what is on the device; before the presenter goes.
    pub fn close(&mut self) {
        self.renderer = None;
    }
}
