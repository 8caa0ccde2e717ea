//! Fog, local volumes and local lights in real time: against pictures of the path tracer, and their time; prints Markdown.
//!
//! For each `scenes/fog/NAME.toml`, or of another folder, of which there is a `DIR/NAME.exr`, made by `welkin reference` from that
//! scene at any size:
//! `cargo run --release --example compare_fog -- compare DIR [--scenes FOLDER] [--quality NAME]... [--scene NAME]...`
//!
//! The street lamp with light scattered once, and with all: `cargo run --release --example compare_fog -- lamp docs/images/street-lamp.png`
//!
//! Time against the number of lights and volumes, once all in view and once all behind the camera, as a table and a plot:
//! `cargo run --release --example compare_fog -- scaling docs/images/fog-scaling.svg`
//!
//! With `--shaders FOLDER` shaders come from there, as somebody edits them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand};
use plotters::prelude::*;
use welkin::gpu::DeviceRequest;
use welkin::output::{AtomicFile, read_exr, write_exr, write_png};
use welkin::plan::{CloudScattering, Outputs, Quality, Settings};
use welkin::renderer::{Rendered, Renderer};
use welkin::report::compare;
use welkin::scene::Scene;

#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
    /// Qualities to render at.
    #[arg(long = "quality", default_value = "medium", global = true)]
    qualities: Vec<Quality>,
    /// Folder of the scenes.
    #[arg(long = "scenes", global = true, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/fog"))]
    folder: PathBuf,
    /// Scenes to render; all of them without.
    #[arg(long = "scene", global = true)]
    scenes: Vec<String>,
    /// A folder of WGSL in place of the built-in.
    #[arg(long, global = true)]
    shaders: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Task {
    /// Against the path tracer.
    Compare {
        /// Folder of the path tracer's pictures.
        directory: PathBuf,
        /// Where to write what was rendered.
        #[arg(long)]
        pictures: Option<PathBuf>,
    },
    /// The street lamp in fog: light that was scattered once, and below it all light.
    Lamp {
        /// The picture to write.
        picture: PathBuf,
    },
    /// Time against the number of lights and volumes.
    Scaling {
        /// The plot to write.
        plot: PathBuf,
    },
}

/// Milliseconds of the passes of fog, volumes and local lights.
fn of_media(rendered: &Rendered) -> f64 {
    let ours = ["volume_light", "local_clusters", "lamp_froxels", "local_media", "media_interpolation"];
    ours.iter().filter_map(|name| rendered.timings.milliseconds.get(*name)).sum()
}

fn fog_scenes(arguments: &Arguments) -> Vec<(String, Scene)> {
    let mut paths: Vec<PathBuf> = arguments.folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let named = |path: PathBuf| {
        let name = path.file_stem()?.to_str()?.to_owned();
        let wanted = path.extension()? == "toml" && (arguments.scenes.is_empty() || arguments.scenes.contains(&name));
        wanted.then(|| (name, Scene::read(&path).unwrap_or_else(|error| panic!("{error}"))))
    };
    paths.into_iter().filter_map(named).collect()
}

fn compare_all(renderer: &mut Renderer, arguments: &Arguments, directory: &Path, pictures: Option<&Path>) {
    println!(
        "| scene | quality | RMS of ln (noise of the truth) | energy | energy without the brightest hundredth of pixels | \
         median of pixels | FLIP | fog, volumes and lights, ms |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (name, mut scene) in fog_scenes(arguments) {
        let picture = directory.join(format!("{name}.exr"));
        let truth = picture.exists().then(|| read_exr(&picture).unwrap_or_else(|error| panic!("{error}")));
        if let Some(truth) = &truth {
            (scene.camera.width, scene.camera.height) = (truth.width, truth.height);
        }
        for &quality in &arguments.qualities {
            let outputs = Outputs { capture: true, picture: true };
            // The first frame has the driver compile.
            renderer.render(&scene, Settings::of(quality), outputs).unwrap_or_else(|error| panic!("{error}"));
            renderer.forget();
            let rendered =
                renderer.render(&scene, Settings::of(quality), outputs).unwrap_or_else(|error| panic!("{error}"));
            match &truth {
                Some(truth) => {
                    let comparison = compare(&rendered.frame, truth).unwrap_or_else(|error| panic!("{error}"));
                    let noise = relative_noise(truth);
                    let [rest, median] = ratios(&rendered.frame.radiance, &truth.radiance);
                    println!(
                        "| {name} | {quality} | {:.3} ({noise:.3}) | {:.3} | {rest:.3} | {median:.3} | {:.3} | {:.0} |",
                        (comparison.rms_ln_ratio.powi(2) - noise * noise).max(0.0).sqrt(),
                        comparison.energy_ratio,
                        comparison.mean_flip,
                        of_media(&rendered)
                    );
                }
                None => {
                    eprintln!("note: there is no '{}'; {name} took {:.0} ms", picture.display(), of_media(&rendered))
                }
            }
            if let Some(folder) = pictures {
                let file = |ending| {
                    let path = folder.join(format!("{name}-{quality}.{ending}"));
                    AtomicFile::create(&path).unwrap_or_else(|error| panic!("{error}"))
                };
                write_exr(file("exr"), &rendered.frame, &scene).unwrap_or_else(|error| panic!("{error}"));
                let (width, height) = (scene.camera.width, scene.camera.height);
                let picture = rendered.picture.as_deref().unwrap_or_default();
                write_png(file("png"), width, height, picture).unwrap_or_else(|error| panic!("{error}"));
            }
        }
    }
}

