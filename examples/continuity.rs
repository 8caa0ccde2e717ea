//! Whether anything pops on a camera path from -10 m to 1000 km and on sun paths from 90 to -18 degrees. Prints Markdown.
//!
//! `cargo run --release --example continuity [-- [--worst] [--steps N] [--path N] [--shaders FOLDER] [QUALITY...]]`; paths are
//! counted from 1.

#[path = "../tests/continuity/mod.rs"]
mod continuity;

use std::time::Instant;

use continuity::{
    BOUND, Picture, VISIBLE, Worst, altitudes_m, evenly, pictures, place, scene, set_sun, with_pop, worst_of_each_step,
};
use welkin::gpu::DeviceRequest;
use welkin::plan::{Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// The pop that must be noticed, and the share of a picture's values in which it must be at most steps.
const POP: f64 = 0.01;

/// A path by name, with its scene, its positions and what they change.
struct Walk {
    name: String,
    scene: Scene,
    positions: Vec<f64>,
    change: fn(&mut Scene, f64),
}

fn walks(steps: usize) -> Vec<Walk> {
    let camera = [60.0, 3.0, -6.0].map(|sun_deg| {
        let scene = scene(sun_deg, 0.0);
        let positions = altitudes_m(-10.0, 1e6, scene.planet.atmosphere_height_m, steps);
        let change = |scene: &mut Scene, altitude_m: f64| scene.camera.altitude_m = altitude_m;
        Walk { name: format!("camera -10 m to 1000 km, sun {sun_deg}°"), scene, positions, change }
    });
    let sun = [2.0, 10_000.0, 400_000.0].map(|altitude_m| Walk {
        name: format!("sun 90° to -18°, camera {altitude_m} m"),
        scene: scene(90.0, altitude_m),
        positions: evenly(90.0, -18.0, steps),
        change: set_sun,
    });
    camera.into_iter().chain(sun).collect()
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let show_worst = words.iter().any(|word| word == "--worst");
    let after = |option: &str| words.iter().position(|word| word == option).and_then(|i| words.get(i + 1));
    let steps: usize = after("--steps").map_or(1000, |word| word.parse().expect("--steps takes a number"));
    let only: Option<usize> = after("--path").map(|word| word.parse().expect("--path takes a number"));
    let qualities: Vec<Quality> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let qualities = if qualities.is_empty() { Quality::ALL.to_vec() } else { qualities };
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    if let Some(folder) = after("--shaders") {
        renderer.take_shaders_from(folder.as_ref()).unwrap_or_else(|error| panic!("{error}"));
    }
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}); {steps} steps a path.\n", info.name, info.driver, info.driver_version);
    println!(
        "| path | quality | largest step / its neighbours' | steps above 4 | brightens by at most % | control | s |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let chosen = |(index, _): &(usize, Walk)| only.is_none_or(|number| *index + 1 == number);
    for (_, walk) in walks(steps).into_iter().enumerate().filter(chosen) {
        for &quality in &qualities {
            let started = Instant::now();
            let seen = pictures(&mut renderer, Settings::of(quality), &walk.scene, &walk.positions, walk.change);
            let steps = worst_of_each_step(&seen);
            let visible: Vec<Worst> = steps.iter().copied().filter(|step| step.change > VISIBLE).collect();
            let pops = steps.iter().filter(|step| step.pops()).count();
            let seconds = started.elapsed().as_secs_f64();
            println!(
                "| {} | {quality} | {:.2} | {:.2} | {pops} | {} | {:.0} % | {seconds:.0} |",
                walk.name,
                largest(&visible).times,
                largest(&steps).times,
                if walk.name.starts_with("sun") {
                    format!("{:.3}", 100.0 * brightening(&walk, &seen))
                } else {
                    "-".into()
                },
                100.0 * noticed_pops(&seen)
            );
            if show_worst {
                print_worst(&walk, steps);
            }
        }
    }
}

fn largest(steps: &[Worst]) -> Worst {
    *steps.iter().max_by(|a, b| a.times.total_cmp(&b.times)).expect("a path has steps")
}

/// The largest relative brightening of a value while the sun sinks below the horizon.
fn brightening(walk: &Walk, pictures: &[Picture]) -> f64 {
    let mut largest: f64 = 0.0;
    for (pair, positions) in pictures.windows(2).zip(walk.positions.windows(2)) {
        if positions[0] <= 0.0 {
            let floor = continuity::DARKEST * pair[0].iter().copied().fold(0.0, f64::max);
            pair[0].iter().zip(&pair[1]).filter(|(before, _)| **before > floor).for_each(|(before, after)| {
                largest = largest.max(after / before - 1.0);
            });
        }
    }
    largest
}

/// Negative control: at how many of 20 places along the path a pop of one per cent would be noticed.
fn noticed_pops(pictures: &[Picture]) -> f64 {
    let noticed = |place: usize| {
        let position = pictures.len() * (2 * place + 1) / 40;
        let (low, high) = (position.saturating_sub(8), (position + 9).min(pictures.len()));
        let popped = with_pop(&pictures[low..high], position - low, POP);
        largest(&worst_of_each_step(&popped)).times > BOUND
    };
    (0..20).filter(|&place| noticed(place)).count() as f64 / 20.0
}

fn print_worst(walk: &Walk, mut steps: Vec<Worst>) {
    steps.sort_by(|a, b| b.times.total_cmp(&a.times));
    for worst in steps.iter().take(12) {
        let (elevation_deg, band) = place(&walk.scene, worst.value);
        eprintln!(
            "  {:.2} times at step {} ({:.4} to {:.4}): elevation {elevation_deg:.2}°, band {band}, change {:.2e}",
            worst.times,
            worst.step,
            walk.positions[worst.step],
            walk.positions[worst.step + 1],
            worst.change
        );
    }
}
