//! Keys, what they do, and the words for both.

use winit::keyboard::{KeyCode, ModifiersState};

use super::aim::Aim;

/// What a key or a button asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action {
    /// Shows or hides the keys.
    Help,
    /// Shows or hides the panel.
    Panel,
    /// Fills the screen, or no longer.
    FullScreen,
    /// Closes the window.
    Quit,
    /// Closes what is open on top, or leaves the full screen.
    Escape,
    /// Writes the scene to its file.
    Save,
    /// Reads the scene's file again.
    Reload,
    /// Goes a step back.
    Undo,
    /// Goes a step forward.
    Redo,
    /// Writes a picture as PNG and EXR, and its scene.
    Screenshot,
    /// Copies the command that renders this picture.
    CopyCommand,
    /// Lets time run, or stops it.
    Play,
    /// Half or twice as fast.
    Slower,
    /// As above.
    Faster,
    /// Ten minutes back.
    Earlier,
    /// Ten minutes on.
    Later,
    /// Compares with the truth, or no longer.
    Truth,
    /// Compares the next pair of pictures.
    NextPair,
    /// Moves the line between them.
    WipeLeft,
    /// As above.
    WipeRight,
    /// Darker by a third of a stop.
    Darker,
    /// Brighter by a third of a stop.
    Brighter,
    /// The quality of this number, from the cheapest.
    Quality(usize),
    /// Settings for an error or a time in place of a quality.
    Aim(Aim),
}

impl Action {
    /// Whether a key asks for it while a field of the panel has the focus too.
    pub fn is_never_typed(self, code: KeyCode) -> bool {
        let is_function_key = matches!(code, KeyCode::F1 | KeyCode::F5 | KeyCode::F11 | KeyCode::F12);
        is_function_key || matches!(self, Self::Quit | Self::Save)
    }

    /// Whether a key that is held asks for it again and again: steps do, and what would be undone by its repetition does
    /// not.
    pub fn is_a_step(self) -> bool {
        matches!(
            self,
            Self::Undo
                | Self::Redo
                | Self::Slower
                | Self::Faster
                | Self::Earlier
                | Self::Later
                | Self::WipeLeft
                | Self::WipeRight
                | Self::Darker
                | Self::Brighter
        )
    }
}

/// A key with what it does.
pub struct Shortcut {
    code: KeyCode,
    control: bool,
    shift: bool,
    /// What it does.
    pub action: Action,
    /// The key in words.
    pub keys: &'static str,
    /// What it does in words.
    pub does: &'static str,
}

const fn key(code: KeyCode, action: Action, keys: &'static str, does: &'static str) -> Shortcut {
    Shortcut { code, control: false, shift: false, action, keys, does }
}

const fn control(code: KeyCode, action: Action, keys: &'static str, does: &'static str) -> Shortcut {
    Shortcut { code, control: true, shift: false, action, keys, does }
}