/// The street lamp's picture twice, one below the other.
fn lamp(renderer: &mut Renderer, quality: Quality, path: &Path) {
    let scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/fog/street-lamp.toml")).unwrap();
    let all = Settings::of(quality);
    let mut single = all;
    single.clouds.scattering = CloudScattering::Single;
    let mut pixels = Vec::new();
    for settings in [single, all] {
        let rendered = renderer.render(&scene, settings, Outputs { capture: false, picture: true });
        pixels.extend(rendered.unwrap_or_else(|error| panic!("{error}")).picture.unwrap_or_default());
    }
    let file = AtomicFile::create(path).unwrap_or_else(|error| panic!("{error}"));
    write_png(file, scene.camera.width, 2 * scene.camera.height, &pixels).unwrap_or_else(|error| panic!("{error}"));
}

/// Light over that of the truth: of all but the brightest hundredth of the pixels, as a lamp's own pixel may hold half of a picture's light and
/// its middle is not its mean; and the median of pixels.
fn ratios(found: &[[f32; 3]], truth: &[[f32; 3]]) -> [f64; 2] {
    let sum = |pixel: &[f32; 3]| pixel.iter().map(|&value| f64::from(value)).sum::<f64>();
    let mut pairs: Vec<_> = found.iter().zip(truth).map(|(found, truth)| [sum(found), sum(truth)]).collect();
    pairs.sort_by(|a, b| a[0].max(a[1]).total_cmp(&b[0].max(b[1])));
    let rest = &pairs[..pairs.len() - pairs.len() / 100];
    let total = |which: usize| rest.iter().map(|pair| pair[which]).sum::<f64>();
    let mut shares: Vec<_> = pairs.iter().map(|[found, truth]| found / truth).collect();
    shares.sort_by(f64::total_cmp);
    [total(0) / total(1), shares[shares.len() / 2]]
}

