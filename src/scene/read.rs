//! From a scene file to a [`Scene`].

use std::ops::Range;
use std::path::Path;

use welkin_lut::spectrum::Channels;

use super::assemble::assemble;
use super::error::{InvalidField, SceneError};
use super::file::SceneFile;
use super::locate::Document;
use super::{Problem, Scene};

/// What a command asks of a scene's spectrum in place of what its file says.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SpectrumRequest {
    /// How many wavelengths, 3 to 40.
    pub wavelengths: Option<usize>,
    /// What the channels of a frame hold.
    pub channels: Option<Channels>,
}

impl Scene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`SceneError::Read`] where the file cannot be read; [`SceneError::Invalid`] where it is not a scene.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::read_with(path, SpectrumRequest::default())
    }

    /// The same with other wavelengths and colours than the file's.
    ///
    /// # Errors
    /// As [`Scene::read`]; also where a request does not go with the file.
    pub fn read_with(path: &Path, request: SpectrumRequest) -> Result<Self, SceneError> {
        let text = std::fs::read_to_string(path).map_err(|source| SceneError::Read { path: path.into(), source })?;
        Self::parse_with(&text, path, request)
    }

    /// Checks the text of a scene file. `path` stands in messages, names a scene without `name`, and is where tables
    /// that the scene names are looked for.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the place of the first field that is not what it must be.
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneError> {
        Self::parse_with(text, path, SpectrumRequest::default())
    }

    /// The same with other wavelengths and colours than the file's.
    ///
    /// # Errors
    /// As [`Scene::parse`]; also where a request does not go with the file.
    pub fn parse_with(text: &str, path: &Path, request: SpectrumRequest) -> Result<Self, SceneError> {
        let document = Document::new(text);
        let invalid = |span: &Range<usize>, field: Option<String>, problem: String| {
            let (file, place) = (path.display().to_string(), document.place(span));
            SceneError::Invalid(Box::new(InvalidField { file, place, field, problem }))
        };
        let scene_file: SceneFile = toml::from_str(text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            invalid(&span, document.path_at(&span).map(str::to_owned), error.message().to_owned())
        })?;
        assemble(&scene_file, path, request).map_err(|Problem { field, message }| {
            let span = document.span_of(&field);
            invalid(&span, Some(field), message)
        })
    }
}
