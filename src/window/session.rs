//! What one looks at and how: everything but the window and the device.

use std::path::{Path, PathBuf};
use std::time::Instant;

use toml::{Table, Value};

use super::aim::{Aim, Chooser, Chosen};
use super::day::{self, DayPath};
use super::document::{Document, set};
use super::fly::{self, Motion, rounded};
use super::graph::Graph;
use super::history::History;
use super::resolution::Resolution;
use super::settings::Settings as Kept;
use super::shortcuts::Action;
use crate::goal::Goal;
use crate::gpu::ScreenEncoding;
use crate::plan::{MultipleScattering, Quality, Rung, Settings, Skipping};
use crate::renderer::Timings;
use crate::scene::{Scene, SceneError};

/// How a message is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// Something was done.
    Done,
    /// Something could not be done; all is as before.
    Failed,
}

/// What the panel shows and changes.
pub struct Session {
    /// The scene's file.
    pub document: Document,
    /// Earlier states of it.
    pub history: History,
    /// What is kept between runs.
    pub kept: Kept,
    /// What the sky's accuracy is worth.
    pub quality: Quality,
    /// How light scattered more than once is computed.
    pub multiple_scattering: MultipleScattering,
    /// Settings for an error or a time in place of the quality.
    pub chooser: Chooser,
    /// How many pixels.
    pub resolution: Resolution,
    /// Whether time runs.
    pub playing: bool,
    /// What the last picture took, by passes.
    pub timings: Option<Timings>,
    /// Times of past frames.
    pub graph: Graph,
    /// The last thing to say.
    pub message: Option<(Tone, String)>,
    /// What is wrong as long as it is: with the scene's file, with the shaders, with the picture.
    pub faults: [Option<String>; 3],
    /// What the truth's state is, in words; none where it is off.
    pub truth: Option<String>,
    /// How the truth is shown.
    pub wipe: super::wipe::Wipe,
    /// Whether the keys are shown.
    pub help: bool,
    /// The name under which the panel would save.
    pub save_name: String,
    /// What was asked for with the panel, for the window to do.
    pub asked: Vec<Action>,
    /// Where the device's name is shown.
    pub device: String,
    /// How the screen wants pictures.
    pub encoding: ScreenEncoding,
    /// Whether it could show light above white.
    pub offers_above_white: bool,
}

/// Numbers of [`Session::faults`].
pub const SCENE_FAULT: usize = 0;
/// As above.
pub const SHADER_FAULT: usize = 1;
/// As above.
pub const PICTURE_FAULT: usize = 2;

impl Session {
    /// Of a scene, with the settings of the last run.
    pub fn new(document: Document, kept: Kept, now: Instant) -> Self {
        let mut resolution = Resolution::new(kept.budget_ms, now);
        resolution.fixed = kept.fixed_scale;
        Self {
            save_name: document.path().display().to_string(),
            quality: kept.quality.parse().unwrap_or_default(),
            multiple_scattering: MultipleScattering::default(),
            chooser: Chooser::default(),
            document,
            history: History::default(),
            kept,
            resolution,
            playing: false,
            timings: None,
            graph: Graph::default(),
            message: None,
            faults: Default::default(),
            truth: None,
            wipe: Default::default(),
            help: false,
            asked: Vec::new(),
            device: String::new(),
            encoding: ScreenEncoding::Srgb,
            offers_above_white: false,
        }
    }

    /// What is aimed at besides a quality.
    pub fn goal(&self) -> Option<Goal> {
        match self.kept.aim {
            Aim::Quality => None,
            Aim::Error => Some(Goal::TargetError(self.kept.target_error)),
            Aim::Time => Some(Goal::BudgetMs(self.kept.picture_ms)),
        }
    }

    /// The settings that were chosen for what is aimed at, in numbers; those of the quality where none were.
    pub fn settings(&self) -> Settings {
        match self.goal().and_then(|goal| self.chooser.step(goal)) {
            Some(step) => step.settings(),
            None => Settings { multiple_scattering: self.multiple_scattering, ..Settings::of(self.quality) },
        }
    }

    /// What was chosen for what is aimed at.
    pub fn chosen(&self) -> Option<&Chosen> {
        self.chooser.chosen(self.goal()?)
    }

    /// Aims at something else.
    pub fn aim(&mut self, aim: Aim) {
        self.kept.aim = aim;
        self.resolution.touch(Instant::now());
    }

    /// The options of `welkin render` that stand for the settings of pictures. Goals are not among them: on the command line they are
    /// tried on the scene, which may lead to other settings than here.
    pub fn render_options(&self) -> String {
        let step = self.chosen().and_then(|chosen| chosen.step);
        let quality = step.map_or(Rung::of(self.quality), |step| step.rung);
        match self.settings().multiple_scattering {
            MultipleScattering::Auto => format!("--quality {quality}"),
            method => format!("--quality {quality} --multiple-scattering {method}"),
        }
    }

    /// The same for pictures that follow each other: while time runs, tables may lag behind the sun.
    pub fn settings_in_motion(&self) -> Settings {
        Settings { skipping: Skipping::IN_SEQUENCE, ..self.settings() }
    }

