//! Where the real-time sky's error comes from, quality by quality; prints Markdown.
//!
//! `cargo run --release --example error_budget [QUALITY...]`
//!
//! Each part is found by turning the others off: what it replaces stays at the quality's value, all else is far finer,
//! and the result is compared with one in which this part is finer too. So a part's error is no truth of another's.
//!
//! - quadrature: nodes on each leg of a ray
//! - resolution: texels of the tables of optical depth, multiply scattered light and the sky view
//! - storage: tables of half floats in place of 32-bit floats
//! - multiple scattering: the treatment, its directions and degrees, and the orders computed one by one; compared with the
//!   source function in the directions of `ultra` and two orders more
//!
//! `all` is the quality itself against the tables' truth, `floor` the finest settings against it.

#[path = "../tests/reference/sky.rs"]
mod sky;
#[path = "../tests/reference/tables.rs"]
mod tables;

use std::time::Instant;

use tables::Row;
use welkin::gpu::DeviceRequest;
use welkin::plan::{MultipleScattering, Quality, Settings, TableFormat};
use welkin::probe::{Orders, RayRadiance};
use welkin::renderer::Renderer;

/// Zenith angles of the sun, degrees: day and twilight.
const SUNS: [std::ops::RangeInclusive<f64>; 2] = [0.0..=90.0, 92.0..=102.0];

/// The rows of one scene in one table, with the column of the truth.
struct Table {
    rows: Vec<Row>,
    column: &'static str,
}

/// Both tables' rows of the atmosphere that engines ship, over a bright ground.
fn read_tables() -> Vec<Table> {
    let belongs = |row: &Row| (!row.has("variant") || row.text("variant") == "B") && row.number("ground_albedo") > 0.0;
    let read = |(name, column)| Table { rows: tables::read(name).into_iter().filter(belongs).collect(), column };
    [("earth_sky.csv", "total_best"), ("earth_views.csv", "total")].map(read).into()
}

/// A quality with everything finer but the treatment of multiply scattered light.
fn finer(settings: Settings) -> Settings {
    let [width, height] = settings.multiple_scattering_size;
    let [columns, rows] = settings.source_size;
    Settings {
        nodes_per_leg: 20,
        optical_depth_size: [1024, 256],
        multiple_scattering_size: [width.max(96), height.max(48)],
        source_size: [columns.max(64), rows.max(32)],
        sky_view_size: [144, 288],
        table_format: TableFormat::Float32,
        ..settings
    }
}

/// Everything finer.
fn finest() -> Settings {
    let ultra = Settings::of(Quality::Ultra);
    Settings {
        multiple_scattering: MultipleScattering::SourceFunction,
        source_orders: ultra.source_orders + 2,
        ..finer(ultra)
    }
}

/// What is left of a quality when all but one part is finer.
fn parts(quality: Settings) -> [(&'static str, Settings); 3] {
    let fine = finer(quality);
    [
        ("quadrature", Settings { nodes_per_leg: quality.nodes_per_leg, ..fine }),
        (
            "resolution",
            Settings {
                optical_depth_size: quality.optical_depth_size,
                multiple_scattering_size: quality.multiple_scattering_size,
                source_size: quality.source_size,
                sky_view_size: quality.sky_view_size,
                ..fine
            },
        ),
        ("storage", Settings { table_format: TableFormat::Float16, ..fine }),
    ]
}

struct Budget {
    renderer: Renderer,
    tables: Vec<Table>,
}

impl Budget {
    fn answers(&mut self, settings: Settings) -> Vec<Vec<RayRadiance>> {
        let all = self.tables.iter();
        all.map(|table| sky::answers(&mut self.renderer, &table.rows, settings, Orders::All, |_| {})).collect()
    }

    /// Median and 99th percentile of the difference, by day and in twilight, for each table.
    fn cells(&self, found: &[Vec<RayRadiance>], truth: Option<&[Vec<RayRadiance>]>) -> String {
        let mut cells = Vec::new();
        for (i, table) in self.tables.iter().enumerate() {
            let errors = match truth {
                None => sky::errors(&table.rows, &found[i], table.column),
                Some(truth) => differences(table, &found[i], &truth[i]),
            };
            let day = [0.5, 0.99].map(|q| format!("{:.3}", errors.quantile(q, SUNS[0].clone()))).join(" / ");
            cells.push(format!("{day} | {:.2}", errors.quantile(0.99, SUNS[1].clone())));
        }
        cells.join(" | ")
    }
}

/// Relative differences in per cent where something shines.
fn differences(table: &Table, found: &[RayRadiance], other: &[RayRadiance]) -> sky::Errors {
    let answers = found.iter().zip(other);
    let difference = |(row, (found, other)): (&Row, (&RayRadiance, &RayRadiance))| {
        let (a, b) = (found.radiance[row.band()], other.radiance[row.band()]);
        (row.number(table.column) > 0.0).then(|| (row.number("sza_deg"), 100.0 * (a / b - 1.0).abs()))
    };
    sky::Errors(table.rows.iter().zip(answers).filter_map(difference).collect())
}

fn main() {
    let named: Vec<Quality> =
        std::env::args().skip(1).map(|name| name.parse().unwrap_or_else(|error| panic!("{error}"))).collect();
    let qualities = if named.is_empty() { Quality::ALL.to_vec() } else { named };
    let renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}).\n", info.name, info.driver, info.driver_version);
    println!("| quality | part | sky, sun 0-90°: median / p99 % | 92-94°: p99 % | views, sun 0-90° | 92-102° |");
    println!("|---|---|---|---|---|---|");
    let mut budget = Budget { renderer, tables: read_tables() };
    let mut refined = Vec::new();
    for quality in qualities {
        let started = Instant::now();
        let settings = Settings::of(quality);
        let fine = budget.answers(finer(settings));
        for (name, part) in parts(settings) {
            let found = budget.answers(part);
            println!("| {quality} | {name} | {} |", budget.cells(&found, Some(&fine)));
        }
        refined.push((quality, fine));
        let found = budget.answers(settings);
        println!("| {quality} | all | {} |", budget.cells(&found, None));
        eprintln!("{quality}: {:.0} s", started.elapsed().as_secs_f64());
    }
    let finest = budget.answers(finest());
    for (quality, fine) in refined {
        println!("| {quality} | multiple scattering | {} |", budget.cells(&fine, Some(&finest)));
    }
    println!("| - | floor | {} |", budget.cells(&finest, None));
}
