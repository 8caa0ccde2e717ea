//! Clouds in real time against pictures of the path tracer; prints Markdown.
//!
//! For each `scenes/clouds/NAME.toml` of which there is a `DIR/NAME.exr`, made by `welkin reference` from that scene at any
//! size, or several `DIR/NAME-SEED.exr` of one size and as many walks, of which the mean is taken:
//! `cargo run --release --example compare_clouds -- DIR [--of FOLDER] [--quality NAME]... [--form NAME]... [--scene NAME]...`
//!
//! Pixels count as cloudy where clouds hide more than half of what is behind them, and as thin from 0.03 to 0.3. Pixels that the
//! horizon runs through count as neither: a picture covers them, the truth looks through their middle. With
//! `--pictures FOLDER` what was rendered is written there.

use std::path::{Path, PathBuf};

use clap::Parser;
use glam::DVec3;
use welkin::frame::Frame;
use welkin::gpu::DeviceRequest;
use welkin::output::{AtomicFile, read_exr, write_exr};
use welkin::plan::{CloudScattering, CloudSettings, Outputs, Quality, Settings};
use welkin::reference::World;
use welkin::renderer::{Rendered, Renderer};
use welkin::report::compare;
use welkin::scene::Scene;

/// The band that is compared.
const GREEN: usize = 1;

#[derive(Parser)]
struct Arguments {
    /// Folder of the path tracer's pictures.
    directory: PathBuf,
    /// Qualities to compare.
    #[arg(long = "quality", default_value = "medium")]
    qualities: Vec<Quality>,
    /// How light is scattered more than once, as in `CloudScattering`; all of them without.
    #[arg(long = "form")]
    forms: Vec<String>,
    /// Scenes to compare; all of them without.
    #[arg(long = "scene")]
    scenes: Vec<String>,
    /// Means over so many pixels a side are compared, of pictures as of truths: they have less noise.
    #[arg(long, default_value_t = 1)]
    block: u32,
    /// Folder of other scenes than `scenes/clouds/`.
    #[arg(long)]
    of: Option<PathBuf>,
    /// Shaders to take in place of the built-in ones.
    #[arg(long)]
    shaders: Option<PathBuf>,
    /// Where to write what was rendered.
    #[arg(long)]
    pictures: Option<PathBuf>,
    /// Other grids for the ordinates than the quality's: edge of the smallest cells, m; cells across; sweeps.
    #[arg(long, num_args = 3, value_names = ["METRES", "CELLS", "SWEEPS"])]
    grid: Option<Vec<u32>>,
}

impl Arguments {
    fn clouds(&self, quality: Quality, scattering: CloudScattering) -> CloudSettings {
        let preset = CloudSettings { scattering, ..CloudSettings::of(quality) };
        match self.grid.as_deref() {
            Some(&[ordinate_cell_m, ordinate_cells, sweeps]) => {
                CloudSettings { ordinate_cell_m, ordinate_cells, sweeps, ..preset }
            }
            _ => preset,
        }
    }
}

/// A scene with what the path tracer sees of it.
struct Case {
    name: String,
    scene: Scene,
    truth: Frame,
    /// Of the clouds, pixel by pixel.
    opacity: Vec<f64>,
}

impl Case {
    /// Means over blocks.
    fn opacity_of_blocks(&self, side: u32) -> Vec<f64> {
        let mut frame = Frame::new(self.truth.width, self.truth.height);
        frame.radiance = self.opacity.iter().map(|&opacity| [opacity as f32; 3]).collect();
        in_blocks(&frame, side).radiance.iter().map(|pixel| f64::from(pixel[GREEN])).collect()
    }
}

fn cases(directory: &Path, scenes: &Path) -> Vec<Case> {
    let mut paths: Vec<PathBuf> = scenes.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let case = |path: &PathBuf| {
        let name = path.file_stem()?.to_str()?.to_owned();
        let pictures: Vec<Frame> = pictures_of(directory, &name)
            .iter()
            .map(|picture| read_exr(picture).unwrap_or_else(|error| panic!("{error}")))
            .collect();
        if pictures.is_empty() {
            eprintln!("note: there is no picture of {name}");
            return None;
        }
        let truth = mean(&pictures);
        let mut scene = Scene::read(path).unwrap_or_else(|error| panic!("{error}"));
        (scene.camera.width, scene.camera.height) = (truth.width, truth.height);
        let opacity = opacity(&scene);
        Some(Case { name, scene, truth, opacity })
    };
    paths.iter().filter_map(case).collect()
}

