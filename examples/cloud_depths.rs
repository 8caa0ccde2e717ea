//! Optical depths of clouds towards the light, as the device finds them from its cached volumes, against the reference's along
//! the same lines, in distribution; prints Markdown.
//!
//! `cargo run --release --example cloud_depths -- [--quality NAME]... [--width PIXELS] [--scene FILE]... [--without-ordinates]`
//!
//! Each pixel asks at the place where light that reaches it was scattered last, as chance has it: so many places as pixels
//! with clouds. The air is left out. Columns: places in a range of distances; the quartiles of the depth, found and true;
//! the largest distance between the two distribution functions (Kolmogorov and Smirnov's); the mean of e^(-τ/4), a quarter of
//! the depth being what dims most of what droplets scatter; the root mean square of its error, place by place.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use clap::Parser;
use glam::DVec3;
use welkin::gpu::{DeviceRequest, Gpu};
use welkin::passes::ShaderSources;
use welkin::plan::{CloudScattering, CloudSettings, Outputs, Quality, Settings};
use welkin::reference::World;
use welkin::renderer::Renderer;
use welkin::scene::{Light, Scene};

#[derive(Parser)]
struct Arguments {
    /// Qualities to measure.
    #[arg(long = "quality", default_values = ["low", "medium", "high"])]
    qualities: Vec<Quality>,
    /// Pixels across.
    #[arg(long, default_value_t = 256)]
    width: u32,
    /// Scenes with clouds and a sun.
    #[arg(long = "scene", default_values = ["scenes/clouds/fair-cumulus.toml", "scenes/clouds/towering-congestus.toml"])]
    scenes: Vec<String>,
    /// Shaders to take in place of the built-in ones.
    #[arg(long)]
    shaders: Option<PathBuf>,
    /// Only the grid of depths, as lights have it that are not the ordinates'.
    #[arg(long)]
    without_ordinates: bool,
    /// Points between a place and where the grid takes over, in place of the quality's.
    #[arg(long)]
    near_samples: Option<u32>,
}

/// Ranges of distances, m.
const RANGES_M: [[f64; 2]; 3] = [[0.0, 5e3], [5e3, 2e4], [2e4, 6e4]];

/// Of the depth, what dims most of what droplets scatter.
const SHARE: f64 = 0.25;

/// Depths found and true at a distance.
struct Place {
    distance_m: f64,
    depths: [f64; 2],
}

/// Shaders that put the depth found, and the distance, in place of the clouds' light.
fn asking(folder: Option<&Path>) -> ShaderSources {
    let all = folder.map_or_else(ShaderSources::embedded, |folder| {
        ShaderSources::from_directory(folder).unwrap_or_else(|error| panic!("{error}"))
    });
    let text = include_str!("../shaders/wgsl/clouds.wgsl");
    let light = "    (*sum).radiance += through_air(air, at_m) * from_clouds(step, (*ray).direction, phase);\n";
    let import = "#import welkin::cloud_source::{phases, PHASE_COUNT}";
    assert!(text.contains(light) && text.contains(import), "the march has changed");
    let text = text.replace(import, "#import welkin::cloud_source::{depth_to_light, phases, Sample, PHASE_COUNT}");
    let asked = "    // An exponential variate: where a photon that came from here was scattered last.
    let scattered_at = -log(1.0 - place_in_step((*ray).pixel.yx + 4096u, 0.5));
    if step.before <= scattered_at && scattered_at < step.before + step.within {
        let height = (step.altitude_m - cloud_layers[0].base_m) / cloud_layers[0].thickness_m;
        let sample = Sample(0u, step.map, height, step.altitude_m, up, step.before, step.within);
        (*sum).radiance = vec3<f32>(depth_to_light(sample, 0u), at_m, 1.0);
    }
";
    let text = text.replace(light, asked);
    let text = text.replace("{to_map, CLOUD_LAYER_SLOTS}", "{cloud_layers, to_map, CLOUD_LAYER_SLOTS}");
    all.with("clouds.wgsl", Cow::Owned(text))
}

/// A scene's clouds in a vacuum above black ground.
fn bare(file: &str, width: u32) -> Scene {
    let mut scene = Scene::read(file.as_ref()).unwrap_or_else(|error| panic!("{error}"));
    (scene.camera.width, scene.camera.height) = (width, width * scene.camera.height / scene.camera.width);
    scene.medium.constituents.clear();
    scene.planet.ground_albedo = [0.0; 3];
    scene.lights.retain(|light| matches!(light, Light::Directional(_)));
    scene
}

