//! What the command line asks for.

use clap::{Parser, ValueEnum};

/// Hold the reference against every row of the tables in `tests/reference`
///
/// Prints z-scores and the worst rows. Exit code 1 when a z-score beyond 5 says that the codes differ. RAYON_NUM_THREADS
/// bounds the cores in use.
#[derive(Debug, Parser)]
pub struct Options {
    /// The table
    pub table: Table,
    /// Take every N-th view or row
    #[arg(long, default_value = "1", value_name = "N", value_parser = clap::value_parser!(usize))]
    pub every: usize,
    /// Relative standard error to reach
    #[arg(long, default_value = "0.005", value_name = "E")]
    pub error: f64,
    /// Views of the sun at this zenith angle only
    #[arg(long, value_name = "DEGREES")]
    pub sun_deg: Option<f64>,
    /// Seed of the random numbers
    #[arg(long, default_value = "1")]
    pub seed: u64,
    /// Trace the radiances of slabs with the path tracer that pictures come from, in place of the slabs' own code
    #[arg(long)]
    pub path: bool,
    /// Keep answers in this file, and go on from those that it has
    #[arg(long, value_name = "FILE")]
    pub ledger: Option<String>,
}

/// Which table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Table {
    /// Radiance of the clear sky from 500 m
    Sky,
    /// Radiance of the clear sky from any altitude
    Views,
    /// Fluxes of homogeneous slabs
    Slab,
    /// Radiances of homogeneous slabs
    SlabRadiance,
}

impl Options {
    /// What a ledger of this run belongs to.
    pub fn identity(&self, file: &str) -> String {
        let by = if self.path { ", by paths" } else { "" };
        format!("{file}, error {}, seed {}{by}", self.error, self.seed)
    }
}
