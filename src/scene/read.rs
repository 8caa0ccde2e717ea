//! From a scene file to a [`Scene`].

use std::path::Path;

use super::assemble::assemble;
use super::error::{InvalidField, SceneError};
use super::file::SceneFile;
use super::locate::Document;
use super::{Problem, Scene};

impl Scene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`SceneError::Read`] where the file cannot be read; [`SceneError::Invalid`] where it is not a scene.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let text = std::fs::read_to_string(path).map_err(|source| SceneError::Read { path: path.into(), source })?;
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        Self::parse(&text, &path.to_string_lossy(), &stem)
    }

    /// Checks the text of a scene file; `file` stands in messages, `default_name` names a scene without `name`.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the place of the first field that is not what it must be.
    pub fn parse(text: &str, file: &str, default_name: &str) -> Result<Self, SceneError> {
        let document = Document::new(text);
        let invalid = |span: &std::ops::Range<usize>, field: Option<String>, problem: String| {
            let place = document.place(span);
            SceneError::Invalid(Box::new(InvalidField { file: file.to_owned(), place, field, problem }))
        };
        let scene_file: SceneFile = toml::from_str(text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            invalid(&span, document.path_at(&span).map(str::to_owned), error.message().to_owned())
        })?;
        assemble(&scene_file, default_name).map_err(|Problem { field, message }| {
            let span = document.span_of(&field);
            invalid(&span, Some(field), message)
        })
    }
}