fn places(scene: &Scene, quality: Quality, arguments: &Arguments) -> Vec<Place> {
    let gpu = Gpu::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let mut renderer =
        Renderer::with_shaders(gpu, asking(arguments.shaders.as_deref())).unwrap_or_else(|error| panic!("{error}"));
    let preset = CloudSettings::of(quality);
    let near_samples = arguments.near_samples.unwrap_or(preset.near_samples);
    let scattering = if arguments.without_ordinates { CloudScattering::Single } else { preset.scattering };
    let clouds = CloudSettings { scattering, near_samples, ..preset };
    let settings = Settings { clouds, ..Settings::of(quality) };
    let rendered = renderer.render(scene, settings, Outputs { capture: true, picture: false });
    let frame = rendered.unwrap_or_else(|error| panic!("{error}")).frame;
    let world = World::from_scene(scene);
    let toward = world.sun().expect("the scene has a sun");
    let eye = DVec3::new(0.0, 0.0, scene.camera.altitude_m);
    let place = |(i, found): (usize, &[f32; 3])| {
        let [depth, distance_m, is_cloud] = found.map(f64::from);
        if (is_cloud - 1.0).abs() > 1e-3 {
            return None;
        }
        let (x, y) = (i as u32 % scene.camera.width, i as u32 / scene.camera.width);
        let direction = scene.camera.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let at = eye + distance_m * direction;
        let depth_of = |body: &welkin::reference::Body| body.optical_depth(at, toward, 0.0, f64::INFINITY)[1];
        Some(Place { distance_m, depths: [depth, world.bodies.iter().map(depth_of).sum()] })
    };
    frame.radiance.iter().enumerate().filter_map(place).collect()
}

fn sorted(places: &[&Place], of: usize) -> Vec<f64> {
    let mut depths: Vec<f64> = places.iter().map(|place| place.depths[of]).collect();
    depths.sort_by(f64::total_cmp);
    depths
}

/// The largest distance between the distribution functions of two sorted lists.
fn largest_gap(a: &[f64], b: &[f64]) -> f64 {
    let below = |list: &[f64], x: f64| list.partition_point(|&value| value <= x) as f64 / list.len() as f64;
    a.iter().chain(b).map(|&x| (below(a, x) - below(b, x)).abs()).fold(0.0, f64::max)
}

fn print(name: &str, quality: Quality, [from_m, to_m]: [f64; 2], places: &[Place]) {
    let ours: Vec<&Place> = places.iter().filter(|place| (from_m..to_m).contains(&place.distance_m)).collect();
    if ours.len() < 30 {
        return;
    }
    let [found, truth] = [0, 1].map(|of| sorted(&ours, of));
    let quartiles = |list: &[f64]| [1, 2, 3].map(|k| format!("{:.2}", list[k * list.len() / 4])).join(" ");
    let left = |depth: f64| (-SHARE * depth).exp();
    let mean = |list: &[f64]| list.iter().map(|&depth| left(depth)).sum::<f64>() / list.len() as f64;
    let squares: f64 = ours.iter().map(|place| (left(place.depths[0]) - left(place.depths[1])).powi(2)).sum();
    println!(
        "| {name} | {quality} | {:.0}–{:.0} km | {} | {} | {} | {:.2} | {:.3} | {:.3} | {:.3} |",
        1e-3 * from_m,
        1e-3 * to_m,
        ours.len(),
        quartiles(&found),
        quartiles(&truth),
        largest_gap(&found, &truth),
        mean(&found),
        mean(&truth),
        (squares / ours.len() as f64).sqrt(),
    );
}

fn main() {
    let arguments = Arguments::parse();
    println!(
        "| scene | quality | distance | places | quartiles found | true | gap | mean e^(-τ/4) found | true | RMS of its error |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for file in &arguments.scenes {
        let scene = bare(file, arguments.width);
        for &quality in &arguments.qualities {
            let places = places(&scene, quality, &arguments);
            RANGES_M.iter().for_each(|&range| print(&scene.name, quality, range, &places));
        }
    }
}
