//! Rays that end in the air, and how far two answers to them are apart.
#![allow(dead_code)]

use std::f64::consts::PI;
use std::ops::RangeInclusive;
use std::path::Path;

use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::{self, Effort};
use welkin::scene::{Light, Preset, Scene};
use welkin_lut::geometry::{distance_to_shell_from_above, horizon_mu};

/// Zenith angles of the sun.
pub const SUNS_DEG: [f64; 6] = [0.0, 45.0, 70.0, 85.0, 90.0, 92.0];
const ALTITUDES_M: [f64; 3] = [2.0, 1500.0, 10_000.0];
const ZENITHS_DEG: [f64; 7] = [30.0, 75.0, 86.0, 89.5, 90.3, 92.0, 100.0];
const AZIMUTHS_DEG: [f64; 3] = [5.0, 60.0, 170.0];
const DISTANCES_M: [f64; 5] = [100.0, 1e3, 1e4, 5e4, 2e5];

/// A scene of a preset, with the sun wherever the rays have it.
pub fn scene(preset: &str) -> Scene {
    let file = if preset == "earth" { "scenes/noon.toml" } else { "scenes/golden-hour.toml" };
    let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap_or_else(|e| panic!("{e}"));
    let preset = if preset == "earth" { Preset::Earth } else { Preset::Hillaire2020 };
    scene.planet = preset.planet();
    scene.medium = preset.medium();
    // A parallel beam, of which the reference has single scattering without noise.
    for light in &mut scene.lights {
        if let Light::Directional(sun) = light {
            sun.angular_radius_rad = 0.0;
        }
    }
    scene
}

/// All rays that end before the ground.
pub fn rays(scene: &Scene) -> Vec<Ray> {
    let mut rays = Vec::new();
    for altitude_m in ALTITUDES_M {
        for zenith_deg in ZENITHS_DEG {
            let mu = zenith_deg.to_radians().cos();
            let radius_m = scene.planet.radius_m;
            let ground_m = match mu < horizon_mu(radius_m, altitude_m) {
                true => distance_to_shell_from_above(radius_m, altitude_m, mu, 0.0).unwrap_or(f64::INFINITY),
                false => f64::INFINITY,
            };
            for distance_m in DISTANCES_M.into_iter().filter(|&distance_m| distance_m < ground_m) {
                for sun_deg in SUNS_DEG {
                    rays.extend(AZIMUTHS_DEG.map(|azimuth_deg| Ray {
                        altitude_m,
                        view_zenith_rad: zenith_deg.to_radians(),
                        view_azimuth_rad: azimuth_deg.to_radians(),
                        sun_zenith_rad: sun_deg.to_radians(),
                        sun_azimuth_rad: 0.0,
                        distance_m,
                    }));
                }
            }
        }
    }
    rays
}

/// Radiance of white horizontal ground under each of the suns.
pub fn white_surface(scene: &Scene) -> Vec<[f64; 3]> {
    let down = SUNS_DEG.map(|sun_deg| Ray {
        altitude_m: 1.0,
        view_zenith_rad: PI,
        view_azimuth_rad: 0.0,
        sun_zenith_rad: sun_deg.to_radians(),
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
    });
    let albedo = scene.planet.ground_albedo;
    let answers = reference::probe(scene, &down, Orders::All, Effort::Walks(8192), 1);
    answers.iter().map(|answer| std::array::from_fn(|j| answer.radiance[j] / albedo[j])).collect()
}

/// Of one band of one ray.
struct Error {
    ray: usize,
    sun_deg: f64,
    /// Of in-scattered light, over itself, %.
    of_itself: f64,
    /// Of in-scattered light, over itself and the light of a white surface at the ray's end, %.
    of_picture: f64,
    /// Of transmittance.
    transmittance: f64,
}

/// All bands of all rays.
pub struct Errors(Vec<Error>);

impl Errors {
    pub fn new(rays: &[Ray], found: &[RayRadiance], truth: &[RayRadiance], white: &[[f64; 3]]) -> Self {
        let mut errors = Vec::new();
        for (i, ray) in rays.iter().enumerate() {
            let sun_deg = ray.sun_zenith_rad.to_degrees();
            let sun = SUNS_DEG.iter().position(|sun| (sun - sun_deg).abs() < 1e-6).unwrap_or(0);
            errors.extend((0..3).filter_map(|j| {
                let difference = (found[i].radiance[j] - truth[i].radiance[j]).abs();
                let surface = truth[i].transmittance[j] * white[sun][j];
                // In the planet's shadow single scattering is nothing, of which no share can be said.
                (truth[i].radiance[j] >= 1e-6 * surface).then(|| Error {
                    ray: i,
                    sun_deg,
                    of_itself: 100.0 * difference / truth[i].radiance[j].max(f64::MIN_POSITIVE),
                    of_picture: 100.0 * difference / (truth[i].radiance[j] + surface),
                    transmittance: (found[i].transmittance[j] - truth[i].transmittance[j]).abs(),
                })
            }));
        }
        Self(errors)
    }

    fn quantile(&self, suns: &RangeInclusive<f64>, q: f64, of: fn(&Error) -> f64) -> f64 {
        let chosen = self.0.iter().filter(|error| suns.contains(&error.sun_deg.round()));
        let mut values: Vec<f64> = chosen.map(of).collect();
        values.sort_by(f64::total_cmp);
        values[((values.len() - 1) as f64 * q).round() as usize]
    }

    /// Median and 99th percentile of both, %, and the 99th percentile and maximum of transmittance's.
    pub fn summary(&self, suns: &RangeInclusive<f64>) -> [f64; 6] {
        [
            self.quantile(suns, 0.5, |e| e.of_itself),
            self.quantile(suns, 0.99, |e| e.of_itself),
            self.quantile(suns, 0.5, |e| e.of_picture),
            self.quantile(suns, 0.99, |e| e.of_picture),
            self.quantile(suns, 0.99, |e| e.transmittance),
            self.quantile(suns, 1.0, |e| e.transmittance),
        ]
    }

    pub fn row(&self, suns: &RangeInclusive<f64>) -> String {
        let [a, b, c, d, e, f] = self.summary(suns);
        format!("{a:.3} / {b:.2} | {c:.3} / {d:.2} | {e:.5} / {f:.5}")
    }

    pub fn print_worst(&self, rays: &[Ray], found: &[RayRadiance], truth: &[RayRadiance]) {
        let mut order: Vec<&Error> = self.0.iter().filter(|error| error.sun_deg < 91.0).collect();
        order.sort_by(|a, b| b.of_itself.total_cmp(&a.of_itself));
        order.dedup_by_key(|error| error.ray);
        for error in order.iter().take(16) {
            let ray = &rays[error.ray];
            println!(
                "{:.2e} %: h {} z {:.1} az {:.0} sun {:.0} d {} | {} against {} +- {} | T {:.4?} against {:.4?}",
                error.of_itself,
                ray.altitude_m,
                ray.view_zenith_rad.to_degrees(),
                ray.view_azimuth_rad.to_degrees(),
                error.sun_deg,
                ray.distance_m,
                scientific(found[error.ray].radiance),
                scientific(truth[error.ray].radiance),
                scientific(truth[error.ray].standard_error),
                found[error.ray].transmittance,
                truth[error.ray].transmittance,
            );
        }
    }
}

fn scientific(bands: [f64; 3]) -> String {
    bands.map(|value| format!("{value:.3e}")).join(" ")
}
