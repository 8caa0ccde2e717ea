//! The worlds that no table of another code covers, and the rays that look at them.

use std::f64::consts::PI;
use std::path::Path;

use welkin::probe::Ray;
use welkin::scene::Scene;

/// A world with the rays through it.
pub struct Question {
    /// What it is called in the table.
    pub name: &'static str,
    pub scene: Scene,
    pub rays: Vec<Ray>,
}

/// From space, rays pass the air at these shares of its height above the ground.
const LIMB_SHARES: [f64; 3] = [0.05, 0.2, 0.5];
/// From within the air, rays look at these shares of the way from the zenith to the horizon.
const SKY_SHARES: [f64; 5] = [0.0, 0.5, 0.8, 0.95, 0.99];
/// Rays to the ground, at these shares of the way from the horizon to the nadir.
const GROUND_SHARES: [f64; 3] = [0.03, 0.3, 0.8];
const AZIMUTHS_DEG: [f64; 5] = [0.0, 180.0, 60.0, 120.0, 15.0];

const DAY_DEG: [f64; 4] = [20.0, 60.0, 85.0, 93.0];

/// All worlds.
pub fn questions() -> Vec<Question> {
    let earth = || scene("reference/earth-b-0.3.toml");
    let hazier = |file: &str, times: f64| {
        let mut scene = scene(file);
        let haze = &mut scene.medium.constituents[1];
        haze.scattering_per_m.iter_mut().chain(&mut haze.absorption_per_m).for_each(|b| *b *= times);
        scene
    };
    let of_radius = |radius_m: f64| {
        let mut scene = earth();
        scene.planet.radius_m = radius_m;
        scene
    };
    let question = |name, scene: Scene, altitudes_m: &[f64], suns_deg: &[f64]| {
        let rays = rays(&scene, altitudes_m, suns_deg);
        Question { name, scene, rays }
    };
    let twilight = [93.0, 96.0, 99.0, 102.0, 105.0, 108.0];
    let moon = [10.0, 60.0, 100.0, 150.0];
    vec![
        question("twilight to -18°", earth(), &[2.0, 10_000.0], &twilight),
        question("the Moon's distance", earth(), &[3.844e8], &moon),
        question("planet of 100 km", of_radius(1e5), &[2.0, 20_000.0, 300_000.0], &DAY_DEG),
        question("planet of 70 000 km", of_radius(7e7), &[2.0, 20_000.0, 300_000.0], &DAY_DEG),
        question("tables' Earth, 10x haze", hazier("reference/earth-b-0.3.toml", 10.0), &[2.0, 10_000.0], &DAY_DEG),
        question("preset earth, 10x haze", hazier("noon.toml", 10.0), &[2.0, 10_000.0], &DAY_DEG),
        question("Mars, dust of 0.5", scene("mars.toml"), &[2.0, 20_000.0], &DAY_DEG),
    ]
}

fn scene(file: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(file);
    Scene::read(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// Half of all pairs of sun and view from each altitude, spread evenly, each at an azimuth of its own.
fn rays(scene: &Scene, altitudes_m: &[f64], suns_deg: &[f64]) -> Vec<Ray> {
    let mut rays = Vec::new();
    for (o, &altitude_m) in altitudes_m.iter().enumerate() {
        let views = view_zeniths_rad(scene, altitude_m);
        for (s, sun_deg) in suns_deg.iter().enumerate() {
            for (v, &view_zenith_rad) in views.iter().enumerate().filter(|(v, _)| (o + s + v) % 2 == 0) {
                rays.push(Ray {
                    altitude_m,
                    view_zenith_rad,
                    view_azimuth_rad: AZIMUTHS_DEG[(v + 2 * s + 3 * o) % AZIMUTHS_DEG.len()].to_radians(),
                    sun_zenith_rad: sun_deg.to_radians(),
                    sun_azimuth_rad: 0.0,
                    distance_m: f64::INFINITY,
                });
            }
        }
    }
    rays
}

fn view_zeniths_rad(scene: &Scene, altitude_m: f64) -> Vec<f64> {
    let (radius_m, top_m) = (scene.planet.radius_m, scene.planet.atmosphere_height_m);
    let tangent_rad = |height_m: f64| PI - ((radius_m + height_m) / (radius_m + altitude_m)).min(1.0).asin();
    let horizon_rad = tangent_rad(0.0);
    let sky: Vec<f64> = match altitude_m > top_m {
        true => LIMB_SHARES.iter().map(|share| tangent_rad(share * top_m)).collect(),
        false => SKY_SHARES.iter().map(|share| share * horizon_rad).collect(),
    };
    sky.into_iter().chain(GROUND_SHARES.map(|share| horizon_rad + share * (PI - horizon_rad))).collect()
}
