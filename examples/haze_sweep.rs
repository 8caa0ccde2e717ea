//! When spherical harmonics stop being enough: the sky of ever hazier air by both treatments, beside what the plan expects
//! of it; prints Markdown.
//!
//! `cargo run --release --example haze_sweep`

use welkin::gpu::DeviceRequest;
use welkin::plan::{Facts, MultipleScattering, Outputs, Quality, Settings, expected_ringing};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// Haze: a factor on the density of `hillaire2020`'s, and its asymmetry.
const HAZES: [(f64, f64); 10] = [
    (1.0, 0.8),
    (2.0, 0.8),
    (5.0, 0.8),
    (10.0, 0.8),
    (20.0, 0.8),
    (50.0, 0.8),
    (10.0, 0.5),
    (10.0, 0.65),
    (10.0, 0.9),
    (50.0, 0.5),
];

fn scene(factor: f64, g: f64) -> Scene {
    let text = format!(
        "preset = \"hillaire2020\"\n[medium.mie]\ndensity_factor = {factor}\nphase.henyey_greenstein.g = {g}\n\
         [sun]\nelevation_deg = 30\nazimuth_deg = 0\n[camera]\naltitude_m = 2\nelevation_deg = 0\nazimuth_deg = 0\n"
    );
    Scene::parse(&text, "haze_sweep.toml".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// All of the sky from 2 m above the ground, towards the sun, across and away from it.
fn rays() -> Vec<Ray> {
    let mut rays = Vec::new();
    for sun_deg in [30.0_f64, 60.0, 80.0] {
        for zenith_deg in [0.0_f64, 20.0, 40.0, 55.0, 65.0, 75.0, 82.0, 87.0, 89.5] {
            for azimuth_deg in [0.0_f64, 25.0, 60.0, 110.0, 180.0] {
                rays.push(Ray {
                    altitude_m: 2.0,
                    view_zenith_rad: zenith_deg.to_radians(),
                    view_azimuth_rad: azimuth_deg.to_radians(),
                    sun_zenith_rad: sun_deg.to_radians(),
                    sun_azimuth_rad: 0.0,
                    distance_m: f64::INFINITY,
                });
            }
        }
    }
    rays
}

/// Median and 99th percentile of relative differences over rays and bands, %.
fn differences(ours: &[RayRadiance], theirs: &[RayRadiance]) -> [f64; 2] {
    let bands = ours.iter().zip(theirs).flat_map(|(a, b)| (0..3).map(|band| a.radiance[band] / b.radiance[band]));
    let mut errors: Vec<f64> = bands.map(|ratio| 100.0 * (ratio - 1.0).abs()).collect();
    errors.sort_by(f64::total_cmp);
    [0.5, 0.99].map(|q| errors[((errors.len() - 1) as f64 * q).round() as usize])
}

fn main() {
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let rays = rays();
    // The field with three and with five degrees, on what else is best of `high` and `ultra`.
    let qualities = [Quality::High, Quality::Ultra].map(Settings::of);
    println!("| haze | g | expected to degree 2 | found: median / p99 | expected to degree 4 | found: median / p99 |");
    println!("|---|---|---|---|---|---|");
    for (factor, g) in HAZES {
        let scene = scene(factor, g);
        let mut probe = |settings: Settings, multiple_scattering| {
            let settings = Settings { multiple_scattering, ..settings };
            renderer.probe(&scene, settings, &rays, Orders::All).unwrap_or_else(|error| panic!("{error}"))
        };
        let source_function = probe(qualities[0], MultipleScattering::SourceFunction);
        let cells = qualities.map(|settings| {
            let facts = Facts::new(&scene, settings, Orders::All, Outputs::default()).unwrap_or_else(|e| panic!("{e}"));
            let top_m = scene.planet.atmosphere_height_m;
            let expected = 100.0 * expected_ringing(facts.scatterers(), top_m, settings.degree_count);
            let [median, p99] = differences(&probe(settings, MultipleScattering::Harmonics), &source_function);
            format!("{expected:.2} | {median:.2} / {p99:.2}")
        });
        println!("| {factor} | {g} | {} | {} |", cells[0], cells[1]);
    }
}
