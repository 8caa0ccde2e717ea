//! What the libraries have to say beside results and errors: on standard error.

use std::io::{self, IsTerminal as _};

use tracing_subscriber::EnvFilter;
use tracing_subscriber::filter::LevelFilter;

/// Says how much is shown, as in `debug` or `welkin::gpu=trace`; without it, warnings and errors.
const LOG_VARIABLE: &str = "WELKIN_LOG";

/// Shows warnings and errors, or what the variable asks for.
pub fn show() {
    let filter = EnvFilter::builder()
        .with_default_directive(LevelFilter::WARN.into())
        .with_env_var(LOG_VARIABLE)
        .from_env_lossy();
    let lines = tracing_subscriber::fmt().with_env_filter(filter).without_time().with_target(false);
    lines.with_writer(io::stderr).with_ansi(io::stderr().is_terminal()).init();
}
