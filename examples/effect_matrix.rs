//! Scenes against effects: which passes each scene runs, reuses or skips, with milliseconds and bytes; what that saves; and
//! what a clear sky costs beside a build that knows nothing else. Prints the tables of docs/effects.md.
//!
//! `cargo run --release --example effect_matrix [-- QUALITY]`

#[path = "../tests/stripped/mod.rs"]
mod stripped;

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use welkin::gpu::DeviceRequest;
use welkin::passes::definitions;
use welkin::plan::{Decision, Facts, Outputs, Plan, Quality, Settings, Skipping};
use welkin::probe::Orders;
use welkin::renderer::{Renderer, Timings};
use welkin::scene::{Effect, Light, Scene};

/// Scenes, and elevations of the view in place of their own, deg.
const SCENES: [(&str, Option<f64>); 11] = [
    ("noon", None),
    ("twilight", None),
    ("moonlight", None),
    ("orbit", None),
    ("orbit", Some(40.0)),
    ("mars", None),
    ("hills", None),
    ("mountains", None),
    ("clouds/fair-cumulus", None),
    ("clouds/sunset", None),
    ("airliner", Some(20.0)),
];
const SIZE: (u32, u32) = (320, 180);
const OUTPUTS: Outputs = Outputs { capture: false, picture: true };
/// Frames of each kind, in turn, of which the median counts.
const ROUNDS: usize = 5;

/// Effects as a reader knows them, with the passes that make them.
const EFFECTS: [(&str, &[&str]); 6] = [
    (
        "air, once a medium",
        &["optical_depth", "first_order", "higher_order", "isotropic_series", "first_source", "higher_source"],
    ),
    ("sky from here", &["view_optical_depth", "sky_view"]),
    ("airglow", &["emission_order", "view_emission"]),
    ("mountains", &["terrain", "aerial_optical_depth", "aerial_perspective"]),
    ("clouds", &["cloud", "ordinates"]),
    ("picture", &["sky_lattice", "interpolate", "compose", "display"]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let quality = std::env::args().nth(1).map_or(Ok(Quality::Medium), |name| name.parse())?;
    let settings = Settings::of(quality);
    let info = Renderer::new(&DeviceRequest::default())?.gpu().info().clone();
    println!("Quality {quality}, {}x{} pixels, {} ({}).\n", SIZE.0, SIZE.1, info.name, info.driver_version);
    let names: Vec<_> = EFFECTS.iter().map(|(name, _)| *name).collect();
    println!("| scene | {} | sun moves | lagging | all on | share |", names.join(" | "));
    println!("|---|{}", "---|".repeat(names.len() + 4));
    for (name, view_deg) in SCENES {
        let scene = read(name, view_deg)?;
        let first = Renderer::new(&DeviceRequest::default())?.render(&scene, settings, OUTPUTS)?.timings;
        let lagging = Settings { skipping: Skipping::IN_SEQUENCE, ..settings };
        let forced = Settings { skipping: Skipping::NONE, ..settings };
        let [own, late, all] = moving([(&scene, settings), (&scene, lagging), (&everything(&scene), forced)])?;
        let cells: Vec<_> = EFFECTS.iter().map(|(_, passes)| cell(&first, passes)).collect();
        let view = view_deg.map_or(String::new(), |deg| format!(", looking up {deg}°"));
        println!("| {name}{view} | {} | {own:.1} | {late:.1} | {all:.1} | {:.2} |", cells.join(" | "), own / all);
    }
    clear_sky(settings)
}

fn read(name: &str, view_deg: Option<f64>) -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml")))?;
    (scene.camera.width, scene.camera.height) = SIZE;
    if let Some(view_deg) = view_deg {
        scene.camera.direction.elevation_rad = view_deg.to_radians();
    }
    Ok(scene)
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

/// The median processor time of frames between which the first light moves by a hundredth of a degree, ms; one of each kind
/// after the other, each on a renderer of its own.
fn moving<const KINDS: usize>(kinds: [(&Scene, Settings); KINDS]) -> Result<[f64; KINDS], Box<dyn Error>> {
    let mut times = [(); KINDS].map(|()| Vec::new());
    let mut renderers = Vec::new();
    for (scene, settings) in kinds {
        let mut renderer = Renderer::new(&DeviceRequest::default())?;
        renderer.render(scene, settings, OUTPUTS)?;
        renderers.push((renderer, scene.clone(), settings));
    }
    for _ in 0..ROUNDS {
        for ((renderer, scene, settings), times) in renderers.iter_mut().zip(&mut times) {
            if let Some(Light::Directional(light)) = scene.lights.first_mut() {
                light.direction.elevation_rad += 0.01_f64.to_radians();
            }
            let before = processor_ms()?;
            renderer.render(scene, *settings, OUTPUTS)?;
            times.push(processor_ms()? - before);
        }
    }
    Ok(times.map(median))
}

/// A clear noon beside the same by shaders from which everything else is cut, on a renderer that never drew anything else.
fn clear_sky(settings: Settings) -> Result<(), Box<dyn Error>> {
    const FRAMES: usize = 60;
    let mut scene = read("noon", None)?;
    let facts = Facts::new(&scene, settings, Orders::All, OUTPUTS)?;
    let others = ["aerial_", "cloud", "emission_order", "ordinates", "terrain", "view_emission"];
    let sources = stripped::without(&stripped::absent(&definitions(&facts)), &others);
    let mut whole = Renderer::new(&DeviceRequest::default())?;
    let mut alone = Renderer::with_shaders(welkin::gpu::Gpu::new(&DeviceRequest::default())?, sources)?;
    // The one that knows more has drawn more.
    for (name, view_deg) in [("hills", None), ("clouds/fair-cumulus", None), ("moonlight", None)] {
        whole.render(&read(name, view_deg)?, settings, OUTPUTS)?;
    }
    let mut times = [Vec::new(), Vec::new()];
    for frame in 0..FRAMES {
        if let Some(Light::Directional(light)) = scene.lights.first_mut() {
            light.direction.elevation_rad += 0.01_f64.to_radians();
        }
        for (renderer, times) in [&mut whole, &mut alone].into_iter().zip(&mut times) {
            let before = processor_ms()?;
            renderer.render(&scene, settings, OUTPUTS)?;
            // The first frames compile.
            if frame >= 4 {
                times.push(processor_ms()? - before);
            }
        }
    }
    let [whole, alone] = times.map(median);
    println!(
        "\nA clear noon whose sun moves takes {whole:.2} ms of processor time, and {alone:.2} ms in a build without all else: \
         {:+.1} %.",
        100.0 * (whole / alone - 1.0)
    );
    Ok(())
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Processor time of all threads of this process, ms.
fn processor_ms() -> Result<f64, Box<dyn Error>> {
    let mut nanoseconds = 0.0;
    for task in std::fs::read_dir("/proc/self/task")? {
        // A thread may end meanwhile.
        let Ok(text) = std::fs::read_to_string(task?.path().join("schedstat")) else { continue };
        nanoseconds += text.split_whitespace().next().unwrap_or("0").parse::<f64>()?;
    }
    Ok(nanoseconds * 1e-6)
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
