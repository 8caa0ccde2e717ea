//! Clouds in real time against pictures of the path tracer; prints Markdown.
//!
//! For each `scenes/clouds/NAME.toml` of which there is a `DIR/NAME.exr`, made by
//! `welkin reference` from that scene at any size:
//! `cargo run --release --example compare_clouds -- DIR [QUALITY...]`
//!
//! Pixels count as cloudy where clouds hide more than half of what is behind them, and as thin from 0.03 to 0.3.

use std::path::{Path, PathBuf};

use glam::DVec3;
use welkin::frame::Frame;
use welkin::gpu::DeviceRequest;
use welkin::output::read_exr;
use welkin::plan::{CloudScattering, CloudSettings, Outputs, Quality, Settings};
use welkin::reference::World;
use welkin::renderer::Renderer;
use welkin::report::compare;
use welkin::scene::Scene;

/// The band that is compared.
const GREEN: usize = 1;

/// A scene with what the path tracer sees of it.
struct Case {
    name: String,
    scene: Scene,
    truth: Frame,
    /// Of the clouds, pixel by pixel.
    opacity: Vec<f64>,
}

fn cases(directory: &Path) -> Vec<Case> {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/clouds");
    let mut paths: Vec<PathBuf> = scenes.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let case = |path: &PathBuf| {
        let name = path.file_stem()?.to_str()?.to_owned();
        let picture = directory.join(format!("{name}.exr"));
        if !picture.exists() {
            eprintln!("note: there is no '{}'", picture.display());
            return None;
        }
        let truth = read_exr(&picture).unwrap_or_else(|error| panic!("{error}"));
        let mut scene = Scene::read(path).unwrap_or_else(|error| panic!("{error}"));
        (scene.camera.width, scene.camera.height) = (truth.width, truth.height);
        let opacity = opacity(&scene);
        Some(Case { name, scene, truth, opacity })
    };
    paths.iter().filter_map(case).collect()
}

/// What the clouds alone hide along the ray through each pixel's centre.
fn opacity(scene: &Scene) -> Vec<f64> {
    let world = World::from_scene(scene);
    let camera = &scene.camera;
    let position = DVec3::new(0.0, 0.0, camera.altitude_m);
    let pixel = |i: u32| {
        let (x, y) = (f64::from(i % camera.width) + 0.5, f64::from(i / camera.width) + 0.5);
        let direction = camera.direction_through(x, y);
        let Some(span) = world.shape.span(position, direction) else { return 0.0 };
        let depth =
            |body: &welkin::reference::Body| body.optical_depth(position, direction, span.start_m, span.end_m)[GREEN];
        1.0 - (-world.bodies.iter().map(depth).sum::<f64>()).exp()
    };
    (0..camera.width * camera.height).map(pixel).collect()
}

/// Over the pixels of an opacity: root mean square of ln(ratio) where noise is less than half of the light, the path
/// tracer's own noise taken out; the ratio of the sums of all; how many pixels there are, and how many were too noisy.
fn score(case: &Case, found: &Frame, opacities: std::ops::Range<f64>) -> (f64, f64, usize, usize) {
    let (mut squares, mut noise, mut sums, mut count, mut noisy) = (0.0, 0.0, [0.0; 2], 0, 0);
    for i in (0..found.radiance.len()).filter(|&i| opacities.contains(&case.opacity[i])) {
        let (a, b) = (f64::from(found.radiance[i][GREEN]), f64::from(case.truth.radiance[i][GREEN]));
        let error = case.truth.standard_error.as_ref().map_or(0.0, |errors| f64::from(errors[i][GREEN]) / b);
        sums = [sums[0] + a, sums[1] + b];
        if b <= 0.0 || error >= 0.5 {
            noisy += 1;
        } else {
            squares += (a / b).ln().powi(2);
            noise += error * error;
            count += 1;
        }
    }
    (((squares - noise) / count as f64).max(0.0).sqrt(), sums[0] / sums[1], count, noisy)
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let directory = arguments.next().expect("the folder of the path tracer's pictures");
    let named: Vec<Quality> = arguments.map(|name| name.parse().unwrap_or_else(|e| panic!("{e}"))).collect();
    let qualities = if named.is_empty() { vec![Quality::Medium] } else { named };
    let cases = cases(Path::new(&directory));
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}).\n", info.name, info.driver, info.driver_version);
    println!(
        "| scene | quality | scattering | RMS ln, cloudy | energy | pixels + too noisy | RMS ln, thin | FLIP | clouds ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for case in &cases {
        for &quality in &qualities {
            for scattering in CloudScattering::ALL {
                let clouds = CloudSettings { scattering, ..CloudSettings::of(quality) };
                let settings = Settings { clouds, ..Settings::of(quality) };
                let outputs = Outputs { capture: true, picture: false };
                let rendered =
                    renderer.render(&case.scene, settings, outputs).unwrap_or_else(|error| panic!("{error}"));
                let (rms, energy, pixels, noisy) = score(case, &rendered.frame, 0.5..1.1);
                let (thin, ..) = score(case, &rendered.frame, 0.03..0.3);
                let flip = compare(&rendered.frame, &case.truth).map_or(f64::NAN, |comparison| comparison.mean_flip);
                let of_clouds = |name: &str| name.starts_with("cloud") || name.starts_with("ordinates");
                let times = rendered.timings.milliseconds.iter().filter(|(name, _)| of_clouds(name));
                let milliseconds: f64 = times.map(|(_, time)| time).sum();
                println!(
                    "| {} | {quality} | {scattering:?} | {rms:.2} | {energy:.2} | {pixels} + {noisy} | {thin:.2} | {flip:.3} | {milliseconds:.0} |",
                    case.name
                );
            }
        }
    }
}
