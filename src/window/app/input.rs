//! Keys, mouse and changes of the window.

use std::time::Instant;

use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::keyboard::{KeyCode, PhysicalKey};

use super::Open;
use crate::window::fly::rounded;
use crate::window::shortcuts;

impl Open {
    /// Handles an event; says whether the window is to close.
    pub(super) fn on_event(&mut self, event: &WindowEvent) -> bool {
        let (taken, repaint) = self.interface.on_event(&self.window, event);
        // A key that is held repeats itself; what it does is seen in the sky's pictures.
        let repeats = matches!(event, WindowEvent::KeyboardInput { event, .. } if event.repeat && !taken);
        if repaint && !repeats {
            self.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => return true,
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => {
                self.session.resolution.touch(Instant::now());
                self.window.request_redraw();
            }
            WindowEvent::Occluded(hidden) => self.hidden = *hidden,
            WindowEvent::Focused(false) => self.held.release(),
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers.state(),
            WindowEvent::KeyboardInput { event, .. } => self.on_key(event, taken),
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                let pressed = *state == ElementState::Pressed && !taken;
                let line = f64::from(self.session.wipe.at) * f64::from(self.window.inner_size().width);
                self.drags_line = pressed && self.comparison.is_some() && (self.pointer[0] - line).abs() < 8.0;
                self.drag = (pressed && !self.drags_line).then_some(self.pointer);
            }
            WindowEvent::CursorMoved { position, .. } => self.on_pointer([position.x, position.y]),
            WindowEvent::MouseWheel { delta, .. } if !taken => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, y) => f64::from(*y),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / 40.0,
                };
                let present = self.session.document.scene().camera.vertical_field_of_view_rad.to_degrees();
                let wanted = rounded((present * 0.92_f64.powf(notches)).clamp(0.5, 150.0));
                self.session.set("camera.vertical_field_of_view_deg", Some(wanted.into()));
            }
            _ => {}
        }
        false
    }

    fn on_key(&mut self, event: &KeyEvent, taken: bool) {
        let PhysicalKey::Code(code) = event.physical_key else { return };
        let down = event.state == ElementState::Pressed;
        if !event.repeat {
            self.held.change(code, down);
        }
        let focused = self.interface.context().memory(|memory| memory.focused());
        if down
            && code == KeyCode::Escape
            && let Some(field) = focused
        {
            self.interface.context().memory_mut(|memory| memory.surrender_focus(field));
            return;
        }
        let typing = taken || self.interface.context().wants_keyboard_input();
        if let Some(action) = shortcuts::action(code, self.modifiers)
            && down
            && (!typing || action.is_never_typed(code))
            && (!event.repeat || (!typing && action.is_a_step()))
        {
            self.session.asked.push(action);
            self.window.request_redraw();
        }
    }

    fn on_pointer(&mut self, at: [f64; 2]) {
        let before = std::mem::replace(&mut self.pointer, at);
        if self.drags_line {
            self.session.wipe.at = (at[0] / f64::from(self.window.inner_size().width.max(1))).clamp(0.0, 1.0) as f32;
            self.window.request_redraw();
        }
        if self.drag.is_none() {
            return;
        }
        // The point of the sky that was taken stays under the pointer.
        let camera = &self.session.document.scene().camera;
        let pixel_rad = camera.vertical_field_of_view_rad / f64::from(self.window.inner_size().height.max(1));
        self.session.look([(before[0] - at[0]) * pixel_rad, (at[1] - before[1]) * pixel_rad]);
    }
}
