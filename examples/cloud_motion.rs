//! What following clouds from frame to frame costs in accuracy, and saves in time; prints Markdown.
//!
//! `cargo run --release --example cloud_motion -- [--quality NAME]... [--frames N] [--width PIXELS]`
//!
//! A camera turns by 9° a second and rises by 2 m/s under cumulus that a wind of 10 m/s carries, 24 frames a second, and looks
//! the other way in the last frame. Each frame is rendered as one of the sequence and by itself: the truth here is the
//! same renderer that marches every pixel. All numbers are of green where clouds hide a tenth of the sky or more.
//!
//! - *error*: root mean square of the difference over the truth's mean; *stale*, for comparison, that of the truth of the
//!   frame before.
//! - *lag*: frames by which the sequence is late: minus the regression of the difference on the truth's change in a frame.
//! - *flicker*: root mean square of what changes from frame to frame and does not in the truth, over the mean; beside it
//!   what changes in the truth.
//! - *ghosts*: mean opacity left in pixels that have become clear within eight frames, with all pixels around, so that it is not
//!   the noise of edges.
//! - *cut*: largest difference right after the cut.

use clap::Parser;
use welkin::gpu::DeviceRequest;
use welkin::plan::{CloudSettings, Outputs, Quality, Settings};
use welkin::renderer::{Rendered, Renderer};
use welkin::scene::Scene;

const GREEN: usize = 1;

#[derive(Parser)]
struct Arguments {
    /// Qualities to measure; by default low, medium and high.
    #[arg(long = "quality")]
    qualities: Vec<Quality>,
    /// Frames before the cut.
    #[arg(long, default_value_t = 40)]
    frames: u32,
    /// Pixels across.
    #[arg(long, default_value_t = 256)]
    width: u32,
}

/// The path: every frame's scene, the last after a cut.
fn path(arguments: &Arguments) -> Vec<Scene> {
    let text = "preset = \"earth\"\n[[clouds]]\nkind = \"cumulus\"\nwind_m_per_s = [10, 0]\n\
        [sun]\nelevation_deg = 40\nazimuth_deg = 120\n\
        [camera]\naltitude_m = 2\nelevation_deg = 22\nazimuth_deg = 0\nvertical_field_of_view_deg = 55\n";
    let mut scene = Scene::parse(text, std::path::Path::new("motion.toml")).unwrap_or_else(|error| panic!("{error}"));
    (scene.camera.width, scene.camera.height) = (arguments.width, arguments.width * 9 / 16);
    let frame = |i: u32| {
        let (mut frame, time_s) = (scene.clone(), f64::from(i) / 24.0);
        frame.time_s = time_s;
        frame.camera.direction.azimuth_rad += 9_f64.to_radians() * time_s;
        frame.camera.altitude_m += 2.0 * time_s;
        frame
    };
    let mut behind = frame(arguments.frames);
    behind.camera.direction.azimuth_rad += 2.5;
    (0..arguments.frames).map(frame).chain([behind]).collect()
}

/// What a frame shows: radiance, and opacity of the clouds alone.
struct Seen {
    radiance: Vec<f64>,
    opacity: Vec<f64>,
    milliseconds: f64,
}

impl Seen {
    fn new(rendered: &Rendered, clear: &Rendered) -> Self {
        let ours = ["clouds", "cloud_reconstruction"];
        let time = |name: &&str| rendered.timings.milliseconds.get(*name).copied().unwrap_or(0.0);
        let pixels = rendered.frame.transmittance.iter().zip(&clear.frame.transmittance);
        Self {
            radiance: rendered.frame.radiance.iter().map(|pixel| f64::from(pixel[GREEN])).collect(),
            opacity: pixels.map(|(a, b)| 1.0 - f64::from(a[GREEN] / b[GREEN].max(1e-6))).collect(),
            milliseconds: ours.iter().map(time).sum(),
        }
    }
}

/// The frames of one setting: in sequence, and each by itself.
struct Run {
    width: usize,
    followed: Vec<Seen>,
    alone: Vec<Seen>,
}

impl Run {
    fn new(scenes: &[Scene], settings: Settings) -> Self {
        let outputs = Outputs { capture: true, picture: false };
        let open = || Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
        let (mut in_sequence, mut by_itself, mut without) = (open(), open(), open());
        let (mut followed, mut alone) = (Vec::new(), Vec::new());
        for scene in scenes {
            let clear = Scene { clouds: Vec::new(), ..scene.clone() };
            let clear = without.render(&clear, settings, outputs).unwrap_or_else(|error| panic!("{error}"));
            let a = in_sequence.render_next(scene, settings, outputs).unwrap_or_else(|error| panic!("{error}"));
            let b = by_itself.render(scene, settings, outputs).unwrap_or_else(|error| panic!("{error}"));
            followed.push(Seen::new(&a, &clear));
            alone.push(Seen::new(&b, &clear));
        }
        Self { width: scenes[0].camera.width as usize, followed, alone }
    }

