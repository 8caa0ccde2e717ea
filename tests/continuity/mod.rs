//! Paths of the camera and the sun, and how evenly pictures change along them.
#![allow(dead_code)]

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use welkin::plan::{Outputs, Settings};
use welkin::renderer::Renderer;
use welkin::scene::{Light, Scene};

/// Steps on each side of a step that say how much change is usual there.
const NEIGHBOURS: usize = 3;
/// Of a value and its logarithm in a table, each an f32: ln of a radiance is -16 to -60 where there is light, and its
/// rounding of 2^-24 times that is a relative error of the radiance; four such roundings meet in a difference.
pub const NOISE: f64 = 4.0 * 60.0 * 5.96e-8;
/// A share that no screen shows: a step of 8 bits is 0.4 % at white and more below.
pub const VISIBLE: f64 = 1e-3;
/// The stated bound on a visible step over its neighbours' change.
pub const BOUND: f64 = 6.0;
/// Of the picture's brightest sky: 20 stops below it there is nothing that the same exposure shows.
pub const DARKEST: f64 = 1e-6;

/// Linear radiance of a picture's pixels, band by band.
pub type Picture = Vec<f64>;

/// The step of a path that stands out most from its neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// From this position on the path to the next.
    pub step: usize,
    /// Which value of the pictures.
    pub value: usize,
    /// How many times its neighbours' change it changes.
    pub times: f64,
    /// Its change, relative.
    pub change: f64,
}

/// The scene, small and wide: from 20 degrees off the zenith to 20 off the nadir, the sun a little to the right.
pub fn scene(sun_elevation_deg: f64, altitude_m: f64) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/reference/earth-b-0.3.toml");
    let mut scene = Scene::read(&file).unwrap_or_else(|error| panic!("{error}"));
    let camera = &mut scene.camera;
    camera.altitude_m = altitude_m;
    camera.direction.elevation_rad = 0.0;
    camera.direction.azimuth_rad = 145_f64.to_radians();
    camera.vertical_field_of_view_rad = 140_f64.to_radians();
    (camera.width, camera.height) = (24, 48);
    set_sun(&mut scene, sun_elevation_deg);
    scene
}

pub fn set_sun(scene: &mut Scene, elevation_deg: f64) {
    for light in &mut scene.lights {
        if let Light::Directional(sun) = light {
            sun.direction.elevation_rad = elevation_deg.to_radians();
        }
    }
}

/// Altitudes from one to another in so many steps, closest together at the ground and at the top of the air, where
/// they are some 10 m / (steps / 36) apart.
pub fn altitudes_m(from_m: f64, to_m: f64, top_m: f64, steps: usize) -> Vec<f64> {
    let measure = |h: f64| (h / 10.0).asinh() + ((h - top_m) / 10.0).asinh();
    let inverse = |target: f64| {
        let (mut low, mut high) = (from_m, to_m);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if measure(middle) < target { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let (start, end) = (measure(from_m), measure(to_m));
    (0..=steps).map(|i| inverse(start + (end - start) * i as f64 / steps as f64)).collect()
}

/// Evenly spaced values, both ends included.
pub fn evenly(from: f64, to: f64, steps: usize) -> Vec<f64> {
    (0..=steps).map(|i| from + (to - from) * i as f64 / steps as f64).collect()
}

/// Pictures of a scene after each of its changes.
pub fn pictures(
    renderer: &mut Renderer,
    settings: Settings,
    scene: &Scene,
    positions: &[f64],
    change: impl Fn(&mut Scene, f64),
) -> Vec<Picture> {
    let mut picture = |&position: &f64| {
        let mut scene = scene.clone();
        change(&mut scene, position);
        let rendered = renderer.render(&scene, settings, Outputs::default()).unwrap_or_else(|error| panic!("{error}"));
        rendered.frame.radiance.iter().flatten().map(|&value| f64::from(value)).collect()
    };
    positions.iter().map(&mut picture).collect()
}

/// How a path changes: for each step the value that stands out most from the steps around it.
///
/// A step's change is compared with the usual change on the side where it is larger: the median of the three steps
/// before, or after. A kink, where one side changes and the other does not, is then no more than 1; a pop, however
/// short, stands alone on both sides.
pub fn worst_of_each_step(pictures: &[Picture]) -> Vec<Worst> {
    let values = pictures[0].len();
    let brightest = pictures.iter().map(|picture| picture.iter().copied().fold(0.0, f64::max)).collect::<Vec<_>>();
    let steps = NEIGHBOURS..pictures.len() - 1 - NEIGHBOURS;
    let stands_out = |step: usize, value: usize| {
        let at = |i: usize| pictures[i][value];
        let change = |i: usize| (at(i + 1) - at(i)).abs();
        let usual = |start: usize| {
            let mut around: [f64; NEIGHBOURS] = std::array::from_fn(|k| change(start + k));
            around.sort_by(f64::total_cmp);
            around[NEIGHBOURS / 2]
        };
        let size = at(step).max(at(step + 1)).max(f64::MIN_POSITIVE);
        let noise = NOISE * size + DARKEST * brightest[step];
        let times = (change(step) - noise).max(0.0) / usual(step - NEIGHBOURS).max(usual(step + 1)).max(noise);
        Worst { step, value, times, change: change(step) / size }
    };
    let worst = |step: usize| {
        let all = (0..values).map(|value| stands_out(step, value));
        all.max_by(|a, b| a.times.total_cmp(&b.times)).expect("a picture has values")
    };
    steps.map(worst).collect()
}

impl Worst {
    /// Whether the step is a pop that can be seen.
    pub fn pops(&self) -> bool {
        self.times > BOUND && self.change > VISIBLE
    }
}

/// The path with every picture from a position on brighter by a share: what a pop is.
pub fn with_pop(pictures: &[Picture], position: usize, share: f64) -> Vec<Picture> {
    let brighter = |(i, picture): (usize, &Picture)| match i < position {
        true => picture.clone(),
        false => picture.iter().map(|value| value * (1.0 + share)).collect(),
    };
    pictures.iter().enumerate().map(brighter).collect()
}

/// Elevation of a pixel's centre in degrees, and its band, for messages.
pub fn place(scene: &Scene, value: usize) -> (f64, usize) {
    let (pixel, band) = (value / 3, value % 3);
    let width = scene.camera.width as usize;
    let view = scene.camera.direction_through((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
    ((FRAC_PI_2 - view.z.acos()).to_degrees(), band)
}
