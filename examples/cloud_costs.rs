//! What each optimisation of the clouds saves, as ratios within one run, and the memory of their volumes; prints Markdown.
//!
//! `cargo run --release --example cloud_costs -- [--quality NAME]... [--rounds N] [--width PIXELS] [--truth EXR] [--beside-brute-force]`
//!
//! A camera turns a little with each frame. Every round renders the frame in each way, one after the other, so that all of
//! them meet the same load; medians over the rounds, of the passes `clouds` and `cloud_reconstruction`:
//!
//! - *followed*: as a frame of a sequence, over every pixel marched;
//! - *nothing skipped*: empty space in the layers is marched through, over the same with skipping;
//! - *light marched*: 32 points towards a light for every sample in place of the cached depths, over the same with them;
//! - *light anew*: the passes that make cached light, from nothing, of which the picture's size changes nothing, ms;
//! - *light following*: the same in a frame of a sequence in which clouds and sun move, the mean over as many frames as rounds, ms;
//! - *brute force*: 64 steps through the layer, six looks at the field towards the light from each, eight octaves, every pixel
//!   and nothing skipped, over a followed frame.
//!
//! With `--beside-brute-force` only followed frames and brute force, and brute force that looks towards the light where there is no cloud
//! as well. With a picture of the scene that the path tracer has made,
//! of a width that divides the frames', also how far both are from it: the root mean square of ln(ratio) in green, over all its pixels, of
//! the means over them of a frame that ends a turn of the camera. The truth's own noise is in both.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use clap::Parser;
use welkin::frame::Frame;
use welkin::gpu::{Clock, DeviceKind, DeviceRequest, Gpu};
use welkin::output::read_exr;
use welkin::passes::ShaderSources;
use welkin::plan::{CloudScattering, CloudSettings, Decision, Outputs, Quality, Settings};
use welkin::renderer::{Rendered, Renderer};
use welkin::scene::{Light, Scene};

#[derive(Parser)]
struct Arguments {
    /// Qualities to measure; all without.
    #[arg(long = "quality")]
    qualities: Vec<Quality>,
    /// Frames of each way.
    #[arg(long, default_value_t = 5)]
    rounds: u32,
    /// Pixels across.
    #[arg(long, default_value_t = 1280)]
    width: u32,
    /// The scene.
    #[arg(long, default_value = "scenes/clouds/fair-cumulus.toml")]
    scene: String,
    /// A picture of the scene by the path tracer, of any size.
    #[arg(long)]
    truth: Option<PathBuf>,
    /// Measures nothing but followed frames and brute force.
    #[arg(long)]
    beside_brute_force: bool,
}

/// Steps enough for rays that skip nothing.
const MANY_STEPS: u32 = 1 << 14;

/// Shaders that skip no empty space.
fn without_skipping() -> ShaderSources {
    let text = include_str!("../shaders/wgsl/cloud_skip.wgsl");
    let head = "rise: f32) -> f32 {\n";
    assert!(text.contains(head), "the skipping of empty space has changed");
    let text = text.replace(head, &format!("{head}    if true {{ return 0.0; }}\n"));
    ShaderSources::embedded().with("cloud_skip.wgsl", Cow::Owned(text))
}

/// Where brute force looks towards the light.
#[derive(Clone, Copy, PartialEq)]
enum Lit {
    Clouds,
    Everywhere,
}

/// Those that take 64 equal steps through a layer as well.
fn brute_force(lit: Lit) -> ShaderSources {
    let text = include_str!("../shaders/wgsl/clouds.wgsl");
    let [body, cloud] = ["if is_any_above_zero(&bodies) {", "if (*march).extinction > 0.0 {"];
    assert!(text.contains(body) && text.contains(cloud), "the march has changed");
    let text = match lit {
        Lit::Clouds => text.to_owned(),
        Lit::Everywhere => text.replace(body, "if true {").replace(cloud, "if true {"),
    };
    let step = text.lines().find(|line| line.contains("let step_m = min(min(growth")).expect("the march has changed");
    let text = text.replace(step, "let step_m = min((boundary_m - (*march).entered_m) / 64.0, boundary_m - t_m);");
    without_skipping().with("clouds.wgsl", Cow::Owned(text))
}

/// One way to render.
struct Way {
    renderer: Renderer,
    settings: Settings,
    in_sequence: bool,
    milliseconds: Vec<f64>,
    /// What the pass `clouds` takes of them.
    marched: Vec<f64>,
}

