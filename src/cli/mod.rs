//! The command line: one file per subcommand.

mod backend;
mod compare;
mod explain;
mod failure;
mod limit;
mod pass_table;
mod probe;
mod render;
mod schema;
mod stdout;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use failure::Failure;

/// Skies, clouds and fog in real time on Vulkan, with a stated error.
///
/// Results go to standard output or the named file, everything else to standard error. Exit codes: 0 done; 1 a comparison
/// or check failed; 2 bad input; 3 no usable Vulkan device.
#[derive(Debug, Parser)]
#[command(name = "welkin", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Compare(compare::Arguments),
    Explain(explain::Arguments),
    Probe(probe::Arguments),
    Render(render::Arguments),
    Schema(schema::Arguments),
}

/// Runs the program on the process's arguments.
pub fn run() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Probe(arguments) => probe::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            failure.exit_code()
        }
    }
}
