//! How a command ends when it does not succeed.

use std::error::Error;
use std::fmt;
use std::path::PathBuf;
use std::process::ExitCode;

/// Exit code of a command that was interrupted: 128 and the number of SIGINT, as shells count.
pub const INTERRUPTED: u8 = 130;

/// Why a command did not succeed, by exit code.
#[derive(Debug)]
pub enum Failure {
    /// A comparison or check failed; the message says by how much. Exit code 1.
    Check(String),
    /// What the user gave cannot be used. Exit code 2.
    Input(anyhow::Error),
    /// There is no usable Vulkan device. Exit code 3.
    NoDevice(anyhow::Error),
    /// The user interrupted; `--resume` goes on from the checkpoint, where there is one. Exit code [`INTERRUPTED`].
    Interrupted(Option<PathBuf>),
    /// The user interrupted, and the same command goes on where it was. Exit code [`INTERRUPTED`].
    Paused,
}

impl Failure {
    /// The exit code that scripts rely on.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Check(_) => 1,
            Self::Input(_) => 2,
            Self::NoDevice(_) => 3,
            Self::Interrupted(_) | Self::Paused => INTERRUPTED,
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
            Self::Check(message) => write!(f, "failed: {message}"),
            Self::Interrupted(Some(checkpoint)) => {
                write!(f, "interrupted; --resume goes on from '{}'", checkpoint.display())
            }
            Self::Interrupted(None) => {
                write!(f, "interrupted, nothing is written; `welkin reference` keeps what it has reached")
            }
            Self::Paused => write!(f, "interrupted; the same command goes on where it was"),
            // The alternate form joins an error with its causes.
            Self::Input(error) | Self::NoDevice(error) => write!(f, "error: {error:#}"),
        }
    }
}