impl Way {
    fn new(quality: Quality, shaders: ShaderSources, clouds: CloudSettings, in_sequence: bool) -> Self {
        let gpu = Gpu::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
        let is_processor = gpu.info().kind == DeviceKind::Cpu;
        let mut renderer = Renderer::with_shaders(gpu, shaders).unwrap_or_else(|error| panic!("{error}"));
        if is_processor {
            renderer.set_clock(Clock::Processor);
        }
        Self {
            renderer,
            settings: Settings { clouds, ..Settings::of(quality) },
            in_sequence,
            milliseconds: Vec::new(),
            marched: Vec::new(),
        }
    }

    fn render(&mut self, scene: &Scene) -> Rendered {
        let outputs = Outputs::default();
        let rendered = match self.in_sequence {
            true => self.renderer.render_next(scene, self.settings, outputs),
            false => self.renderer.render(scene, self.settings, outputs),
        };
        rendered.unwrap_or_else(|error| panic!("{error}"))
    }

    fn median(&self) -> f64 {
        median(&self.milliseconds)
    }
}

fn median(milliseconds: &[f64]) -> f64 {
    let mut sorted = milliseconds.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

fn time(rendered: &Rendered, is_ours: impl Fn(&str) -> bool) -> f64 {
    rendered.timings.milliseconds.iter().filter(|(name, _)| is_ours(name)).map(|(_, time)| time).sum()
}

fn of_pixels(name: &str) -> bool {
    name == "clouds" || name == "cloud_reconstruction"
}

fn of_light(name: &str) -> bool {
    name == "cloud_density" || name == "cloud_light" || name.starts_with("ordinates")
}

/// How far a frame's means over the pixels of the path tracer's picture are from that.
fn rms_of_ln(found: &Frame, truth: &Frame) -> f64 {
    const GREEN: usize = 1;
    let block = found.width / truth.width;
    let mean = |x: u32, y: u32| {
        let pixels = (0..block * block).map(|i| (y * block + i / block) * found.width + x * block + i % block);
        let sum: f32 = pixels.map(|i| found.radiance[i as usize][GREEN]).sum();
        sum / (block * block) as f32
    };
    let places = (0..truth.height).flat_map(|y| (0..truth.width).map(move |x| (x, y)));
    let squares = places.zip(&truth.radiance).map(|((x, y), truth)| {
        let ratio = mean(x, y).max(1e-9) / truth[GREEN].max(1e-9);
        f64::from(ratio).ln().powi(2)
    });
    (squares.sum::<f64>() / truth.radiance.len() as f64).sqrt()
}

/// The error of the last of some frames in which the camera turns to where the truth was seen from.
fn error_after_turn(way: &mut Way, scene: &Scene, truth: &Frame) -> f64 {
    let frames_before = if way.in_sequence { 8 } else { 0 };
    for before in (1..=frames_before).rev() {
        let mut frame = scene.clone();
        frame.camera.direction.azimuth_rad -= 0.01 * f64::from(before);
        way.render(&frame);
    }
    rms_of_ln(&way.render(scene).frame, truth)
}

fn turned(scene: &Scene, round: u32) -> Scene {
    let mut frame = scene.clone();
    frame.camera.direction.azimuth_rad += 0.01 * f64::from(round);
    frame
}

/// Followed frames and brute force alone.
fn beside_brute_force(arguments: &Arguments, scene: &Scene, qualities: &[Quality]) {
    println!(
        "| quality | followed, ms | of that marched | brute force, ms | ratio | lit everywhere, ms | ratio | RMS of ln, followed | brute force |\n\
         |---|---|---|---|---|---|---|---|---|"
    );
    for &quality in qualities {
        let whole = CloudSettings { max_steps: MANY_STEPS, ..CloudSettings::of(quality) };
        let brute = CloudSettings { scattering: CloudScattering::OctavesAsShipped, near_samples: 6, ..whole };
        let mut ways = [
            Way::new(quality, ShaderSources::embedded(), whole, true),
            Way::new(quality, brute_force(Lit::Clouds), brute, false),
            Way::new(quality, brute_force(Lit::Everywhere), brute, false),
        ];
        let mut small = scene.clone();
        (small.camera.width, small.camera.height) = (64, 36);
        // Pipelines, noise and light, without the long wait for brute force at full size. Frames that follow have pipelines of
        // their own.
        ways[0].render(scene);
        ways[0].render(&turned(scene, 1));
        ways[1..].iter_mut().for_each(|way| {
            way.render(&small);
        });
        for round in 2..=arguments.rounds + 1 {
            let frame = turned(scene, round);
            for way in &mut ways {
                let rendered = way.render(&frame);
                way.milliseconds.push(time(&rendered, of_pixels));
                way.marched.push(time(&rendered, |name| name == "clouds"));
            }
        }
        let [followed, brute, everywhere] = ways.each_ref().map(Way::median);
        let marched = median(&ways[0].marched);
        let errors = arguments.truth.as_ref().map(|path| {
            let truth = read_exr(path).unwrap_or_else(|error| panic!("{error}"));
            let [followed, brute, _] = &mut ways;
            [followed, brute].map(|way| error_after_turn(way, scene, &truth))
        });
        let [ours, theirs] =
            errors.map_or(["–".to_owned(), "–".to_owned()], |e| e.map(|error| format!("{error:.3}")));
        println!(
            "| {quality} | {followed:.1} | {marched:.1} | {brute:.0} | {:.1} | {everywhere:.0} | {:.1} | {ours} | {theirs} |",
            brute / followed,
            everywhere / followed
        );
    }
}

/// A frame later: clouds that drift with 10 m/s, and a sun that goes round in a day, ten times as fast.
fn moved(scene: &Scene, round: u32) -> Scene {
    let mut frame = scene.clone();
    frame.time_s += f64::from(round) / 24.0;
    for light in &mut frame.lights {
        if let Light::Directional(light) = light {
            light.direction.elevation_rad += 10.0 * frame.time_s * std::f64::consts::TAU / 86_400.0;
        }
    }
    frame
}

fn main() {
    let arguments = Arguments::parse();
    let mut scene = Scene::read(Path::new(&arguments.scene)).unwrap_or_else(|error| panic!("{error}"));
    (scene.camera.width, scene.camera.height) = (arguments.width, arguments.width * 9 / 16);
    for layer in &mut scene.clouds {
        layer.wind_m_per_s = [10.0, 0.0];
    }
    println!("{}, {} x {} pixels\n", scene.name, scene.camera.width, scene.camera.height);
    let qualities = if arguments.qualities.is_empty() { &Quality::ALL[..] } else { &arguments.qualities };
    if arguments.beside_brute_force {
        return beside_brute_force(&arguments, &scene, qualities);
    }
    println!(
        "| quality | every pixel, ms | followed | nothing skipped | light marched | light anew, ms | light following, ms | brute force |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let mut memory = Vec::new();
    for &quality in qualities {
        let whole = CloudSettings { max_steps: MANY_STEPS, ..CloudSettings::of(quality) };
        let marched = CloudSettings { near_samples: 32, ..whole };
        let brute = CloudSettings { scattering: CloudScattering::OctavesAsShipped, near_samples: 6, ..whole };
        let embedded = ShaderSources::embedded;
        let mut ways = [
            Way::new(quality, embedded(), whole, false),
            Way::new(quality, embedded(), whole, true),
            Way::new(quality, without_skipping(), whole, false),
            Way::new(quality, embedded(), marched, false),
            Way::new(quality, brute_force(Lit::Clouds), brute, false),
        ];
        let mut following = Way::new(quality, embedded(), whole, true);
        following.render(&scene);
        let mut following_ms = 0.0;
        // The first frames make noise and light, and a sequence's is whole. Drivers compile in them: light is timed when it is made again.
        for way in &mut ways {
            way.render(&scene);
        }
        let light_ms = time(&ways[0].render(&Scene { time_s: scene.time_s + 3600.0, ..scene.clone() }), of_light);
        for round in 1..=arguments.rounds {
            let frame = turned(&scene, round);
            for way in &mut ways {
                let rendered = way.render(&frame);
                way.milliseconds.push(time(&rendered, of_pixels));
            }
            let moved = following.render(&moved(&scene, round));
            following_ms += time(&moved, of_light) / f64::from(arguments.rounds);
        }
        let [every, followed, unskipped, marched, brute] = ways.each_ref().map(Way::median);
        println!(
            "| {quality} | {every:.0} | {:.3} | {:.2} | {:.2} | {light_ms:.0} | {following_ms:.0} | {:.1} |",
            followed / every,
            unskipped / every,
            marched / every,
            brute / followed,
        );
        let sequence = ways[1].render(&scene).timings.plan;
        let kept = sequence.passes.into_iter().filter(|pass| pass.decision != Decision::Skip);
        memory.extend(
            kept.filter(|pass| of_pixels(pass.name) || of_light(pass.name) || pass.name.starts_with("cloud_"))
                .map(|pass| format!("| {quality} | {} | {:.1} |", pass.name, pass.bytes as f64 / f64::from(1 << 20))),
        );
    }
    println!("\n| quality | pass | MiB |\n|---|---|---|\n{}", memory.join("\n"));
}
