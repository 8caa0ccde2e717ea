//! Holds the reference against every row of the tables in `tests/reference`, for which the tests have no time.
//!
//! `cargo run --release --example validate_reference -- sky|views|slab|slab-radiance`; `--help` has the options.

mod ledger;
mod options;
mod sky;
mod slab;
#[path = "../../tests/reference/tables.rs"]
mod tables;

use std::process::ExitCode;

use clap::Parser;

use options::{Options, Table};

fn main() -> ExitCode {
    let options = Options::parse();
    let differ = match options.table {
        Table::Sky => {
            let columns = sky::Columns {
                file: "earth_sky.csv",
                single: "single_quad",
                total: "total_best",
                error: "ms_mc_stderr",
            };
            sky::run(&columns, &options)
        }
        Table::Views => {
            let columns =
                sky::Columns { file: "earth_views.csv", single: "single", total: "total", error: "total_stderr" };
            sky::run(&columns, &options)
        }
        Table::Slab => slab::fluxes(&options),
        Table::SlabRadiance => slab::radiances(&options),
    };
    match differ {
        Ok(differ) => ExitCode::from(u8::from(differ)),
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