/// All of them, in the order of the help.
pub const SHORTCUTS: [Shortcut; 30] = [
    key(KeyCode::F1, Action::Help, "F1", "these keys"),
    key(KeyCode::KeyH, Action::Panel, "H", "the panel"),
    key(KeyCode::F11, Action::FullScreen, "F11", "full screen"),
    key(KeyCode::Escape, Action::Escape, "Esc", "close what is on top; leave a field or the full screen"),
    control(KeyCode::KeyQ, Action::Quit, "Ctrl Q", "close the window"),
    control(KeyCode::KeyS, Action::Save, "Ctrl S", "save the scene"),
    key(KeyCode::F5, Action::Reload, "F5", "read the scene's file again"),
    control(KeyCode::KeyZ, Action::Undo, "Ctrl Z", "undo"),
    control(KeyCode::KeyY, Action::Redo, "Ctrl Y", "redo"),
    key(KeyCode::F12, Action::Screenshot, "F12", "write a picture: PNG, EXR and its scene"),
    control(KeyCode::KeyC, Action::CopyCommand, "Ctrl C", "copy the command that renders this picture"),
    key(KeyCode::KeyP, Action::Play, "P", "let time run, or stop it"),
    key(KeyCode::Comma, Action::Slower, ",", "time runs half as fast"),
    key(KeyCode::Period, Action::Faster, ".", "time runs twice as fast"),
    key(KeyCode::BracketLeft, Action::Earlier, "[", "ten minutes earlier"),
    key(KeyCode::BracketRight, Action::Later, "]", "ten minutes later"),
    key(KeyCode::KeyT, Action::Truth, "T", "compare with the path tracer, or no longer"),
    key(KeyCode::KeyY, Action::NextPair, "Y", "compare the next pair of pictures"),
    key(KeyCode::KeyX, Action::WipeLeft, "X", "move the line between them to the left"),
    key(KeyCode::KeyC, Action::WipeRight, "C", "move it to the right"),
    key(KeyCode::Minus, Action::Darker, "-", "expose a third of a stop less"),
    key(KeyCode::Equal, Action::Brighter, "=", "expose a third of a stop more"),
    key(KeyCode::Digit1, Action::Quality(0), "1", "quality low"),
    key(KeyCode::Digit2, Action::Quality(1), "2", "quality medium"),
    key(KeyCode::Digit3, Action::Quality(2), "3", "quality high"),
    key(KeyCode::Digit4, Action::Quality(3), "4", "quality ultra"),
    key(KeyCode::Digit5, Action::Aim(Aim::Error), "5", "settings for the target error"),
    key(KeyCode::Digit6, Action::Aim(Aim::Time), "6", "settings for the time of a picture"),
    key(KeyCode::Slash, Action::Help, "/", "these keys"),
    Shortcut {
        code: KeyCode::KeyZ,
        control: true,
        shift: true,
        action: Action::Redo,
        keys: "Ctrl Shift Z",
        does: "redo",
    },
];

/// Keys that act while they are held, for the help.
pub const HELD: [(&str, &str); 6] = [
    ("W S A D", "fly forward, back, left, right; faster the higher one is"),
    ("E Q", "fly up, down"),
    ("arrows", "look around"),
    ("Shift", "fly eight times as fast"),
    ("mouse drag, wheel", "look around, widen or narrow the view"),
    ("Tab, Space, arrows", "go through the panel, press, change; Esc returns to flying"),
];

/// What a key asks for.
pub fn action(code: KeyCode, modifiers: ModifiersState) -> Option<Action> {
    let (control, shift) = (modifiers.control_key(), modifiers.shift_key());
    let fits = |shortcut: &&Shortcut| {
        shortcut.code == code && shortcut.control == control && (shortcut.shift == shift || !control)
    };
    SHORTCUTS.iter().find(fits).map(|shortcut| shortcut.action)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_does_two_things() {
        for (index, one) in SHORTCUTS.iter().enumerate() {
            let same =
                |other: &&Shortcut| (other.code, other.control, other.shift) == (one.code, one.control, one.shift);
            assert_eq!(SHORTCUTS.iter().position(|other| same(&other)), Some(index), "{}", one.keys);
        }
    }

    #[test]
    fn control_and_shift_make_another_key_of_it() {
        let control = ModifiersState::CONTROL;
        assert_eq!(action(KeyCode::KeyC, ModifiersState::empty()), Some(Action::WipeRight));
        assert_eq!(action(KeyCode::KeyC, control), Some(Action::CopyCommand));
        assert_eq!(action(KeyCode::KeyZ, control), Some(Action::Undo));
        assert_eq!(action(KeyCode::KeyZ, control | ModifiersState::SHIFT), Some(Action::Redo));
        assert_eq!(action(KeyCode::KeyK, ModifiersState::empty()), None);
        // In a field of the panel one writes letters, and saves by the same keys as elsewhere.
        assert!(Action::Save.is_never_typed(KeyCode::KeyS) && Action::Help.is_never_typed(KeyCode::F1));
        assert!(!Action::Truth.is_never_typed(KeyCode::KeyT) && !Action::Undo.is_never_typed(KeyCode::KeyZ));
    }
}
