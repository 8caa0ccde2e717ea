//! The command line: one file per subcommand.

mod accuracy;
mod backend;
mod bake;
mod bench;
mod compare;
mod explain;
mod failure;
mod goal;
mod limit;
mod log;
mod merge;
mod pass_table;
mod phase_argument;
mod probe;
mod reference;
mod render;
mod report;
mod schema;
mod shaders;
mod slab;
mod solver;
mod spectrum;
mod stdout;
mod watch;
#[cfg(feature = "window")]
mod window;

use std::path::PathBuf;
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
    Bake(bake::Arguments),
    Bench(bench::Arguments),
    Compare(compare::Arguments),
    Explain(explain::Arguments),
    Merge(merge::Arguments),
    Probe(probe::Arguments),
    Reference(reference::Arguments),
    Render(render::Arguments),
    Report(report::Arguments),
    Schema(schema::Arguments),
    Shaders(shaders::Arguments),
    Slab(slab::Arguments),
    #[cfg(feature = "window")]
    Window(window::Arguments),
}

/// Runs the program on the process's arguments.
pub fn run() -> ExitCode {
    log::show();
    let outcome = match Cli::parse().command {
        Command::Bake(arguments) => bake::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Probe(arguments) => probe::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Reference(arguments) => reference::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
        Command::Shaders(arguments) => shaders::run(&arguments),
        Command::Slab(arguments) => slab::run(&arguments),
        #[cfg(feature = "window")]
        Command::Window(arguments) => window::run(&arguments),
    };
    match outcome.and_then(|()| backend::check_validation()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            failure.exit_code()
        }
    }
}

/// The name of an EXR file to write.
fn exr_output(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("exr") => Ok(path),
        _ => Err(format!("'{text}' does not end in .exr; the standard errors need an EXR file")),
    }
}
