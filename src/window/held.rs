//! Keys that are held, as motion.

use std::collections::HashSet;

use glam::DVec3;
use winit::keyboard::KeyCode;

use super::fly::Motion;

/// Speed with Shift, as a factor.
const HASTE: f64 = 8.0;

/// Keys that are held down.
#[derive(Debug, Default)]
pub struct Held(HashSet<KeyCode>);

impl Held {
    /// A key went down or up. With Ctrl it is another key, and stays that when Ctrl is let go before it: who saves does
    /// not fly.
    pub fn change(&mut self, code: KeyCode, down: bool) {
        match down {
            true if self.control() => {}
            true => drop(self.0.insert(code)),
            false => drop(self.0.remove(&code)),
        }
    }

    /// The window has lost the keyboard: who knows what is held now.
    pub fn release(&mut self) {
        self.0.clear();
    }

    /// What they ask for; nothing while Ctrl is held.
    pub fn motion(&self) -> Motion {
        if self.control() {
            return Motion::default();
        }
        let axis =
            |more, less| f64::from(i8::from(self.0.contains(&more))) - f64::from(i8::from(self.0.contains(&less)));
        let along = DVec3::new(
            axis(KeyCode::KeyD, KeyCode::KeyA),
            axis(KeyCode::KeyW, KeyCode::KeyS),
            axis(KeyCode::KeyE, KeyCode::KeyQ),
        );
        let turn = [axis(KeyCode::ArrowRight, KeyCode::ArrowLeft), axis(KeyCode::ArrowUp, KeyCode::ArrowDown)];
        let haste = if self.either(KeyCode::ShiftLeft, KeyCode::ShiftRight) { HASTE } else { 1.0 };
        Motion { along, turn, haste }
    }

    fn control(&self) -> bool {
        self.either(KeyCode::ControlLeft, KeyCode::ControlRight)
    }

    fn either(&self, left: KeyCode, right: KeyCode) -> bool {
        self.0.contains(&left) || self.0.contains(&right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposite_keys_cancel_and_control_flies_nowhere() {
        let mut held = Held::default();
        held.change(KeyCode::KeyW, true);
        assert_eq!(held.motion().along, DVec3::Y);
        held.change(KeyCode::KeyS, true);
        assert!(held.motion().is_still());
        held.change(KeyCode::KeyS, false);
        held.change(KeyCode::ControlLeft, true);
        assert!(held.motion().is_still());
        held.change(KeyCode::ControlLeft, false);
        assert_eq!(held.motion().along, DVec3::Y, "it was held before");
        held.release();
        assert!(held.motion().is_still());
    }

    #[test]
    fn ctrl_s_flies_nowhere_whichever_of_its_keys_is_let_go_first() {
        let mut held = Held::default();
        held.change(KeyCode::ControlLeft, true);
        held.change(KeyCode::KeyS, true);
        held.change(KeyCode::ControlLeft, false);
        assert!(held.motion().is_still());
        held.change(KeyCode::KeyS, false);
        held.change(KeyCode::KeyS, true);
        assert_eq!(held.motion().along, DVec3::NEG_Y);
    }
}
