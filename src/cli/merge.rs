//! `welkin merge`: one picture from the parts that `welkin reference --shard` wrote.

use std::path::PathBuf;

use clap::Args;

use super::{Failure, exr_output};
use welkin::output::AtomicFile;
use welkin::reference::picture::{merge, read_part, write_part};

/// Join the parts of a picture that `welkin reference --shard I/N` wrote
#[derive(Debug, Args)]
pub struct Arguments {
    /// The parts, in any order
    #[arg(required = true, value_name = "PART")]
    parts: Vec<PathBuf>,
    /// Picture to write, an EXR file
    #[arg(short, long, value_name = "FILE", value_parser = exr_output)]
    output: PathBuf,
}

/// Joins the parts.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let output = AtomicFile::create(&arguments.output)?;
    let parts = arguments.parts.iter().map(|path| Ok((path.clone(), read_part(path)?)));
    let whole = merge(parts.collect::<Result<_, Failure>>()?)?;
    write_part(output, &whole)?;
    Ok(())
}
