//! The real-time sky against tables that other codes made: every row, every quality or other named setting; prints
//! Markdown.
//!
//! `cargo run --release --example validate_sky -- [--worst] [QUALITY...] [METHOD...]`, where a method is a treatment of multiple
//! scattering by its name: then only light of all orders is compared. `--worst` names the values that are farthest off.

#[path = "../tests/reference/sky.rs"]
mod sky;
#[path = "../tests/reference/tables.rs"]
mod tables;

use std::time::Instant;

use welkin::gpu::DeviceRequest;
use welkin::plan::{MultipleScattering, NamedSettings, Quality, Settings};
use welkin::probe::{Orders, RayRadiance};
use welkin::renderer::Renderer;

/// A table, which orders of scattering, the column that holds them, and the suns below the horizon it knows.
const COMPARISONS: [(&str, Orders, &str, &[f64]); 4] = [
    ("earth_sky.csv", Orders::Single, "single_quad", &[92.0, 94.0]),
    ("earth_sky.csv", Orders::All, "total_best", &[92.0, 94.0]),
    ("earth_views.csv", Orders::Single, "single", &[92.0, 95.0, 96.0, 99.0, 102.0]),
    ("earth_views.csv", Orders::All, "total", &[92.0, 95.0, 96.0, 99.0, 102.0]),
];

/// Values of each table that `--worst` names.
const WORST: usize = 16;

fn print_worst(rows: &[tables::Row], found: &[RayRadiance], column: &str) {
    let error = |i: usize| 100.0 * (found[i].radiance[rows[i].band()] / rows[i].number(column) - 1.0);
    let mut shining: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].number(column) > 0.0).collect();
    shining.sort_by(|&a, &b| error(b).abs().total_cmp(&error(a).abs()));
    for &i in shining.iter().take(WORST) {
        eprintln!("  {:+.2} %: {}", error(i), rows[i].line());
    }
}

fn main() {
    let mut qualities: Vec<NamedSettings> = Vec::new();
    let mut methods: Vec<MultipleScattering> = Vec::new();
    let (options, names): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word.starts_with('-'));
    for name in names {
        match (name.parse(), name.parse()) {
            (Ok(quality), _) => qualities.push(quality),
            (_, Ok(method)) => methods.push(method),
            (Err(not_a_quality), Err(not_a_method)) => panic!("{not_a_quality}; {not_a_method}"),
        }
    }
    if qualities.is_empty() {
        qualities = Quality::ALL.map(NamedSettings::Quality).to_vec();
    }
    let all_comparisons = methods.is_empty();
    let comparisons = COMPARISONS.iter().filter(|(_, orders, _, _)| all_comparisons || *orders == Orders::All);
    if methods.is_empty() {
        methods.push(MultipleScattering::Auto);
    }
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}).\n", info.name, info.driver, info.driver_version);
    println!("| table | orders | quality | sun 0-90°: median / p99 / max % | p99 % by lower sun | s |");
    println!("|---|---|---|---|---|---|");
    for &(file, orders, column, night) in comparisons {
        let rows = tables::read(file);
        for (&quality, &multiple_scattering) in qualities.iter().flat_map(|q| methods.iter().map(move |m| (q, m))) {
            let started = Instant::now();
            let named = quality.settings();
            let multiple_scattering = match multiple_scattering {
                MultipleScattering::Auto => named.multiple_scattering,
                method => method,
            };
            let settings = Settings { multiple_scattering, ..named };
            let found = sky::answers(&mut renderer, &rows, settings, orders, |_| {});
            let errors = sky::errors(&rows, &found, column);
            let day = [0.5, 0.99, 1.0].map(|q| format!("{:.3}", errors.quantile(q, 0.0..=90.0))).join(" / ");
            let low: Vec<_> =
                night.iter().map(|&sun| format!("{sun}°: {:.2}", errors.quantile(0.99, sun..=sun))).collect();
            let seconds = started.elapsed().as_secs_f64();
            let method = match multiple_scattering {
                MultipleScattering::Auto => String::new(),
                named => format!(", {named}"),
            };
            println!("| {file} | {orders:?} | {quality}{method} | {day} | {} | {seconds:.0} |", low.join(", "));
            if options.iter().any(|option| option == "--worst") {
                print_worst(&rows, &found, column);
            }
        }
    }
}