/// Root mean square over pixels and bands of the truth's standard error over its radiance.
fn relative_noise(truth: &welkin::frame::Frame) -> f64 {
    let Some(errors) = &truth.standard_error else { return 0.0 };
    let pairs = truth.radiance.iter().flatten().zip(errors.iter().flatten());
    let squares: Vec<f64> = pairs.filter(|(l, _)| **l > 0.0).map(|(l, e)| f64::from(e / l).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// Numbers of lights or volumes.
const COUNTS: [usize; 4] = [1, 10, 100, 1000];
/// Frames of which the median counts, after one in which the driver compiles.
const FRAMES: usize = 3;
/// Where a frame takes longer, that one frame counts: compiling takes less than a second of it.
const LONG_MS: f64 = 15e3;

/// So many lights or volumes in light fog, in rows of ever the same distance, before the camera or behind it.
fn crowd(of_lights: bool, count: usize, behind: bool) -> Scene {
    let side = (count as f64).sqrt().ceil() as usize;
    let mut text = "preset = \"earth\"\nsun = { elevation_deg = -20, azimuth_deg = 0 }\n\
        camera = { altitude_m = 12, elevation_deg = -10, azimuth_deg = 0, width = 320, height = 180 }\n\
        [[fog]]\nextinction_per_m = 0.01\nprofile.layer.top_m = 40\n"
        .to_owned();
    for i in 0..count {
        let east = 25.0 * ((i % side) as f64 - 0.5 * (side - 1) as f64);
        let north = 30.0 + 25.0 * (i / side) as f64;
        let north = if behind { -north } else { north };
        let _ = if of_lights {
            writeln!(text, "[[light.point]]\nname = \"{i}\"\nposition_m = [{east}, {north}, 6]\nintensity = 1")
        } else {
            writeln!(
                text,
                "[[volumes]]\nname = \"{i}\"\nshape = \"ellipsoid\"\ncentre_m = [{east}, {north}, 6]\nsize_m = [8, 8, 8]\n\
                 scattering_per_m = 0.2\nphase = \"isotropic\""
            )
        };
    }
    Scene::parse(&text, Path::new("crowd.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn median_ms(renderer: &mut Renderer, scene: &Scene, quality: Quality) -> f64 {
    let outputs = Outputs { capture: false, picture: true };
    let mut frame_ms = || {
        renderer.forget();
        let rendered = renderer.render(scene, Settings::of(quality), outputs);
        of_media(&rendered.unwrap_or_else(|error| panic!("{error}")))
    };
    let first_ms = frame_ms();
    if first_ms > LONG_MS {
        return first_ms;
    }
    let mut times: Vec<f64> = (0..FRAMES).map(|_| frame_ms()).collect();
    times.sort_by(f64::total_cmp);
    times[FRAMES / 2]
}

/// A line of the plot: what it is called, and (number, ms).
type Line = (&'static str, RGBColor, Vec<(f64, f64)>);

fn scaling(renderer: &mut Renderer, quality: Quality, plot: &Path) {
    let kinds = [
        ("lights in view", true, false, RGBColor(190, 30, 60)),
        ("lights behind the camera", true, true, RGBColor(220, 150, 160)),
        ("volumes in view", false, false, RGBColor(40, 90, 170)),
        ("volumes behind the camera", false, true, RGBColor(150, 175, 215)),
    ];
    let empty = median_ms(renderer, &crowd(true, 0, false), quality);
    println!("Fog alone: {empty:.0} ms.\n\n| | {} |", COUNTS.map(|count| count.to_string()).join(" | "));
    println!("|---|---|---|---|---|");
    let mut lines: Vec<Line> = Vec::new();
    for (name, of_lights, behind, colour) in kinds {
        let times = COUNTS.map(|count| median_ms(renderer, &crowd(of_lights, count, behind), quality));
        println!("| {name} | {} |", times.map(|ms| format!("{ms:.0}")).join(" | "));
        lines.push((name, colour, COUNTS.iter().map(|&count| count as f64).zip(times).collect()));
    }
    let svg = draw(&lines, &format!("{quality}, 320 x 180, {}", renderer.gpu().info().name)).unwrap();
    std::fs::write(plot, svg).unwrap_or_else(|error| panic!("{}: {error}", plot.display()));
}

fn draw(lines: &[Line], caption: &str) -> Result<String, Box<dyn std::error::Error>> {
    let mut svg = String::new();
    let times = || lines.iter().flat_map(|(.., points)| points.iter().map(|(_, ms)| *ms));
    let (least, most) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    {
        let root = SVGBackend::with_string(&mut svg, (860, 520)).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .margin(16)
            .caption(caption, ("sans-serif", 18))
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d((0.8..1250.0).log_scale(), (0.7 * least..1.4 * most).log_scale())?;
        chart.configure_mesh().x_desc("how many").y_desc("fog, volumes and lights, ms").draw()?;
        for (name, colour, points) in lines {
            let colour = *colour;
            chart
                .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)).point_size(4))?
                .label(*name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
        }
        chart.configure_series_labels().position(SeriesLabelPosition::UpperLeft).border_style(BLACK).draw()?;
        root.present()?;
    }
    Ok(svg)
}

fn main() {
    let arguments = Arguments::parse();
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    if let Some(folder) = &arguments.shaders {
        renderer.take_shaders_from(folder).unwrap_or_else(|error| panic!("{error}"));
    }
    let info = renderer.gpu().info();
    println!("Device: {} ({} {}).\n", info.name, info.driver, info.driver_version);
    match &arguments.task {
        Task::Compare { directory, pictures } => {
            compare_all(&mut renderer, &arguments, directory, pictures.as_deref());
        }
        Task::Lamp { picture } => lamp(&mut renderer, arguments.qualities[0], picture),
        Task::Scaling { plot } => scaling(&mut renderer, arguments.qualities[0], plot),
    }
}
