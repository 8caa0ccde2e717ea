//! A case, rendered and held to the laws and to the reference.

use welkin::frame::Frame;
use welkin::plan::{Outputs, Quality, Settings};
use welkin::probe::Orders;
use welkin::renderer::Renderer;
use welkin::scene::{Light, Scene};

use super::truth::{Truth, pixels, rays};
use super::{Case, laws};

/// Radiance, transmittance and distance: the laws hold for each.
pub const CAPTURE: Outputs = Outputs { capture: true, picture: false };

/// Distances at which transmittance must fall, m.
const DISTANCES_M: [f64; 6] = [1.0, 30.0, 1e3, 3e4, 1e6, f64::INFINITY];
/// What the path tracer's own noise may add, in standard errors: one in 1.7 million values lies beyond.
const SIGMAS: f64 = 5.0;
/// Values below this share of the case's brightest are measured against that share.
const DIM: f64 = 0.01;
/// Values below this share of all light are dark.
const DARK: f64 = 1e-9;
/// The most that the transmittance of a pixel may be off, per cent, from `low` to `ultra`, where it is above
/// [`OPAQUE`].
pub const TRANSMITTANCE_PERCENT: [f64; 4] = [0.5, 0.3, 0.2, 0.2];
/// The range of the statement on transmittance in docs/accuracy.md.
const OPAQUE: f64 = 1e-6;
/// Distances are a dozen roundings of f32 away from the truth, and those of angles, 1.2e-7 rad, over the angle to the
/// horizon, of at least [`CLEAR_RAD`].
const DISTANCE_PERCENT: f64 = 3e-3;
/// Nearer to the horizon no distance is compared, rad.
const CLEAR_RAD: f64 = 0.02;

/// An error with what it was found in.
#[derive(Debug, Clone, Default)]
pub struct Worst {
    /// The error, per cent.
    pub percent: f64,
    /// The truth's standard error, per cent of the same.
    pub noise_percent: f64,
    /// Error over what is allowed.
    excess: f64,
    words: String,
}

/// What was found of a case at a quality.
#[derive(Debug, Default)]
pub struct Judgement {
    /// The largest error of radiance; none without a truth.
    pub radiance: Option<Worst>,
    /// The largest error of transmittance; none where the truth has none.
    pub transmittance: Option<Worst>,
    /// How much transmittance rises with distance, at most.
    pub rise: f64,
    /// Laws that do not hold, in words.
    pub broken: Vec<String>,
    /// Bounds that do not hold, in words.
    pub missed: Vec<String>,
}

/// How much transmittance may rise from one distance to the next. Beyond all matter the froxels interpolate τ(t) / t as
/// a hyperbola between slices, which chords lie above by an eighth of its second derivative times the square of a
/// slice's width, relatively 6/8 of the square: T = exp(-τ) makes of that at most 1/e as much.
pub fn most_rise(settings: &Settings) -> f64 {
    0.75 * (-1.0_f64).exp() / f64::from(settings.froxel_size[2]).powi(2)
}

/// Renders a case.
pub fn render(renderer: &mut Renderer, case: &Case, scene: &Scene, quality: Quality) -> Frame {
    let rendered = renderer.render(scene, case.settings_of(quality), CAPTURE);
    rendered.unwrap_or_else(|error| panic!("{} at {quality}: {error}", case.name)).frame
}

/// Holds a case's picture to the laws.
pub fn judge_picture(renderer: &mut Renderer, case: &Case, quality: Quality) -> (Judgement, Frame) {
    let scene = case.scene();
    let frame = render(renderer, case, &scene, quality);
    let mut broken: Vec<_> = laws::broken(&scene, &frame).iter().map(ToString::to_string).collect();
    broken.extend(worst_distance(&scene, &frame).complaint());
    (Judgement { broken, ..Judgement::default() }, frame)
}

/// Holds a case to the laws of pictures and of single rays, and to the truth where there is one.
pub fn judge(renderer: &mut Renderer, case: &Case, quality: Quality, truth: Option<&Truth>) -> (Judgement, Frame) {
    let scene = case.scene();
    let (mut found, frame) = judge_picture(renderer, case, quality);
    // Single rays are those of the air alone.
    let is_clear = scene.volumes.is_empty() && scene.clouds.is_empty();
    if is_clear {
        found.rise = rise(renderer, case, &scene, quality);
    }
    let most = most_rise(&case.settings_of(quality));
    if found.rise.is_nan() || found.rise > most {
        found.broken.push(format!("transmittance rises by {:.2e} of at most {most:.2e} with distance", found.rise));
    }
    if let (Some(truth), Some(bound)) = (truth, case.bound.percent(quality)) {
        let index = Quality::ALL.iter().position(|other| *other == quality).expect("a quality");
        let radiance = worst_radiance(&scene, &frame, truth, bound);
        // The reference's single rays know that of the air alone; tests/fog.rs has that of fog and volumes.
        let transmittance = is_clear.then(|| worst_transmittance(&scene, &frame, truth, TRANSMITTANCE_PERCENT[index]));
        found.missed.extend(radiance.complaint().into_iter().chain(transmittance.iter().filter_map(Worst::complaint)));
        (found.radiance, found.transmittance) = (Some(radiance), transmittance);
    }
    (found, frame)
}

