//! The real-time sky against tables that other codes made: every row, every quality; prints Markdown.
//!
//! `cargo run --release --example validate_sky [QUALITY...]`

#[path = "../tests/reference/sky.rs"]
mod sky;
#[path = "../tests/reference/tables.rs"]
mod tables;

use std::time::Instant;

use welkin::gpu::DeviceRequest;
use welkin::plan::{Quality, Settings};
use welkin::probe::Orders;
use welkin::renderer::Renderer;

/// A table, which orders of scattering, the column that holds them, and the suns below the horizon it knows.
const COMPARISONS: [(&str, Orders, &str, &[f64]); 4] = [
    ("earth_sky.csv", Orders::Single, "single_quad", &[92.0, 94.0]),
    ("earth_sky.csv", Orders::All, "total_best", &[92.0, 94.0]),
    ("earth_views.csv", Orders::Single, "single", &[92.0, 95.0, 96.0, 99.0, 102.0]),
    ("earth_views.csv", Orders::All, "total", &[92.0, 95.0, 96.0, 99.0, 102.0]),
];

fn main() {
    let named: Vec<Quality> =
        std::env::args().skip(1).map(|name| name.parse().unwrap_or_else(|e| panic!("{e}"))).collect();
    let qualities = if named.is_empty() { Quality::ALL.to_vec() } else { named };
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}).\n", info.name, info.driver, info.driver_version);
    println!("| table | orders | quality | sun 0-90°: median / p99 / max % | p99 % by lower sun | s |");
    println!("|---|---|---|---|---|---|");
    for (file, orders, column, night) in COMPARISONS {
        let rows = tables::read(file);
        for &quality in &qualities {
            let started = Instant::now();
            let found = sky::answers(&mut renderer, &rows, Settings::of(quality), orders, |_| {});
            let errors = sky::errors(&rows, &found, column);
            let day = [0.5, 0.99, 1.0].map(|q| format!("{:.3}", errors.quantile(q, 0.0..=90.0))).join(" / ");
            let low: Vec<_> =
                night.iter().map(|&sun| format!("{sun}°: {:.2}", errors.quantile(0.99, sun..=sun))).collect();
            let seconds = started.elapsed().as_secs_f64();
            println!("| {file} | {orders:?} | {quality} | {day} | {} | {seconds:.0} |", low.join(", "));
        }
    }
}
