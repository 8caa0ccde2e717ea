//! Scenes against effects: which passes each scene runs, reuses or skips, with milliseconds and bytes, and its cost as a
//! share of the same scene's with every effect forced on. Prints Markdown (docs/effects.md).
//!
//! `cargo run --release --example effect_matrix [-- QUALITY]`

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use welkin::gpu::DeviceRequest;
use welkin::plan::{Decision, Outputs, Plan, Quality, Settings, Skipping};
use welkin::renderer::{Renderer, Timings};
use welkin::scene::{Effect, Scene};

const SCENES: [&str; 8] =
    ["noon", "twilight", "moonlight", "orbit", "mars", "hills", "clouds/fair-cumulus", "clouds/sunset"];
const SIZE: (u32, u32) = (640, 360);
const OUTPUTS: Outputs = Outputs { capture: false, picture: true };
/// Frames of which the median counts.
const ROUNDS: usize = 3;

/// Effects as a reader knows them, with the passes that make them.
const EFFECTS: [(&str, &[&str]); 6] = [
    ("air, once a medium", &["optical_depth", "first_order", "higher_order", "first_source", "higher_source"]),
    ("sky from here", &["view_optical_depth", "sky_view"]),
    ("airglow", &["emission_order", "view_emission"]),
    ("mountains", &["terrain", "aerial_optical_depth", "aerial_perspective"]),
    ("clouds", &["cloud", "ordinates"]),
    ("picture", &["compose", "display"]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let quality = std::env::args().nth(1).map_or(Ok(Quality::Medium), |name| name.parse())?;
    let settings = Settings::of(quality);
    let info = Renderer::new(&DeviceRequest::default())?.gpu().info().clone();
    println!(
        "Quality {quality}, {}x{} pixels, {} ({} {}).\n",
        SIZE.0, SIZE.1, info.name, info.driver, info.driver_version
    );
    let names: Vec<_> = EFFECTS.iter().map(|(name, _)| *name).collect();
    println!("| scene | {} | moving sun | all on |", names.join(" | "));
    println!("|---|{}", "---|".repeat(names.len() + 2));
    for name in SCENES {
        let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml")))?;
        (scene.camera.width, scene.camera.height) = SIZE;
        let mut renderer = Renderer::new(&DeviceRequest::default())?;
        let cold = renderer.render(&scene, settings, OUTPUTS)?.timings;
        let forced = Settings { skipping: Skipping::NONE, ..settings };
        let (own, all) =
            (moving(&mut renderer, &scene, settings)?, moving(&mut renderer, &everything(&scene), forced)?);
        let cells: Vec<_> = EFFECTS.iter().map(|(_, passes)| cell(&cold, passes)).collect();
        println!("| {name} | {} | {own:.0} ms | {:.2} |", cells.join(" | "), own / all);
    }
    Ok(())
}

/// The scene with every effect that the renderer can show in it together.
fn everything(scene: &Scene) -> Scene {
    Effect::ALL.iter().fold(scene.clone(), |scene, effect| {
        let richer = effect.added_to(&scene);
        match Renderer::plan(&richer, Settings::of(Quality::Low), OUTPUTS) {
            Ok(_) => richer,
            Err(_) => scene,
        }
    })
}

/// The median time of frames between which the first light moves by a hundredth of a degree, ms.
fn moving(renderer: &mut Renderer, scene: &Scene, settings: Settings) -> Result<f64, Box<dyn Error>> {
    let mut scene = scene.clone();
    renderer.render(&scene, settings, OUTPUTS)?;
    let mut times = Vec::new();
    for _ in 0..ROUNDS {
        if let Some(welkin::scene::Light::Directional(light)) = scene.lights.first_mut() {
            light.direction.elevation_rad += 0.01_f64.to_radians();
        }
        times.push(renderer.render(&scene, settings, OUTPUTS)?.timings.milliseconds.values().sum::<f64>());
    }
    times.sort_by(f64::total_cmp);
    Ok(times[ROUNDS / 2])
}

/// What became of an effect's passes in a scene's first frame.
fn cell(timings: &Timings, passes: &[&str]) -> String {
    let of_effect = |name: &str| passes.iter().any(|pass| name.starts_with(pass));
    let Plan { passes: planned } = &timings.plan;
    let mine: Vec<_> = planned.iter().filter(|pass| of_effect(pass.name)).collect();
    let decided: BTreeMap<_, usize> = mine.iter().fold(BTreeMap::new(), |mut counts, pass| {
        *counts.entry(word(pass.decision)).or_default() += 1;
        counts
    });
    if decided.keys().all(|word| *word == "skip") {
        return "skip".to_owned();
    }
    let milliseconds: f64 = mine.iter().filter_map(|pass| timings.milliseconds.get(pass.name)).sum();
    let bytes: u64 = mine.iter().map(|pass| pass.bytes).sum();
    let word = if decided.contains_key("run") { "run" } else { "reuse" };
    format!("{word} {milliseconds:.0} ms, {:.1} MB", bytes as f64 / 1e6)
}

fn word(decision: Decision) -> &'static str {
    match decision {
        Decision::Run => "run",
        Decision::Reuse => "reuse",
        Decision::Skip => "skip",
    }
}