/// Files of a scene's truth.
fn pictures_of(directory: &Path, name: &str) -> Vec<PathBuf> {
    let is_ours = |path: &PathBuf| {
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let seed = stem.strip_prefix(name).map(|rest| rest.strip_prefix('-').unwrap_or(rest));
        path.extension().is_some_and(|ending| ending == "exr")
            && seed.is_some_and(|s| s.chars().all(|c| c.is_ascii_digit()))
    };
    directory.read_dir().unwrap().map(|entry| entry.unwrap().path()).filter(is_ours).collect()
}

/// Of independent pictures of one scene.
fn mean(pictures: &[Frame]) -> Frame {
    let count = pictures.len() as f32;
    let mut mean = pictures[0].clone();
    let of = |i: usize, band: usize| pictures.iter().map(move |picture| picture.radiance[i][band]);
    let error = |i: usize, band: usize| {
        let variance = |picture: &Frame| picture.standard_error.as_ref().map_or(0.0, |errors| errors[i][band].powi(2));
        pictures.iter().map(variance).sum::<f32>().sqrt() / count
    };
    for i in 0..mean.radiance.len() {
        mean.radiance[i] = [0, 1, 2].map(|band| of(i, band).sum::<f32>() / count);
    }
    let errors = (0..mean.radiance.len()).map(|i| [0, 1, 2].map(|band| error(i, band))).collect();
    mean.standard_error = pictures[0].standard_error.is_some().then_some(errors);
    mean
}

/// What the clouds alone hide along the ray through each pixel's centre; not a number in pixels on the horizon.
fn opacity(scene: &Scene) -> Vec<f64> {
    let world = World::from_scene(scene);
    let camera = &scene.camera;
    let position = DVec3::new(0.0, 0.0, camera.altitude_m);
    let radius_m = scene.planet.radius_m;
    let horizon_sine = -(1.0 - (radius_m / (radius_m + camera.altitude_m.max(0.0))).powi(2)).sqrt();
    let pixel = |i: u32| {
        let (x, y) = (f64::from(i % camera.width) + 0.5, f64::from(i / camera.width) + 0.5);
        let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)];
        let below = corners.map(|(dx, dy)| camera.direction_through(x + dx, y + dy).z < horizon_sine);
        if below.contains(&true) && below.contains(&false) {
            return f64::NAN;
        }
        let direction = camera.direction_through(x, y);
        let Some(span) = world.shape.span(position, direction) else { return 0.0 };
        let depth =
            |body: &welkin::reference::Body| body.optical_depth(position, direction, span.start_m, span.end_m)[GREEN];
        1.0 - (-world.bodies.iter().map(depth).sum::<f64>()).exp()
    };
    (0..camera.width * camera.height).map(pixel).collect()
}

/// Means over blocks of pixels, with their standard errors.
fn in_blocks(frame: &Frame, side: u32) -> Frame {
    let mut means = Frame::new(frame.width / side, frame.height / side);
    let errors = frame.standard_error.as_ref();
    let mut mean_errors = Vec::new();
    for i in 0..means.width * means.height {
        let (x, y) = (i % means.width * side, i / means.width * side);
        let pixels = (0..side * side).map(|k| ((y + k / side) * frame.width + x + k % side) as usize);
        let count = (side * side) as f32;
        means.radiance[i as usize] =
            [0, 1, 2].map(|band| pixels.clone().map(|p| frame.radiance[p][band]).sum::<f32>() / count);
        let variance =
            |band: usize| pixels.clone().map(|p| errors.map_or(0.0, |errors| errors[p][band].powi(2))).sum::<f32>();
        mean_errors.push([0, 1, 2].map(|band| variance(band).sqrt() / count));
    }
    means.standard_error = errors.map(|_| mean_errors);
    means
}

/// How far a picture is from the truth over some of its pixels.
struct Score {
    /// Root mean square of ln(ratio), the truth's own noise taken out.
    rms: f64,
    /// That noise: root mean square of the relative standard error.
    noise: f64,
    /// Ratio of the sums of all light, and its standard error.
    energy: [f64; 2],
    pixels: usize,
}

