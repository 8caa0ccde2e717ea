//! Why a file was not written or not read.

use std::path::PathBuf;

/// Why a file was not written or not read.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The file cannot be written; what was there before is untouched.
    #[error("cannot write '{}'", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The folder is missing.
    #[error("cannot write '{}': there is no folder '{}'; make it first", path.display(), folder.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The path names something that is not a file and must not be replaced by one.
    #[error("cannot write '{}': it exists and is not a regular file", path.display())]
    NotAFile {
        /// What stands there.
        path: PathBuf,
    },
    /// The pixels cannot be encoded.
    #[error("cannot encode '{}'", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the encoder says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The file is not an OpenEXR image that can be read.
    #[error("cannot read '{}' as an OpenEXR image", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the decoder says.
        source: exr::error::Error,
    },
    /// None of the channels that would do is there.
    #[error("'{}' has none of the channels {names}; it has {found}", path.display())]
    NoChannel {
        /// The file.
        path: PathBuf,
        /// The channels that would do.
        names: String,
        /// The channels that are there.
        found: String,
    },
    /// A channel that every frame has is missing.
    #[error("'{}' has no channel '{channel}'; a frame needs R, G and B", path.display())]
    MissingChannel {
        /// The file.
        path: PathBuf,
        /// The channel.
        channel: String,
    },
}
