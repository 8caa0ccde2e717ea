//! Constituents whose density is a layer: it begins and ends with a jump.

mod common;

use std::path::Path;

use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Quality, Settings};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::{self, Effort};
use welkin::renderer::Renderer;
use welkin::scene::Scene;
use welkin_lut::{Constituent, DensityProfile, PhaseFunction};

const BOTTOM_M: f64 = 1500.0;
const TOP_M: f64 = 3000.0;

/// Clear air with smoke of optical depth 0.33 between two altitudes.
fn smoky() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/reference/earth-b-0.3.toml");
    let mut scene = Scene::read(&path).unwrap();
    scene.medium.constituents.push(Constituent {
        name: "smoke".into(),
        scattering_per_m: [2e-4; 3],
        absorption_per_m: [2e-5; 3],
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Layer { bottom_m: BOTTOM_M, top_m: TOP_M },
        phase: PhaseFunction::HenyeyGreenstein { g: 0.7 },
    });
    scene
}

/// From below, inside and above the layer, under suns from the zenith to 88°.
fn rays(distance_m: f64) -> Vec<Ray> {
    let mut rays = Vec::new();
    for altitude_m in [2.0, 2000.0, 10_000.0] {
        for view_zenith_deg in [10.0_f64, 60.0, 85.0, 89.5, 92.0, 100.0, 150.0] {
            for sun_zenith_deg in [10.0_f64, 60.0, 80.0, 88.0] {
                rays.push(Ray {
                    altitude_m,
                    view_zenith_rad: view_zenith_deg.to_radians(),
                    view_azimuth_rad: 0.7,
                    sun_zenith_rad: sun_zenith_deg.to_radians(),
                    sun_azimuth_rad: 0.0,
                    distance_m,
                });
            }
        }
    }
    rays
}

/// Median and 99th percentile of the error, %.
fn errors(found: &[RayRadiance], truth: &[RayRadiance]) -> [f64; 2] {
    let pairs = found.iter().zip(truth).flat_map(|(a, b)| a.radiance.into_iter().zip(b.radiance));
    let lit = pairs.filter(|(_, truth)| *truth > 0.0);
    let mut errors: Vec<f64> = lit.map(|(found, truth)| 100.0 * (found / truth - 1.0).abs()).collect();
    errors.sort_by(f64::total_cmp);
    [0.5, 0.99].map(|q| errors[((errors.len() - 1) as f64 * q).round() as usize])
}

#[test]
fn light_is_scattered_in_a_layer_from_its_bottom_to_its_top() {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let settings = Settings::of(Quality::High);
    let scene = smoky();
    // Whole rays, and rays that end at a surface in the air.
    for (distance_m, bounds) in [(f64::INFINITY, [0.1, 3.0]), (20_000.0, [0.5, 8.0])] {
        let truth = reference::probe(&scene, &rays(distance_m), Orders::Single, Effort::Walks(1), 0);
        let found = renderer.probe(&scene, settings, &rays(distance_m), Orders::Single).unwrap();
        let [median, p99] = errors(&found, &truth);
        println!("up to {distance_m} m: median {median:.3} % p99 {p99:.2} %");
        assert!(median < bounds[0] && p99 < bounds[1], "up to {distance_m} m: {median} {p99}");
        // Negative control: a layer whose top lies 50 m higher is noticed.
        let mut higher = scene.clone();
        higher.medium.constituents[3].profile = DensityProfile::Layer { bottom_m: BOTTOM_M, top_m: TOP_M + 50.0 };
        let found = renderer.probe(&higher, settings, &rays(distance_m), Orders::Single).unwrap();
        assert!(errors(&found, &truth)[0] > bounds[0]);
    }
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
}
