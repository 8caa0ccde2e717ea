//! What keys and buttons ask for.

use std::path::{Path, PathBuf};
use std::time::Instant;

use winit::event_loop::EventLoopProxy;
use winit::window::Fullscreen;

use super::{Event, Open};
use crate::passes::RenderError;
use crate::plan::Quality;
use crate::window::aim::Aim;
use crate::window::capture::{self, Capture};
use crate::window::fly::rounded;
use crate::window::session::{SCENE_FAULT, SHADER_FAULT, Tone};
use crate::window::shortcuts::Action;

impl Open {
    /// Does what a key or button asks for; says whether the window is to close.
    pub(super) fn act(&mut self, action: Action, pictures: &Path, proxy: &EventLoopProxy<Event>) -> bool {
        let session = &mut self.session;
        match action {
            Action::Help => session.help = !session.help,
            Action::Panel => session.kept.panel = !session.kept.panel,
            Action::FullScreen => self.full_screen(self.window.fullscreen().is_none()),
            Action::Quit => return true,
            Action::Escape if session.help => session.help = false,
            Action::Escape => self.full_screen(false),
            Action::Save => session.save(PathBuf::from(&session.save_name)),
            Action::Reload => self.reload(true),
            Action::Undo => session.travel(true),
            Action::Redo => session.travel(false),
            Action::Screenshot => self.screenshot(pictures, proxy),
            Action::CopyCommand => self.copy_command(),
            Action::Play => session.playing = !session.playing,
            Action::Slower => session.kept.time_rate = (session.kept.time_rate / 2.0).max(1.0),
            Action::Faster => session.kept.time_rate = (session.kept.time_rate * 2.0).min(1e6),
            Action::Earlier => session.pass_time(-600.0, "time"),
            Action::Later => session.pass_time(600.0, "time"),
            Action::Truth => {
                self.comparison = None;
                session.truth = match session.truth {
                    Some(_) => None,
                    None => Some("truth: begins when nothing moves".to_owned()),
                };
            }
            Action::NextPair => session.wipe.turn(),
            Action::WipeLeft => session.wipe.shift(-0.02),
            Action::WipeRight => session.wipe.shift(0.02),
            Action::Darker | Action::Brighter => {
                let step = if action == Action::Darker { -1.0 } else { 1.0 } / 3.0;
                let exposure_ev = rounded(session.document.scene().display.exposure_ev + step);
                session.set("display.exposure_ev", Some(exposure_ev.into()));
            }
            Action::Quality(number) => {
                session.quality = Quality::ALL[number];
                session.kept.quality = session.quality.name().to_owned();
                session.aim(Aim::Quality);
            }
            Action::Aim(aim) => session.aim(aim),
        }
        self.window.request_redraw();
        false
    }

    fn full_screen(&mut self, whole: bool) {
        self.window.set_fullscreen(whole.then_some(Fullscreen::Borderless(None)));
    }

    /// Reads the scene's file again, which gives up edits where somebody has asked for it; a broken one changes nothing.
    pub(super) fn reload(&mut self, asked: bool) {
        let path = self.session.document.path().to_owned();
        let opened = match std::fs::read_to_string(&path) {
            // What was saved here comes back as a change of the file.
            Ok(text) if !asked && self.session.document.is_saved_as(&text) => return,
            Ok(text) => self.session.open(&text, &path).map_err(|error| error.to_string()),
            Err(error) => Err(format!("cannot read '{}': {error}", path.display())),
        };
        match opened {
            Ok(()) => self.session.say(Tone::Done, format!("read '{}'", path.display())),
            Err(problem) => self.session.fault(SCENE_FAULT, problem),
        }
    }

    /// Compiles the shaders of the folder, if one is watched, between two pictures.
    pub(super) fn take_shaders(&mut self) {
        let Some(folder) = self.shaders.clone() else { return };
        let proxy = self.proxy.clone();
        self.sky.between(move |renderer| {
            let taken = renderer.take_shaders_from(&folder).map_err(|error| error.to_string());
            let _ = proxy.send_event(Event::Shaders(taken));
        });
    }

    pub(super) fn shaders_taken(&mut self, result: Result<(), String>) {
        match result {
            Ok(()) => {
                self.session.faults[SHADER_FAULT] = None;
                self.session.say(Tone::Done, "shaders are compiled");
                // The same view looks otherwise now.
                self.asked = None;
                self.session.resolution.touch(Instant::now());
            }
            Err(problem) => self.session.fault(SHADER_FAULT, problem),
        }
    }

    fn screenshot(&mut self, folder: &Path, proxy: &EventLoopProxy<Event>) {
        let capture = match Capture::new(&self.session.document, self.size(), folder) {
            Ok(capture) => capture,
            Err(error) => return self.session.say(Tone::Failed, error.to_string()),
        };
        let (scene, settings, proxy) = (capture.scene.clone(), self.session.settings(), proxy.clone());
        self.sky.capture(scene, settings, capture::OUTPUTS, move |rendered: Result<_, RenderError>| {
            // Files are written beside the sky's work.
            std::thread::spawn(move || {
                let (tone, text) = match capture.write(rendered) {
                    Ok(files) => {
                        files.iter().for_each(|file| println!("{}", file.display()));
                        (Tone::Done, format!("wrote '{}', .exr and .toml", files[0].display()))
                    }
                    Err(error) => (Tone::Failed, error.to_string()),
                };
                let _ = proxy.send_event(Event::Said(tone, text));
            });
        });
        self.session.say(Tone::Done, "rendering a picture");
    }

    fn copy_command(&mut self) {
        let session = &mut self.session;
        let size = self.window.inner_size().into();
        let command = capture::command(&session.document, size, &session.render_options());
        println!("{command}");
        self.interface.context().copy_text(command);
        self.session.say(Tone::Done, "the command is in the clipboard, and on standard output");
    }
}