    /// Sums over the cloudy pixels of all frames from the third on but the last, of what `term` makes of (found, truth,
    /// found before, truth before).
    fn sum(&self, found: &[Seen], term: impl Fn([f64; 4]) -> f64) -> f64 {
        let mut sum = 0.0;
        for t in 2..self.alone.len() - 1 {
            for i in (0..self.alone[t].radiance.len()).filter(|&i| self.alone[t].opacity[i] > 0.1) {
                let at = |frames: &[Seen], t: usize| frames[t].radiance[i];
                sum += term([at(found, t), at(&self.alone, t), at(found, t - 1), at(&self.alone, t - 1)]);
            }
        }
        sum
    }

    /// Root mean square over the truth's mean.
    fn relative(&self, found: &[Seen], term: impl Fn([f64; 4]) -> f64) -> f64 {
        let (count, mean) = (self.sum(found, |_| 1.0), self.sum(found, |[_, truth, ..]| truth));
        (self.sum(found, |terms| term(terms).powi(2)) * count).sqrt() / mean
    }

    fn lag(&self, found: &[Seen]) -> f64 {
        -self.sum(found, |[a, b, _, before]| (a - b) * (b - before))
            / self.sum(found, |[_, b, _, before]| (b - before).powi(2))
    }

    /// Mean opacity where there is none any more, and of how many pixels.
    fn ghosts(&self) -> (f64, usize) {
        let (mut sum, mut count) = (0.0, 0);
        for t in 8..self.alone.len() - 1 {
            for i in 0..self.alone[t].opacity.len() {
                let was_cloudy = (t - 8..t).any(|before| self.alone[before].opacity[i] > 0.5);
                if was_cloudy && self.is_clear_around(t, i) {
                    sum += self.followed[t].opacity[i];
                    count += 1;
                }
            }
        }
        (sum / count.max(1) as f64, count)
    }

    /// Whether a pixel and its eight neighbours see no cloud; at the picture's edge they are not all known.
    fn is_clear_around(&self, t: usize, pixel: usize) -> bool {
        let (width, opacity) = (self.width, &self.alone[t].opacity);
        let (x, y) = (pixel % width, pixel / width);
        let inside = x > 0 && x + 1 < width && y > 0 && (y + 2) * width <= opacity.len();
        inside && (0..9).all(|k| opacity[(y + k / 3 - 1) * width + x + k % 3 - 1] < 0.01)
    }

    fn cut(&self) -> f64 {
        let last = self.alone.len() - 1;
        let pairs = self.followed[last].radiance.iter().zip(&self.alone[last].radiance);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Median time of clouds over that of frames by themselves, one beside the other.
    fn time_ratio(&self) -> f64 {
        let frames = 1..self.alone.len() - 1;
        let mut ratios: Vec<f64> = frames.map(|t| self.followed[t].milliseconds / self.alone[t].milliseconds).collect();
        ratios.sort_by(f64::total_cmp);
        ratios[ratios.len() / 2]
    }
}

/// The truth, a frame late: what a sequence that only repeats the frame before would show.
fn late(frames: &[Seen]) -> Vec<Seen> {
    let copy = |t: usize| {
        let Seen { radiance, opacity, milliseconds } = &frames[t];
        Seen { radiance: radiance.clone(), opacity: opacity.clone(), milliseconds: *milliseconds }
    };
    (0..frames.len()).map(|t| copy(t.saturating_sub(1))).collect()
}

fn main() {
    let arguments = Arguments::parse();
    let scenes = path(&arguments);
    println!("{} x {} pixels, {} frames\n", arguments.width, arguments.width * 9 / 16, arguments.frames);
    println!(
        "| quality | marched | error (stale) | lag (stale), frames | flicker (truth's change) | ghosts, pixels | cut | time |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let all = [Quality::Low, Quality::Medium, Quality::High];
    let qualities = if arguments.qualities.is_empty() { &all[..] } else { &arguments.qualities };
    for &quality in qualities {
        // Of every pixel the light alone is late.
        for block in [1, 2, 4] {
            let clouds = CloudSettings { block, ..CloudSettings::of(quality) };
            let run = Run::new(&scenes, Settings { clouds, ..Settings::of(quality) });
            let (followed, stale) = (&run.followed, &late(&run.alone));
            let error = |found: &[Seen]| run.relative(found, |[a, b, ..]| a - b);
            let flicker = run.relative(followed, |[a, b, a_before, b_before]| (a - a_before) - (b - b_before));
            let change = run.relative(followed, |[_, b, _, before]| b - before);
            let (ghosts, pixels) = run.ghosts();
            println!(
                "| {quality} | 1/{} | {:.3} ({:.3}) | {:.2} ({:.2}) | {flicker:.3} ({change:.3}) | {ghosts:.4}, {pixels} | {:.0e} | {:.2} |",
                block * block,
                error(followed),
                error(stale),
                run.lag(followed),
                run.lag(stale),
                run.cut(),
                run.time_ratio(),
            );
        }
    }
}