    /// The scene as a window of so many pixels sees it.
    pub fn scene_of_size(&self, [width, height]: [u32; 2], scale: f64) -> Scene {
        let mut scene = Scene::clone(self.document.scene());
        let pixels = |size: u32| ((f64::from(size) * scale).round() as u32).max(1);
        (scene.camera.width, scene.camera.height) = (pixels(width), pixels(height));
        scene
    }

    /// Changes the scene, as one step with edits of the same kind just before it.
    pub fn edit(&mut self, kind: &str, change: impl FnOnce(&mut Table)) {
        let before = self.document.table().clone();
        match self.document.edit(change) {
            Ok(()) if *self.document.table() != before => {
                self.history.note(kind, &before, Instant::now());
                self.resolution.touch(Instant::now());
                self.faults[SCENE_FAULT] = None;
            }
            Ok(()) => {}
            Err(problem) => self.say(Tone::Failed, problem),
        }
    }

    /// Sets a field, or takes it away.
    pub fn set(&mut self, path: &str, value: Option<Value>) {
        self.edit(path, |table| set(table, path, value));
    }

    /// Goes a step back or forward.
    pub fn travel(&mut self, back: bool) {
        let table = self.document.table().clone();
        let target = if back { self.history.undo(&table) } else { self.history.redo(&table) };
        let Some(target) = target else {
            return self.say(Tone::Failed, format!("nothing to {}", if back { "undo" } else { "redo" }));
        };
        if let Err(problem) = self.document.restore(&target) {
            self.say(Tone::Failed, problem);
        }
        self.resolution.touch(Instant::now());
    }

    /// Lets seconds pass: flight, and the time of the scene where it runs. Says whether anything changed.
    pub fn advance(&mut self, seconds: f64, motion: Motion) -> bool {
        let scene = self.document.scene().clone();
        if !motion.is_still() {
            self.edit("flight", |table| fly::fly(table, &scene, motion, seconds));
        }
        if self.playing {
            self.pass_time(seconds * self.kept.time_rate, "time");
        }
        self.playing || !motion.is_still()
    }

    /// Turns the camera by angles, rad.
    pub fn look(&mut self, turned: [f64; 2]) {
        let scene = self.document.scene().clone();
        self.edit("flight", |table| fly::look(table, &scene, turned));
    }

    /// Lets time of the scene pass: clouds drift, and the sun moves by its date or on its path over 45° north.
    pub fn pass_time(&mut self, seconds: f64, kind: &str) {
        let time_s = (self.document.scene().time_s + seconds).clamp(-1e10, 1e10);
        let date = self.date();
        let (path, hour) = self.day_path();
        let sun = path.at(hour + seconds / 3600.0);
        self.edit(kind, |table| {
            set(table, "time_s", Some(rounded(time_s).into()));
            match date {
                Some(date) => {
                    if let Some(date) = day::later(date, seconds) {
                        set(table, "sun.when.date_time", Some(Value::Datetime(date)));
                    }
                }
                None => fly::point(table, "sun", sun.to_vector()),
            }
        });
    }

    /// The date of the sun, where the scene has one.
    pub fn date(&self) -> Option<toml::value::Datetime> {
        self.document.get("sun.when.date_time").and_then(|value| value.as_datetime()).copied()
    }

    /// The path of the sun in a day, and its hour on it.
    pub fn day_path(&self) -> (DayPath, f64) {
        use crate::scene::{Direction, Light};
        let sun = self.document.scene().lights.iter().find_map(|light| match light {
            Light::Directional(light) => Some(light.direction),
            _ => None,
        });
        DayPath::through(sun.unwrap_or(Direction { elevation_rad: 0.5, azimuth_rad: std::f64::consts::PI }))
    }

    /// Opens another scene, as a step that can be undone.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn open(&mut self, text: &str, path: &Path) -> Result<(), SceneError> {
        let document = Document::new(text, path)?;
        self.history.note("open", self.document.table(), Instant::now());
        self.document = document;
        self.save_name = path.display().to_string();
        self.faults[SCENE_FAULT] = None;
        self.resolution.touch(Instant::now());
        Ok(())
    }

    /// Writes the scene to a file.
    pub fn save(&mut self, path: PathBuf) {
        let written =
            crate::output::AtomicFile::create(&path).and_then(|file| file.write_all(self.document.text().as_bytes()));
        match written {
            Ok(()) => {
                self.document.saved_as(&path);
                self.say(Tone::Done, format!("saved '{}'", path.display()));
            }
            Err(error) => self.say(Tone::Failed, error.to_string()),
        }
    }

    /// Notes what is wrong until it is mended.
    pub fn fault(&mut self, number: usize, problem: String) {
        tracing::warn!("{problem}");
        self.faults[number] = Some(problem);
    }

    /// Says something.
    pub fn say(&mut self, tone: Tone, text: impl Into<String>) {
        let text = text.into();
        match tone {
            Tone::Done => tracing::info!("{text}"),
            Tone::Failed => tracing::warn!("{text}"),
        }
        self.message = Some((tone, text));
    }

    /// The window's title.
    pub fn title(&self) -> String {
        let star = if self.document.is_modified() { " *" } else { "" };
        format!("welkin: {}{star}", self.document.scene().name)
    }
}
