//! Holds the reference against every row of the tables in `tests/reference`, for which the tests have no time.
//!
//! `cargo run --release --example validate_reference -- sky|views|slab|slab-radiance [--every N] [--error E] [--sun DEG]`
//!
//! Prints z-scores and the worst rows. Exit code 1 when a z-score beyond 5 says that the codes differ.

mod sky;
mod slab;
#[path = "../../tests/reference/tables.rs"]
mod tables;

use std::process::ExitCode;

use welkin::reference::Effort;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| -> Option<f64> {
        let at = arguments.iter().position(|a| a == name)?;
        Some(arguments.get(at + 1)?.parse().expect("an option's value is a number"))
    };
    let every = option("--every").unwrap_or(1.0) as usize;
    let error = option("--error").unwrap_or(0.004);
    let effort = Effort::RelativeError(error);
    let differ = match arguments.first().map(String::as_str) {
        Some("sky") => {
            let columns = sky::Columns {
                file: "earth_sky.csv",
                single: "single_quad",
                total: "total_best",
                error: "ms_mc_stderr",
            };
            sky::run(&columns, every, option("--sun"), effort)
        }
        Some("views") => {
            let columns =
                sky::Columns { file: "earth_views.csv", single: "single", total: "total", error: "total_stderr" };
            sky::run(&columns, every, option("--sun"), effort)
        }
        Some("slab") => slab::fluxes(every, error),
        Some("slab-radiance") => slab::radiances(every),
        _ => {
            eprintln!("usage: validate_reference sky|views|slab|slab-radiance [--every N] [--error E] [--sun DEGREES]");
            return ExitCode::from(2);
        }
    };
    ExitCode::from(u8::from(differ))
}
