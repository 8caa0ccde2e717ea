//! `welkin compare`: how far one picture is from another.

use std::path::PathBuf;

use clap::Args;
use welkin::output::read_exr;
use welkin::report::{Comparison, MetricsError, compare};

use super::limit::Limit;
use super::{Failure, stdout};

/// Compare the radiance of two EXR files; exit 1 where they are farther apart than allowed
#[derive(Debug, Args)]
pub struct Arguments {
    /// The picture in question
    a: PathBuf,
    /// The reference, which errors are relative to
    b: PathBuf,
    /// Largest relative error allowed in any pixel and band, as in 0.02
    #[arg(long, value_name = "E")]
    max_relative: Option<Limit>,
    /// Largest mean FLIP error allowed, from 0 to 1
    #[arg(long, value_name = "F")]
    max_flip: Option<Limit>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Prints the metrics and holds them against the limits.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (a, b) = (read_exr(&arguments.a)?, read_exr(&arguments.b)?);
    let comparison = compare(&a, &b).map_err(|error| match error {
        MetricsError::Size { .. } | MetricsError::Channels { .. } => Failure::from(error),
        MetricsError::Radiance { .. } | MetricsError::BlackReference => Failure::Check(error.to_string()),
    })?;
    stdout::print(&if arguments.json { serde_json::to_string_pretty(&comparison)? } else { table(&comparison) })?;
    let limits = [
        ("relative error", comparison.relative_error.max, arguments.max_relative),
        ("mean FLIP error", comparison.mean_flip, arguments.max_flip),
    ];
    let over = |&(name, value, limit): &(&str, f64, Option<Limit>)| {
        let limit = limit.filter(|limit| value > limit.get())?;
        Some(format!("{name} is {value:.6}, allowed is {}", limit.get()))
    };
    let over: Vec<_> = limits.iter().filter_map(over).collect();
    if over.is_empty() { Ok(()) } else { Err(Failure::Check(over.join("; "))) }
}

fn table(comparison: &Comparison) -> String {
    let errors = &comparison.relative_error;
    let dark = match comparison.dark_values {
        0 => String::new(),
        count => format!(" ({count} of {} values are too dark for it)", comparison.values),
    };
    format!(
        "relative error   median {:.6}  p95 {:.6}  p99 {:.6}  max {:.6}\n\
         RMS ln ratio     {:.6}{dark}\n\
         energy ratio     {:.6}\n\
         mean FLIP error  {:.6}",
        errors.median,
        errors.p95,
        errors.p99,
        errors.max,
        comparison.rms_ln_ratio,
        comparison.energy_ratio,
        comparison.mean_flip
    )
}
