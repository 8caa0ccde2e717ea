//! Aerial perspective against the reference: in-scattered light and transmittance between an observer and a point at a
//! distance, at every quality; prints Markdown.
//!
//! `cargo run --release --example validate_aerial -- single|all [PRESET] [QUALITY...]`
//!
//! `single` has no noise. `all` traces paths, 2048 for each seventh ray; its truth is kept in `target/validate_aerial/`
//! and used again by the next run.

#[path = "../../tests/reference/segments.rs"]
mod segments;

use std::fs;
use std::path::PathBuf;

use segments::{Errors, SUNS_DEG, rays, scene, white_surface};
use welkin::gpu::DeviceRequest;
use welkin::plan::{Quality, Settings};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::{self, Effort};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// Paths for each ray with all orders, of which each of so many rays is traced.
const WALKS: u64 = 2048;
const EVERY: usize = 7;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let orders = match arguments.first().map(String::as_str) {
        Some("single") => Orders::Single,
        Some("all") => Orders::All,
        _ => panic!("the first argument is single or all"),
    };
    let qualities: Vec<Quality> = arguments[1..].iter().filter_map(|name| name.parse().ok()).collect();
    let qualities = if qualities.is_empty() { Quality::ALL.to_vec() } else { qualities };
    let presets = ["hillaire2020", "earth"].into_iter();
    let named = |preset: &&str| arguments.iter().any(|name| name == preset);
    let asked: Vec<&str> =
        if presets.clone().any(|p| named(&p)) { presets.filter(named).collect() } else { presets.collect() };
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    println!(
        "| preset | quality | sun | of itself: median / p99 % | of itself and white: median / p99 % | transmittance: p99 / max |"
    );
    println!("|---|---|---|---|---|---|");
    for preset in asked {
        let scene = scene(preset);
        let every = if orders == Orders::All { EVERY } else { 1 };
        let rays: Vec<Ray> = rays(&scene).into_iter().step_by(every).collect();
        let truth = truth(preset, &scene, &rays, orders);
        let white = white_surface(&scene);
        for &quality in &qualities {
            let found = renderer.probe(&scene, Settings::of(quality), &rays, orders).unwrap_or_else(|e| panic!("{e}"));
            let errors = Errors::new(&rays, &found, &truth, &white);
            for suns in [SUNS_DEG[0]..=90.0, 92.0..=92.0] {
                println!("| {preset} | {quality} | {suns:?} | {} |", errors.row(&suns));
            }
        }
        println!("\nWorst at the last quality:");
        let found = renderer.probe(&scene, Settings::of(qualities[qualities.len() - 1]), &rays, orders).unwrap();
        Errors::new(&rays, &found, &truth, &white).print_worst(&rays, &found, &truth);
    }
}

/// What the reference says; all orders are slow, and kept in a file.
fn truth(preset: &str, scene: &Scene, rays: &[Ray], orders: Orders) -> Vec<RayRadiance> {
    if orders == Orders::Single {
        return reference::probe(scene, rays, orders, Effort::Walks(1), 0);
    }
    let path = PathBuf::from(format!("target/validate_aerial/{preset}.csv"));
    if let Some(kept) = fs::read_to_string(&path).ok().map(|text| parse(&text)).filter(|kept| kept.len() == rays.len())
    {
        return kept;
    }
    let truth = reference::probe(scene, rays, orders, Effort::Walks(WALKS), 0);
    let line = |answer: &RayRadiance| {
        let values = [answer.radiance, answer.transmittance, answer.standard_error];
        values.as_flattened().iter().map(|value| format!("{value:e}")).collect::<Vec<_>>().join(",")
    };
    fs::create_dir_all("target/validate_aerial").unwrap_or_else(|e| panic!("{e}"));
    fs::write(&path, truth.iter().map(line).collect::<Vec<_>>().join("\n")).unwrap_or_else(|e| panic!("{e}"));
    truth
}

fn parse(text: &str) -> Vec<RayRadiance> {
    let answer = |line: &str| {
        let numbers: Vec<f64> = line.split(',').filter_map(|number| number.parse().ok()).collect();
        let bands = |from: usize| [numbers[from], numbers[from + 1], numbers[from + 2]];
        (numbers.len() == 9).then(|| RayRadiance {
            radiance: bands(0),
            transmittance: bands(3),
            standard_error: bands(6),
        })
    };
    text.lines().filter_map(answer).collect()
}
