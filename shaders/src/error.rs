//! What can be wrong with a shader, and where.

use std::fmt;
use std::path::PathBuf;

/// Why a pass could not be compiled.
#[derive(Debug, thiserror::Error)]
pub enum ShaderError {
    /// No file declares a pass of this name.
    #[error("there is no pass `{name}`; the passes are: {available}")]
    UnknownPass {
        /// The name that was asked for.
        name: String,
        /// Names of all passes.
        available: String,
    },
    /// A directory or file of shaders could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// What could not be read.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The WGSL is wrong: syntax, types, imports or validation.
    #[error("{location}: {message}")]
    Wgsl {
        /// Where.
        location: Location,
        /// What, in the words of naga or naga_oil.
        message: String,
    },
    /// Modules import each other.
    #[error("modules import each other: {chain}")]
    ImportCycle {
        /// Import paths, from the first module to itself.
        chain: String,
    },
    /// The file has no compute entry point `main`.
    #[error("{file}: a pass needs a compute entry point `main`, or `#define_import_path` if it is a module")]
    NoEntryPoint {
        /// The pass's file.
        file: String,
    },
    /// The pass uses a resource in a way that welkin's host side does not serve.
    #[error("{file}: binding `{binding}`: {reason}")]
    Binding {
        /// The pass's file.
        file: String,
        /// The variable.
        binding: String,
        /// What is not served, and what is.
        reason: String,
    },
    /// naga could not write a valid module in another language.
    #[error("{file}: cannot be written as {language}: {message}")]
    Export {
        /// The pass's file.
        file: String,
        /// The language's name.
        language: &'static str,
        /// naga's message.
        message: String,
    },
    /// naga could not write SPIR-V for a valid module.
    #[error("{file}: {message}")]
    Spirv {
        /// The pass's file.
        file: String,
        /// naga's message.
        message: String,
    },
}

/// A place in a WGSL file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The file's path.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in bytes, from 1.
    pub column: usize,
    /// The text of that line, as it stands in the file.
    pub source_line: String,
}

impl fmt::Display for Location {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}:{}: in `{}`", self.file, self.line, self.column, self.source_line.trim())
    }
}
