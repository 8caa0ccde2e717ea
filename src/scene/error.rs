//! Why a scene file was refused.

use std::fmt;
use std::path::PathBuf;

use super::locate::Place;

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read the scene '{}'", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file says something that is not a scene.
    #[error(transparent)]
    Invalid(Box<InvalidField>),
}

/// A field that is not what it must be: where it stands, what it says and what is allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct InvalidField {
    /// The file, as the user named it.
    pub file: String,
    /// Where in the file.
    pub place: Place,
    /// The field's path, as in `medium[0].profile.layer.top_m`; none where the file is not TOML.
    pub field: Option<String>,
    /// What is wrong, with the value and what is allowed.
    pub problem: String,
}

impl fmt::Display for InvalidField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Place { line, column, text, length } = &self.place;
        write!(f, "{}:{line}:{column}: ", self.file)?;
        if let Some(field) = &self.field {
            write!(f, "{field}: ")?;
        }
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        let indent = " ".repeat(column - 1);
        writeln!(f, "{}", self.problem)?;
        writeln!(f, " {number} | {text}")?;
        write!(f, " {margin} | {indent}{}", "^".repeat(*length))
    }
}