impl Score {
    fn new(case: &Case, found: &Frame, side: u32, opacities: std::ops::Range<f64>) -> Self {
        let (truth, found) = (in_blocks(&case.truth, side), in_blocks(found, side));
        let opacity = case.opacity_of_blocks(side);
        let (mut squares, mut noise, mut variance, mut sums, mut pixels) = (0.0, 0.0, 0.0, [0.0; 2], 0);
        for i in (0..found.radiance.len()).filter(|&i| opacities.contains(&opacity[i])) {
            let (a, b) = (f64::from(found.radiance[i][GREEN]), f64::from(truth.radiance[i][GREEN]));
            let error = truth.standard_error.as_ref().map_or(0.0, |errors| f64::from(errors[i][GREEN]));
            sums = [sums[0] + a, sums[1] + b];
            squares += (a.max(1e-9) / b.max(1e-9)).ln().powi(2);
            noise += (error / b.max(1e-9)).powi(2);
            variance += error * error;
            pixels += 1;
        }
        let ratio = sums[0] / sums[1];
        Self {
            rms: ((squares - noise) / pixels as f64).max(0.0).sqrt(),
            noise: (noise / pixels as f64).sqrt(),
            energy: [ratio, ratio * variance.sqrt() / sums[1]],
            pixels,
        }
    }
}

/// Milliseconds of all passes of clouds.
fn of_clouds(rendered: &Rendered) -> f64 {
    let ours = |name: &str| name.starts_with("cloud") || name.starts_with("ordinates");
    rendered.timings.milliseconds.iter().filter(|(name, _)| ours(name)).map(|(_, time)| time).sum()
}

fn print_row(case: &Case, side: u32, quality: Quality, scattering: CloudScattering, rendered: &Rendered) {
    let score = |opacities| Score::new(case, &rendered.frame, side, opacities);
    let (cloudy, thin) = (score(0.5..1.1), score(0.03..0.3));
    let flip = compare(&rendered.frame, &case.truth).map_or(f64::NAN, |comparison| comparison.mean_flip);
    let [energy, error] = cloudy.energy;
    println!(
        "| {} | {quality} | {scattering:?} | {:.2} ({:.2}) | {energy:.2} ± {error:.2} | {} | {:.2} ({:.2}), {} | {flip:.3} | {:.0} |",
        case.name,
        cloudy.rms,
        cloudy.noise,
        cloudy.pixels,
        thin.rms,
        thin.noise,
        thin.pixels,
        of_clouds(rendered),
    );
}

fn main() {
    let arguments = Arguments::parse();
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/clouds");
    let mut cases = cases(&arguments.directory, arguments.of.as_ref().unwrap_or(&scenes));
    cases.retain(|case| arguments.scenes.is_empty() || arguments.scenes.contains(&case.name));
    let chosen = |form: &CloudScattering| arguments.forms.is_empty() || arguments.forms.contains(&format!("{form:?}"));
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    if let Some(folder) = &arguments.shaders {
        renderer.take_shaders_from(folder).unwrap_or_else(|error| panic!("{error}"));
    }
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}).\n", info.name, info.driver, info.driver_version);
    println!(
        "| scene | quality | form | RMS of ln, cloudy (noise) | energy | pixels | thin (noise), pixels | FLIP | clouds, ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for case in &cases {
        for &quality in &arguments.qualities {
            for scattering in CloudScattering::ALL.into_iter().filter(chosen) {
                let clouds = arguments.clouds(quality, scattering);
                let settings = Settings { clouds, ..Settings::of(quality) };
                let outputs = Outputs { capture: true, picture: false };
                let rendered =
                    renderer.render(&case.scene, settings, outputs).unwrap_or_else(|error| panic!("{error}"));
                print_row(case, arguments.block, quality, scattering, &rendered);
                if let Some(folder) = &arguments.pictures {
                    let path = folder.join(format!("{}-{quality}-{scattering:?}.exr", case.name));
                    let file = AtomicFile::create(&path).unwrap_or_else(|error| panic!("{error}"));
                    write_exr(file, &rendered.frame, &case.scene).unwrap_or_else(|error| panic!("{error}"));
                }
            }
        }
    }
}
