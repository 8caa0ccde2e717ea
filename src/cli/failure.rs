//! How a command ends when it does not succeed.

use std::error::Error;
use std::fmt;
use std::process::ExitCode;

/// Why a command did not succeed, by exit code.
#[derive(Debug)]
pub enum Failure {
    /// What the user gave cannot be used. Exit code 2.
    Input(anyhow::Error),
}

impl Failure {
    /// The exit code that scripts rely on.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Input(_) => 2,
        })
    }
}

/// Every error is about input, unless a command says otherwise.
impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Input(anyhow::Error::new(error))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // The alternate form joins an error with its causes.
            Self::Input(error) => write!(f, "error: {error:#}"),
        }
    }
}
