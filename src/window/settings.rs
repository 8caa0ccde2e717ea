//! What is kept between runs, in the platform's own folder.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::aim::Aim;
use crate::output::{AtomicFile, OutputError};

/// Names another folder for the settings; an empty one keeps nothing.
pub const FOLDER_VARIABLE: &str = "WELKIN_CONFIG";

const FILE: &str = "window.json";

/// The window's settings. What a file of another version lacks has its default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Width and height of the window, logical pixels.
    pub size: [f64; 2],
    /// Whether the panel is shown.
    pub panel: bool,
    /// Milliseconds that a frame may take while anything moves.
    pub budget_ms: f64,
    /// Share of the window's side in which the sky is computed, in place of one that holds the budget.
    pub fixed_scale: Option<f64>,
    /// Low, medium, high or ultra.
    pub quality: String,
    /// What decides about the settings of pictures.
    pub aim: Aim,
    /// The error that is aimed at: root mean square of the relative error of radiance.
    pub target_error: f64,
    /// The time that is aimed at, of a picture at rest with all of its tables, ms.
    pub picture_ms: f64,
    /// Whether light above white is shown where the screen can.
    pub above_white: bool,
    /// Seconds of the scene in one of the clock.
    pub time_rate: f64,
    /// Share of the window's side in which the truth is computed.
    pub truth_scale: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: [1280.0, 720.0],
            panel: true,
            budget_ms: 33.0,
            fixed_scale: None,
            quality: "medium".to_owned(),
            aim: Aim::Quality,
            target_error: 0.02,
            picture_ms: 100.0,
            above_white: true,
            time_rate: 600.0,
            truth_scale: 0.25,
        }
    }
}

impl Settings {
    /// The settings of the last run, or the defaults; a file that cannot be understood is said and set aside.
    pub fn load(folder: Option<&Path>) -> Self {
        let Some(path) = folder.map(|folder| folder.join(FILE)) else { return Self::default() };
        let Ok(text) = std::fs::read_to_string(&path) else { return Self::default() };
        match serde_json::from_str::<Self>(&text) {
            Ok(settings) => settings.within_bounds(),
            Err(error) => {
                tracing::warn!("'{}' is not understood ({error}): the window starts with its defaults", path.display());
                Self::default()
            }
        }
    }

    /// Keeps them for the next run.
    ///
    /// # Errors
    /// [`OutputError`] where the folder cannot be written.
    pub fn save(&self, folder: Option<&Path>) -> Result<(), OutputError> {
        let Some(folder) = folder else { return Ok(()) };
        let failed = |source| OutputError::Write { path: folder.to_owned(), source };
        std::fs::create_dir_all(folder).map_err(failed)?;
        let text = serde_json::to_string_pretty(self).unwrap_or_default();
        AtomicFile::create(&folder.join(FILE))?.write_all(format!("{text}\n").as_bytes())
    }

    /// A file that was edited by hand may say anything.
    fn within_bounds(mut self) -> Self {
        let default = Self::default();
        let bound = |value: f64, low: f64, high: f64, otherwise: f64| match value.is_finite() {
            true => value.clamp(low, high),
            false => otherwise,
        };
        self.size = [0, 1].map(|axis| bound(self.size[axis], 200.0, 16_384.0, default.size[axis]));
        self.budget_ms = bound(self.budget_ms, 4.0, 1000.0, default.budget_ms);
        self.target_error = bound(self.target_error, 0.001, 0.5, default.target_error);
        self.picture_ms = bound(self.picture_ms, 1.0, 60_000.0, default.picture_ms);
        self.fixed_scale = self.fixed_scale.map(|scale| bound(scale, 0.1, 1.0, 1.0));
        self.time_rate = bound(self.time_rate, 1.0, 1e6, default.time_rate);
        self.truth_scale = bound(self.truth_scale, 0.05, 1.0, default.truth_scale);
        self
    }
}

/// The folder that a value of [`FOLDER_VARIABLE`] names, or the platform's own.
pub fn folder(named: Option<PathBuf>) -> Option<PathBuf> {
    match named {
        Some(folder) => (!folder.as_os_str().is_empty()).then_some(folder),
        None => directories::ProjectDirs::from("", "", "welkin").map(|places| places.config_dir().to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_kept_and_what_a_file_lacks_is_the_default() {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("not/yet/there");
        let settings = Settings { budget_ms: 50.0, panel: false, ..Settings::default() };
        settings.save(Some(&inside)).unwrap();
        assert_eq!(Settings::load(Some(&inside)), settings);
        std::fs::write(inside.join(FILE), "{\"budget_ms\": 1e9, \"unknown\": 1}").unwrap();
        assert_eq!(Settings::load(Some(&inside)), Settings { budget_ms: 1000.0, ..Settings::default() });
        std::fs::write(inside.join(FILE), "{\"budget_ms\": ").unwrap();
        assert_eq!(Settings::load(Some(&inside)), Settings::default());
        assert_eq!(folder_of_nothing(), None);
    }

    fn folder_of_nothing() -> Option<PathBuf> {
        folder(Some(PathBuf::new()))
    }
}
