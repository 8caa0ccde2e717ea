//! What can be wrong with a pack.

use std::path::PathBuf;

/// Why a pack was not written or is refused.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    /// The folder holds no pack.
    #[error("'{}' holds no manifest.json; it is no pack, or one that was not written whole", folder.display())]
    NoPack {
        /// The folder.
        folder: PathBuf,
    },
    /// The manifest is no JSON, or lacks what it must have.
    #[error("'{}' is no manifest of a pack: {reason}", path.display())]
    Manifest {
        /// The manifest.
        path: PathBuf,
        /// What is wrong, with line and column.
        reason: String,
    },
    /// The pack is of another version.
    #[error("'{}' is of version {found}; this program reads version {known}, so bake the pack anew", path.display())]
    Version {
        /// The manifest.
        path: PathBuf,
        /// Its version.
        found: u64,
        /// The version that is read.
        known: u32,
    },
    /// A file of the manifest is not there.
    #[error("'{}' is missing; the manifest lists it", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// A file is shorter or longer than the manifest says.
    #[error("'{}' has {found} bytes; the manifest says {expected}", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// By the manifest.
        expected: u64,
        /// On disk.
        found: u64,
    },
    /// A file's content is not what was written.
    #[error("'{}' was changed: its SHA-256 is {found}, the manifest says {expected}", path.display())]
    Changed {
        /// The file.
        path: PathBuf,
        /// By the manifest.
        expected: String,
        /// Of the content.
        found: String,
    },
    /// A file lies there that the manifest does not list.
    #[error("'{}' is not in the manifest; it does not belong to the pack", path.display())]
    Unlisted {
        /// The file.
        path: PathBuf,
    },
    /// A file's container cannot be read, or is not of the size and format that the manifest says.
    #[error("'{}' cannot be read: {reason}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// Two files that must hold the same texels do not.
    #[error("'{}' holds other texels than '{}'", path.display(), other.display())]
    Differs {
        /// The file.
        path: PathBuf,
        /// The file that it was compared with.
        other: PathBuf,
    },
    /// The tables do not answer a probe as the pack says.
    #[error("probe {probe} of {quantity} in {precision} is {found:?}; the pack says {expected:?}")]
    Probe {
        /// Its index.
        probe: usize,
        /// What was asked for.
        quantity: &'static str,
        /// Of the tables.
        precision: &'static str,
        /// By the pack.
        expected: [f64; 3],
        /// From the tables.
        found: [f64; 3],
    },
    /// The folder has something in it that is no pack.
    #[error("'{}' exists and is not a pack; name another folder, or empty it", folder.display())]
    Occupied {
        /// The folder.
        folder: PathBuf,
    },
    /// A table cannot be encoded.
    #[error("cannot encode '{name}': {reason}")]
    Encode {
        /// The file's name.
        name: String,
        /// What the encoder says.
        reason: String,
    },
    /// The system refuses to read or write.
    #[error("cannot access '{}'", path.display())]
    File {
        /// What.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}
