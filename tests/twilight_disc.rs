//! A sun as wide as it is: where light is averaged over its disc, and what that gives.

mod common;

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Outputs, Quality, Settings};
use welkin::probe::{Orders, Ray};
use welkin::reference::{self, Effort};
use welkin::renderer::Renderer;
use welkin::scene::{Light, Scene};

fn earth(sun_elevation_deg: f64, altitude_m: f64) -> Scene {
    let text = format!(
        "preset = \"earth\"\n[sun]\nelevation_deg = {sun_elevation_deg}\nazimuth_deg = 0\nirradiance = 1\n\
         [camera]\naltitude_m = {altitude_m}\nelevation_deg = 0\nazimuth_deg = 0\n"
    );
    Scene::parse(&text, Path::new("twilight.toml")).unwrap()
}

fn ray(altitude_m: f64, view_zenith_deg: f64, view_azimuth_deg: f64, sun_elevation_deg: f64) -> Ray {
    Ray {
        altitude_m,
        view_zenith_rad: view_zenith_deg.to_radians(),
        view_azimuth_rad: view_azimuth_deg.to_radians(),
        sun_zenith_rad: FRAC_PI_2 - sun_elevation_deg.to_radians(),
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
    }
}

fn probe(scene: &Scene, rays: &[Ray], orders: Orders) -> Vec<f64> {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let answers = renderer.probe(scene, Settings::of(Quality::High), rays, orders).unwrap();
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    answers.iter().map(|answer| answer.radiance[1]).collect()
}

/// Irradiance of horizontal ground in vacuum under a disc of unit irradiance whose radiance falls as cosine^k.
fn disc_irradiance(elevation_rad: f64, radius_rad: f64, k: f64) -> f64 {
    let chord = |y: f64| (1.0 - y * y).powf(0.5 * (k + 1.0));
    let heights = (0..20_000).map(|i| (f64::from(i) + 0.5) / 10_000.0 - 1.0);
    let (sum, norm) = heights.fold((0.0, 0.0), |(sum, norm), y| {
        (sum + chord(y) * (elevation_rad + radius_rad * y).sin().max(0.0), norm + chord(y))
    });
    sum / norm
}

#[test]
fn the_sun_fades_from_the_ground_over_the_height_of_its_disc() {
    let mut scene = earth(0.0, 2.0);
    scene.medium.constituents.clear();
    scene.planet.ground_albedo = [1.0; 3];
    let Light::Directional(sun) = &scene.lights[0] else { panic!("the sun is directional") };
    let (radius_rad, k) = (sun.angular_radius_rad, sun.limb_exponent()[1]);
    let elevations = [0.4, 0.2, 0.1, 0.0, -0.1, -0.2];
    let found = probe(&scene, &elevations.map(|elevation| ray(2.0, 180.0, 0.0, elevation)), Orders::All);
    for (elevation, found) in elevations.iter().zip(&found) {
        let exact = disc_irradiance(elevation.to_radians(), radius_rad, k);
        let error = found * PI / exact - 1.0;
        assert!(error.abs() < 5e-3, "at {elevation}°: {error}");
        if elevation.abs() < 0.3 {
            let point = elevation.to_radians().sin().max(0.0);
            assert!((point / exact - 1.0).abs() > 5e-3, "at {elevation}° a point would do");
        }
    }
    assert_eq!(probe(&scene, &[ray(2.0, 180.0, 0.0, -0.3)], Orders::All), [0.0]);
}

#[test]
fn beside_the_shadow_of_the_earth_the_sky_is_that_of_a_wide_sun() {
    // From 10 km, away from a sun 2° down, where the shadow's edge lies along the ray.
    let scene = earth(-2.0, 10_000.0);
    let rays = [ray(10_000.0, 89.0, 180.0, -2.0)];
    let truth = reference::probe(&scene, &rays, Orders::Single, Effort::Walks(100_000), 1)[0];
    let off = |scene: &Scene| (probe(scene, &rays, Orders::Single)[0] / truth.radiance[1] - 1.0).abs();
    let bound = 0.015 + 3.0 * truth.standard_error[1] / truth.radiance[1];
    println!("{} of {bound}", off(&scene));
    assert!(off(&scene) < bound, "{} of {bound}", off(&scene));
    // Negative control: a sun of no width.
    let mut point = scene.clone();
    let Light::Directional(sun) = &mut point.lights[0] else { panic!("the sun is directional") };
    sun.angular_radius_rad = 0.0;
    assert!(off(&point) > bound, "{} of {bound}", off(&point));
}

#[test]
fn light_is_averaged_over_the_disc_only_where_it_changes_the_picture() {
    let says = |elevation_deg, altitude_m| {
        let scene = earth(elevation_deg, altitude_m);
        let plan = Renderer::plan(&scene, Settings::of(Quality::Low), Outputs::default()).unwrap();
        let sky_view = plan.passes.iter().find(|pass| pass.name == "sky_view").unwrap();
        sky_view.reason.contains("averaged over the disc of sun")
    };
    assert!(says(0.5, 2.0) && says(-10.0, 2.0));
    assert!(!says(1.5, 2.0) && !says(60.0, 2.0));
    // From orbit the sun sets on ground that is in view while it stands 15° above the horizontal of the observer.
    assert!(says(15.0, 400_000.0) && !says(30.0, 400_000.0));
}
