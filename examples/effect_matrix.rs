//! Scenes against effects: which passes each scene runs, reuses or skips, with milliseconds and bytes; what that saves; and
//! what a clear sky costs beside a build that knows nothing else. Prints the tables of docs/effects.md.
//!
//! `cargo run --release --example effect_matrix [-- QUALITY]`

#[path = "../tests/stripped/mod.rs"]
mod stripped;

use std::error::Error;
use std::path::Path;

use welkin::bench::Stopwatch;
use welkin::gpu::{DeviceRequest, Gpu};
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
    ("airliner", Some(20.0)),
    ("fog/valley-morning", None),
];
const SIZE: (u32, u32) = (320, 180);
const OUTPUTS: Outputs = Outputs { capture: false, picture: true };
/// Frames of each kind, in turn, of which the median counts.
const ROUNDS: usize = 3;
/// Frames of the clear sky and of the build without all else, in turn.
const CLEAR_ROUNDS: usize = 200;

/// Effects as a reader knows them, with the passes that make them.
const EFFECTS: [(&str, &[&str]); 7] = [
    (
        "air, once a medium",
        &["optical_depth", "first_order", "higher_order", "isotropic_series", "first_source", "higher_source"],
    ),
    ("sky from here", &["view_optical_depth", "sky_view"]),
    ("airglow", &["emission_order", "view_emission"]),
    ("mountains", &["terrain", "aerial_optical_depth", "aerial_perspective"]),
    ("clouds", &["cloud", "ordinates"]),
    ("fog and lamps", &["volume_light", "local_", "lamp_froxels", "surface_cells", "media_interpolation"]),
    ("picture", &["sky_lattice", "interpolate", "compose", "colour", "display"]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let quality = std::env::args().nth(1).map_or(Ok(Quality::Low), |name| name.parse())?;
    let settings = Settings::of(quality);
    let info = Gpu::new(&DeviceRequest::default())?.info().clone();
    println!("Quality {quality}, {}x{} pixels, {} ({}).\n", SIZE.0, SIZE.1, info.name, info.driver_version);
    clear_sky(settings)?;
    let names: Vec<_> = EFFECTS.iter().map(|(name, _)| *name).collect();
    println!("\n| scene | {} | first picture | sun moves | all on | share |", names.join(" | "));
    println!("|---|{}", "---|".repeat(names.len() + 4));
    // One for all scenes: what no scene changes, such as the noise of clouds, it computes once.
    let mut everything_on = Renderer::new(&DeviceRequest::default())?;
    for (name, view_deg) in SCENES {
        let scene = read(name, view_deg)?;
        let mut alone = Renderer::new(&DeviceRequest::default())?;
        let first = first_picture(&mut alone, &scene, settings)?;
        let forced = Settings { skipping: Skipping::NONE, ..settings };
        let all_scene = everything(&scene);
        everything_on.compute(&all_scene, forced, OUTPUTS)?;
        let [own, all] = moving([(&mut alone, scene.clone(), settings), (&mut everything_on, all_scene, forced)])?;
        let cells: Vec<_> = EFFECTS.iter().map(|(_, passes)| cell(&first, &own.plan, passes)).collect();
        let view = view_deg.map_or(String::new(), |deg| format!(", looking up {deg}°"));
        let first_ms: f64 = first.milliseconds.values().sum();
        let share = own.milliseconds / all.milliseconds;
        println!(
            "| {name}{view} | {} | {first_ms:.0} ms | {:.1} ms | {:.0} ms | {share:.3} |",
            cells.join(" | "),
            own.milliseconds,
            all.milliseconds
        );
    }
    Ok(())
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

/// All tables and a picture, with shaders that were compiled before: the driver compiles them when it first runs them.
fn first_picture(renderer: &mut Renderer, scene: &Scene, settings: Settings) -> Result<Timings, Box<dyn Error>> {
    renderer.compute(scene, settings, OUTPUTS)?;
    renderer.forget();
    Ok(renderer.compute(scene, settings, OUTPUTS)?)
}

/// Frames between which the first light moves by a hundredth of a degree.
struct Moving {
    /// The last one's plan.
    plan: Plan,
    /// The median of their processor time, ms.
    milliseconds: f64,
}

/// Of several scenes that have been rendered before, frame by frame in turn.
fn moving<const KINDS: usize>(
    mut kinds: [(&mut Renderer, Scene, Settings); KINDS],
) -> Result<[Moving; KINDS], Box<dyn Error>> {
    let (mut times, mut plans) = ([(); KINDS].map(|()| Vec::new()), Vec::new());
    for _ in 0..ROUNDS {
        plans.clear();
        for ((renderer, scene, settings), times) in kinds.iter_mut().zip(&mut times) {
            lift(scene);
            let stopwatch = Stopwatch::start();
            plans.push(renderer.compute(scene, *settings, OUTPUTS)?.plan);
            times.push(stopwatch.processor_ms());
        }
    }
    let all = plans.into_iter().zip(times.map(median));
    let all: Vec<_> = all.map(|(plan, milliseconds)| Moving { plan, milliseconds }).collect();
    all.try_into().map_err(|_| "as many kinds as were given".into())
}

/// Moves the first light by a hundredth of a degree.
fn lift(scene: &mut Scene) {
    if let Some(Light::Directional(light)) = scene.lights.first_mut() {
        light.direction.elevation_rad += 0.01_f64.to_radians();
    }
}

/// A clear noon beside the same by shaders from which everything else is cut, on a renderer that never drew anything else;
/// and, so that one sees how much of the difference is chance, beside a second renderer of the same kind.
fn clear_sky(settings: Settings) -> Result<(), Box<dyn Error>> {
    let mut scene = read("noon", None)?;
    let facts = Facts::new(&scene, settings, Orders::All, OUTPUTS)?;
    let others = [
        "aerial_",
        "cell_volumes",
        "cloud",
        "cluster",
        "emission_order",
        "lamp_",
        "local_",
        "media_",
        "ordinates",
        "surface_cells",
        "terrain",
        "view_emission",
        "volume",
    ];
    let sources = stripped::without(&stripped::absent(&definitions(&facts)), &others);
    let alone =
        || Ok::<_, Box<dyn Error>>(Renderer::with_shaders(Gpu::new(&DeviceRequest::default())?, sources.clone())?);
    let mut renderers = [Renderer::new(&DeviceRequest::default())?, alone()?, alone()?];
    // The one that knows more has drawn more.
    for name in ["hills", "clouds/fair-cumulus", "moonlight"] {
        renderers[0].compute(&read(name, None)?, settings, OUTPUTS)?;
    }
    let mut times = [(); 3].map(|()| Vec::new());
    for frame in 0..CLEAR_ROUNDS + 4 {
        lift(&mut scene);
        for (renderer, times) in renderers.iter_mut().zip(&mut times) {
            let stopwatch = Stopwatch::start();
            renderer.compute(&scene, settings, OUTPUTS)?;
            // The first frames compile.
            if frame >= 4 {
                times.push(stopwatch.processor_ms());
            }
        }
    }
    let [whole, alone, again] = times.map(median);
    println!(
        "A clear noon whose sun moves takes {whole:.2} ms of processor time, and {alone:.2} ms in a build without all else: \
         {:+.1} %. A second build without all else takes {again:.2} ms: {:+.1} %. Medians of {CLEAR_ROUNDS} frames in turn.",
        100.0 * (whole / alone - 1.0),
        100.0 * (again / alone - 1.0)
    );
    Ok(())
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// What becomes of an effect's passes in a scene's first frame, and in later ones.
fn cell(first: &Timings, later: &Plan, passes: &[&str]) -> String {
    let is_mine = |name: &str| passes.iter().any(|pass| name.starts_with(pass));
    let has = |plan: &Plan, decision| plan.passes.iter().any(|pass| is_mine(pass.name) && pass.decision == decision);
    if !has(&first.plan, Decision::Run) {
        return "skip".to_owned();
    }
    let times = first.milliseconds.iter().filter(|(name, _)| is_mine(name));
    let milliseconds: f64 = times.map(|(_, milliseconds)| milliseconds).sum();
    let bytes: u64 = first.plan.passes.iter().filter(|pass| is_mine(pass.name)).map(|pass| pass.bytes).sum();
    let then = if has(later, Decision::Run) { "run" } else { "reuse" };
    format!("run {milliseconds:.1} ms, {:.1} MB; then {then}", bytes as f64 / 1e6)
}
