//! egui in this window: its input from winit, its shapes to the presenter.

use std::collections::VecDeque;

use egui::epaint::Primitive;
use egui::{ClippedPrimitive, Color32, Context, FontDefinitions, FullOutput, TextureId, TexturesDelta, ViewportId};
use egui_ash_renderer::{DynamicRendering, Options, Renderer, RendererError};
use winit::event::WindowEvent;
use winit::window::Window;

use crate::gpu::{FRAMES_IN_FLIGHT, GpuError, OverlayTarget, Placed, Presenter, ScreenEncoding};
use crate::output::screen::{WHITE_CD_PER_M2, perceptual_quantizer};

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
    /// What the renderer was made for.
    encoding: ScreenEncoding,
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
            encoding: ScreenEncoding::Srgb,
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
        if !self.start(presenter)? {
            return Ok(false);
        }
        let Some(renderer) = &mut self.renderer else { return Ok(false) };
        let changes = std::mem::take(&mut self.changes);
        if !changes.set.is_empty() {
            presenter.upload(|queue, pool| renderer.set_textures(queue, pool, &changes.set))?;
        }
        if self.encoding == ScreenEncoding::Hdr10 {
            dim(&mut self.primitives);
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

    /// Makes the renderer when there is something to draw on, and anew when the screen wants another encoding; false where
    /// the panel's textures have to come first, with the next layout.
    fn start(&mut self, presenter: &mut Presenter) -> Result<bool, InterfaceError> {
        let Some(color_attachment_format) = presenter.format() else { return Ok(false) };
        let encoding = presenter.encoding();
        if self.renderer.is_some() && encoding == self.encoding {
            return Ok(true);
        }
        let first = self.renderer.is_none();
        presenter.wait_idle()?;
        (self.renderer, self.encoding) = (None, encoding);
        self.unused.clear();
        let raw = presenter.raw_device();
        let (instance, hardware, device) = (raw.instance, raw.physical_device, raw.device.clone());
        let rendering = DynamicRendering { color_attachment_format, depth_attachment_format: None };
        // In linear light the panel is blended as light, and its white is that of the screen's own surfaces.
        let srgb_framebuffer = encoding == ScreenEncoding::ExtendedLinear;
        let options = Options { in_flight_frames: FRAMES_IN_FLIGHT + 1, srgb_framebuffer, ..Options::default() };
        self.renderer = Some(Renderer::with_default_allocator(instance, hardware, device, rendering, options)?);
        if !first {
            // egui gives its glyphs to a renderer once; new fonts are new glyphs.
            self.changes = TexturesDelta::default();
            self.context.set_fonts(FontDefinitions::default());
        }
        Ok(first)
    }

    /// Gives up what is on the device; before the presenter goes.
    pub fn close(&mut self) {
        self.renderer = None;
    }
}

/// Colours of the panel on a screen whose codes reach up to 10 000 cd/m²: white as bright as that of the pictures.
fn dim(primitives: &mut [ClippedPrimitive]) {
    let white = perceptual_quantizer(WHITE_CD_PER_M2);
    for primitive in primitives {
        let Primitive::Mesh(mesh) = &mut primitive.primitive else { continue };
        for vertex in &mut mesh.vertices {
            let [red, green, blue, alpha] = vertex.color.to_array();
            let [red, green, blue] = [red, green, blue].map(|byte| (f64::from(byte) * white).round() as u8);
            vertex.color = Color32::from_rgba_premultiplied(red, green, blue, alpha);
        }
    }
}
