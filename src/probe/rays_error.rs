//! Why a file of rays was refused.

use std::path::PathBuf;

/// Why a file of rays was refused.
#[derive(Debug, thiserror::Error)]
pub enum RaysError {
    /// The file cannot be read.
    #[error("cannot read the rays '{}'", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is not CSV, or a row has more or fewer fields than the header.
    #[error("'{}' is not a table", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the line.
        source: csv::Error,
    },
    /// A column is missing, or there twice.
    #[error("{}:1: column '{column}' is there {count} times; it must be there once, and the header has: {header}", path.display())]
    Column {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
        /// How often it is there.
        count: usize,
        /// All columns that are.
        header: String,
    },
    /// A column that the result will have is there already.
    #[error("{}:1: column '{column}' is what the result adds; rename it", path.display())]
    Reserved {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
    },
    /// A value is not what its column holds.
    #[error("{}:{line}: column '{column}' is '{value}'; it must be {allowed}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// The column.
        column: &'static str,
        /// The value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
}
