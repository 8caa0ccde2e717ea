//! The real-time sky against the path tracer where the tables of other codes end: deep twilight, other planets, dense
//! haze, the Moon's distance. Prints Markdown.
//!
//! `cargo run --release --example beyond_tables [-- [--worst] [--truth-only] [QUALITY...]]`
//!
//! The path tracer's answers are kept in `target/beyond_tables/`; delete them when the reference itself has changed.

mod truth;
mod worlds;

use std::path::Path;

use welkin::gpu::DeviceRequest;
use welkin::plan::{Quality, Settings};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::renderer::Renderer;
use worlds::Question;

/// The path tracer's standard error that is aimed at.
const TARGET: f64 = 0.01;
/// Values whose truth is known worse than this are left out, and counted.
const KNOWN: f64 = 0.05;
/// Zenith angles of the sun, degrees, at which a world's lines part.
const SUN_RANGES_DEG: [[f64; 2]; 4] = [[0.0, 90.0], [90.0, 97.0], [97.0, 103.0], [103.0, 180.0]];

/// One value's distance from the truth, and the truth's own standard error, both in per cent.
struct Difference {
    ray: Ray,
    band: usize,
    percent: f64,
    standard_error: f64,
}

fn main() {
    let (options, names): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word.starts_with('-'));
    let named: Vec<Quality> = names.iter().map(|name| name.parse().unwrap_or_else(|e| panic!("{e}"))).collect();
    let qualities = if named.is_empty() { Quality::ALL.to_vec() } else { named };
    let wants = |option: &str| options.iter().any(|given| given == option);
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/beyond_tables");
    let questions = worlds::questions();
    let answers: Vec<_> =
        questions.iter().map(|asked| truth::answers(&directory, &asked.scene, &asked.rays, TARGET)).collect();
    if wants("--truth-only") {
        return;
    }
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}).\n", info.name, info.driver, info.driver_version);
    let heads: Vec<String> = qualities.iter().map(|quality| format!("{quality}: median / p90 / max %")).collect();
    println!("| world | sun | values | truth's standard error, median / max % | {} |", heads.join(" | "));
    println!("|---|---|---|---|{}", "---|".repeat(qualities.len()));
    for (asked, truth) in questions.iter().zip(&answers) {
        let found: Vec<Vec<Difference>> = qualities
            .iter()
            .map(|&quality| {
                let settings = Settings::of(quality);
                let answers = renderer.probe(&asked.scene, settings, &asked.rays, Orders::All);
                differences(&asked.rays, &answers.unwrap_or_else(|error| panic!("{error}")), truth)
            })
            .collect();
        print_lines(asked, &found);
        if wants("--worst") {
            found.iter().zip(&qualities).for_each(|(differences, quality)| print_worst(*quality, differences));
        }
    }
}

fn differences(rays: &[Ray], answers: &[RayRadiance], truth: &[RayRadiance]) -> Vec<Difference> {
    let mut differences = Vec::new();
    for ((ray, answer), truth) in rays.iter().zip(answers).zip(truth) {
        for band in (0..3).filter(|&band| truth.radiance[band] > 0.0) {
            differences.push(Difference {
                ray: *ray,
                band,
                percent: 100.0 * (answer.radiance[band] / truth.radiance[band] - 1.0),
                standard_error: 100.0 * truth::relative_error(truth, band),
            });
        }
    }
    differences
}

fn quantile(mut values: Vec<f64>, q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * q).round() as usize]
}

fn print_lines(asked: &Question, found: &[Vec<Difference>]) {
    for [low, high] in SUN_RANGES_DEG {
        let in_range = |difference: &&Difference| {
            let sun_deg = difference.ray.sun_zenith_rad.to_degrees();
            sun_deg > low && sun_deg <= high
        };
        let known = |difference: &&Difference| difference.standard_error <= 100.0 * KNOWN;
        let all = found[0].iter().filter(in_range).count();
        let errors: Vec<f64> =
            found[0].iter().filter(in_range).filter(known).map(|difference| difference.standard_error).collect();
        if errors.is_empty() {
            continue;
        }
        let cells = found.iter().map(|differences| {
            let kept = differences.iter().filter(in_range).filter(known);
            let sizes: Vec<f64> = kept.map(|difference| difference.percent.abs()).collect();
            [0.5, 0.9, 1.0].map(|q| format!("{:.2}", quantile(sizes.clone(), q))).join(" / ")
        });
        let cells: Vec<String> = cells.collect();
        let truth = [0.5, 1.0].map(|q| format!("{:.2}", quantile(errors.clone(), q))).join(" / ");
        let name = asked.name;
        println!("| {name} | {low}-{high}° | {} of {all} | {truth} | {} |", errors.len(), cells.join(" | "));
    }
}

fn print_worst(quality: Quality, differences: &[Difference]) {
    let mut sorted: Vec<&Difference> = differences.iter().collect();
    sorted.sort_by(|a, b| b.percent.abs().total_cmp(&a.percent.abs()));
    for Difference { ray, band, percent, standard_error } in sorted.into_iter().take(8) {
        let degrees = [ray.view_zenith_rad, ray.view_azimuth_rad, ray.sun_zenith_rad].map(f64::to_degrees);
        eprintln!(
            "  {quality}: h {} m, view {:.4}°, azimuth {:.0}°, sun {:.0}°, band {band}: {percent:+.2} % (± {standard_error:.2})",
            ray.altitude_m, degrees[0], degrees[1], degrees[2]
        );
    }
}