/// How much transmittance rises with distance along the rays of the compared pixels.
fn rise(renderer: &mut Renderer, case: &Case, scene: &Scene, quality: Quality) -> f64 {
    let pixels = pixels(scene);
    let rays: Vec<_> = DISTANCES_M.iter().flat_map(|&distance_m| rays(scene, &pixels, distance_m)).collect();
    let answers = renderer.probe(scene, case.settings_of(quality), &rays, Orders::All);
    let answers = answers.unwrap_or_else(|error| panic!("{} at {quality}: {error}", case.name));
    let along =
        |i: usize| -> Vec<_> { answers.iter().skip(i).step_by(pixels.len()).map(|a| a.transmittance).collect() };
    (0..pixels.len()).map(|i| laws::rise(&along(i))).fold(0.0, f64::max)
}

impl Worst {
    fn new(percent: f64, noise_percent: f64, bound: f64) -> Self {
        Self { percent, noise_percent, excess: percent / (bound + SIGMAS * noise_percent), words: String::new() }
    }

    /// Keeps the other one if it is worse, or no number, and says what it is.
    fn take(&mut self, other: Self, words: impl FnOnce(&Self) -> String) {
        if other.excess.is_nan() || other.excess > self.excess {
            *self = Self { words: words(&other), ..other };
        }
    }

    fn complaint(&self) -> Option<String> {
        (self.excess.is_nan() || self.excess > 1.0).then(|| self.words.clone())
    }
}

fn place(scene: &Scene, pixel: [u32; 2]) -> String {
    let [elevation, azimuth] = laws::view_deg(scene, pixel);
    format!("at column {}, row {}, looking {elevation:.4}° up towards {azimuth:.2}°", pixel[0], pixel[1])
}

fn at<T: Copy>(frame: &Frame, texels: &[T], [x, y]: [u32; 2]) -> T {
    texels[(y * frame.width + x) as usize]
}

fn worst_radiance(scene: &Scene, frame: &Frame, truth: &Truth, bound: f64) -> Worst {
    let brightest = truth.answers.iter().flat_map(|answer| answer.radiance).fold(0.0, f64::max);
    let floor = (DIM * brightest).max(DARK * largest_irradiance(scene)).max(f64::MIN_POSITIVE);
    let mut worst = Worst::default();
    for (&pixel, answer) in truth.pixels.iter().zip(&truth.answers) {
        for (band, ours) in at(frame, &frame.radiance, pixel).map(f64::from).into_iter().enumerate() {
            let (theirs, sigma) = (answer.radiance[band], answer.standard_error[band]);
            let percent = |difference: f64| 100.0 * difference / theirs.max(floor);
            worst.take(Worst::new(percent((ours - theirs).abs()), percent(sigma), bound), |worst| {
                format!(
                    "radiance is {ours:.4e} in band {band}, the reference's {theirs:.4e} ± {sigma:.0e}: {:.2} % of at most \
                     {bound} % {}",
                    worst.percent,
                    place(scene, pixel)
                )
            });
        }
    }
    worst
}

fn largest_irradiance(scene: &Scene) -> f64 {
    let irradiances = scene.lights.iter().map(|light| match light {
        Light::Directional(light) => light.irradiance,
        _ => [0.0; 3],
    });
    irradiances.flatten().fold(0.0, f64::max)
}

fn worst_transmittance(scene: &Scene, frame: &Frame, truth: &Truth, bound: f64) -> Worst {
    let mut worst = Worst::default();
    for (&pixel, answer) in truth.pixels.iter().zip(&truth.answers) {
        for (band, ours) in at(frame, &frame.transmittance, pixel).map(f64::from).into_iter().enumerate() {
            let theirs = answer.transmittance[band];
            // Below the range of the statement it only has to be as dark.
            let off = if theirs > OPAQUE { (ours / theirs - 1.0).abs() } else { (ours / OPAQUE - 1.0).max(0.0) };
            worst.take(Worst::new(100.0 * off, 0.0, bound), |worst| {
                format!(
                    "transmittance is {ours:.4e} in band {band}, the reference's {theirs:.4e}: {:.3} % of at most {bound} % {}",
                    worst.percent,
                    place(scene, pixel)
                )
            });
        }
    }
    worst
}

/// Distances to smooth ground against the sphere's equation in f64.
fn worst_distance(scene: &Scene, frame: &Frame) -> Worst {
    let mut worst = Worst::default();
    let (radius_m, altitude_m) = (scene.planet.radius_m, scene.camera.altitude_m.max(0.0));
    if scene.terrain.is_some() || altitude_m == 0.0 {
        return worst;
    }
    let horizon_rad = (altitude_m * (2.0 * radius_m + altitude_m)).sqrt().atan2(radius_m);
    for pixel in pixels(scene) {
        let view = scene.camera.direction_through(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
        let below_rad = -view.z.atan2(view.truncate().length()) - horizon_rad;
        if below_rad < CLEAR_RAD {
            continue;
        }
        let b = (radius_m + altitude_m) * view.z;
        let gap = altitude_m * (2.0 * radius_m + altitude_m);
        let (ours, theirs) = (f64::from(at(frame, &frame.distance_m, pixel)), gap / ((b * b - gap).sqrt() - b));
        worst.take(Worst::new(100.0 * (ours / theirs - 1.0).abs(), 0.0, DISTANCE_PERCENT), |worst| {
            format!(
                "the ground is {ours:e} m away, not {theirs:e} m: {:.4} % of at most {DISTANCE_PERCENT} % {}",
                worst.percent,
                place(scene, pixel)
            )
        });
    }
    worst
}
