//! `welkin schema`: the JSON schema of scene files.

use clap::Args;

use super::{Failure, stdout};

/// Print the JSON schema of scene files, for editors
#[derive(Debug, Args)]
pub struct Arguments {}

/// Prints the schema.
pub fn run(_: &Arguments) -> Result<(), Failure> {
    Ok(stdout::print(&format!("{:#}", welkin::scene::schema()))?)
}
