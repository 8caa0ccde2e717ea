//! The moon: where it stands, how bright it is, which side is lit, and when it is worth computing.

mod common;

use std::path::Path;

use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Outputs, Quality, Settings};
use welkin::probe::{Orders, Ray};
use welkin::reference::{self, Effort};
use welkin::renderer::Renderer;
use welkin::scene::{DirectionalLight, Light, Scene};

const CAMERA: &str = "[camera]\naltitude_m = 2\nelevation_deg = 20\nazimuth_deg = 90\n\
                      vertical_field_of_view_deg = 0.7\nwidth = 48\nheight = 48\n";

fn scene(lights: &str) -> Scene {
    let text = format!("preset = \"earth\"\n{lights}\n{CAMERA}");
    Scene::parse(&text, Path::new("moon.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn sun_and_moon(scene: &Scene) -> [DirectionalLight; 2] {
    match &scene.lights[..] {
        [Light::Directional(sun), Light::Directional(moon)] => [sun.clone(), moon.clone()],
        other => panic!("{other:?}"),
    }
}

fn at(date_time: &str, latitude: f64, longitude: f64) -> [DirectionalLight; 2] {
    let when = format!("date_time = {date_time}\nlatitude_deg = {latitude}\nlongitude_deg = {longitude}");
    sun_and_moon(&scene(&format!("[sun.when]\n{when}\n[moon]")))
}

fn phase_deg(moon: &DirectionalLight) -> f64 {
    moon.sphere.unwrap().phase_rad(moon.direction.to_vector()).to_degrees()
}

fn separation_deg(lights: &[DirectionalLight; 2]) -> f64 {
    let [sun, moon] = lights.each_ref().map(|light| light.direction.to_vector());
    sun.angle_between(moon).to_degrees()
}

#[test]
fn the_moon_covers_the_sun_where_and_when_an_eclipse_was_greatest() {
    // NASA's catalogue of eclipses (Espenak and Meeus): greatest eclipse and its place.
    let eclipses = [
        ("2017-08-21T18:25:32Z", 36.967, -87.672),
        ("2024-04-08T18:17:20Z", 25.285, -104.145),
        ("2006-03-29T10:11:23Z", 23.150, 16.759),
    ];
    for (date_time, latitude, longitude) in eclipses {
        let lights = at(date_time, latitude, longitude);
        assert!(separation_deg(&lights) < 0.03, "{date_time}: {}", separation_deg(&lights));
        assert!(lights[1].angular_radius_rad > lights[0].angular_radius_rad, "{date_time}: not total");
        assert!(phase_deg(&lights[1]) > 179.0);
    }
    // Negative control: an hour later the moon has gone on by half a degree.
    assert!(separation_deg(&at("2017-08-21T19:25:32Z", 36.967, -87.672)) > 0.2);
}

#[test]
fn the_phases_come_on_their_dates() {
    // U.S. Naval Observatory: phases of the moon 2026, UTC.
    for (date_time, degrees) in [
        ("2026-01-03T10:03:00Z", 0.0),
        ("2026-01-10T15:48:00Z", 90.0),
        ("2026-01-18T19:52:00Z", 180.0),
        ("2026-01-26T04:47:00Z", 90.0),
        ("2025-03-14T06:55:00Z", 0.0),
    ] {
        let [_, moon] = at(date_time, 0.0, 0.0);
        // Seen from a place and not from the Earth's centre by up to a degree, and up to 5.2° from the ecliptic.
        assert!((phase_deg(&moon) - degrees).abs() < 6.5, "{date_time}: {}", phase_deg(&moon));
    }
}

#[test]
fn a_full_moon_is_four_hundred_thousand_times_fainter_than_the_sun_and_a_crescent_far_more() {
    let moon = |phase: f64| {
        let moon =
            format!("[moon]\nelevation_deg = 20\nazimuth_deg = 90\nphase_angle_deg = {phase}\nearthshine = false");
        let [sun, moon] = sun_and_moon(&scene(&format!("[sun]\nelevation_deg = -30\nazimuth_deg = 0\n{moon}")));
        moon.irradiance[1] / sun.irradiance[1]
    };
    assert!((moon(3.0) / 2.5e-6 - 1.0).abs() < 0.1, "{}", moon(3.0));
    assert!(moon(150.0) < 0.01 * moon(3.0) && moon(150.0) > 0.0);
}

fn render(scene: &Scene) -> (welkin::frame::Frame, String) {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    // Every pixel for itself: cells with the moon in them are not interpolated, and others are.
    let settings = Settings { lattice_tolerance: 0.0, ..Settings::of(Quality::Low) };
    let rendered = renderer.render(scene, settings, Outputs::default()).unwrap();
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    let sky_view = rendered.timings.plan.passes.into_iter().find(|pass| pass.name == "sky_view").unwrap();
    (rendered.frame, sky_view.reason)
}

/// A moon in the east in front of the camera, the sun south of it, in vacuum.
fn moon_in_vacuum(phase_deg: f64) -> Scene {
    let mut scene = scene(&format!(
        "[sun]\nelevation_deg = 20\nazimuth_deg = 180\n[moon]\nelevation_deg = 20\nazimuth_deg = 90\n\
         phase_angle_deg = {phase_deg}"
    ));
    scene.medium.constituents.clear();
    scene
}

#[test]
fn the_disc_of_every_phase_brings_its_irradiance_and_its_lit_side_faces_the_sun() {
    for phase_deg in [0.0, 60.0, 90.0, 140.0] {
        let scene = moon_in_vacuum(phase_deg);
        let [_, moon] = sun_and_moon(&scene);
        let (frame, _) = render(&scene);
        let pixel_sr = (2.0 * (0.5 * scene.camera.vertical_field_of_view_rad).tan() / 48.0).powi(2);
        let (mut left, mut right) = (0.0, 0.0);
        for (index, radiance) in frame.radiance.iter().enumerate() {
            let half = if index % 48 < 24 { &mut left } else { &mut right };
            *half += f64::from(radiance[1]) * pixel_sr;
        }
        let error = (left + right) / moon.irradiance[1] - 1.0;
        assert!(error.abs() < 0.03, "at {phase_deg}°: {error}");
        // Looking east, south is on the right. At half phase only the right half is lit, but for earthshine.
        let skew = (right - left) / (right + left);
        match phase_deg {
            0.0 => assert!(skew.abs() < 0.01, "{skew}"),
            60.0 => assert!((0.2..0.95).contains(&skew), "{skew}"),
            // The way to the sun rises towards the south, so that the terminator leans over the middle.
            _ => assert!(skew > 0.85, "{skew} at {phase_deg}°"),
        }
    }
}

#[test]
fn by_day_the_moon_is_drawn_but_lights_no_sky_and_by_night_the_sun_is_left_out() {
    let lights = |elevation: f64| {
        let moon = "[moon]\nelevation_deg = 20\nazimuth_deg = 90\nphase_angle_deg = 30";
        format!("[sun]\nelevation_deg = {elevation}\nazimuth_deg = 200\n{moon}")
    };
    let (with, reason) = render(&scene(&lights(40.0)));
    assert!(reason.contains("moon lights less than") && reason.contains("only its disc is drawn"), "{reason}");
    let (without, _) = render(&scene("[sun]\nelevation_deg = 40\nazimuth_deg = 200"));
    // The corner is sky, as it is without a moon; the middle is the moon in front of it.
    assert_eq!(with.radiance[0], without.radiance[0]);
    let middle = 24 * 48 + 24;
    assert!(with.radiance[middle][1] > 1.05 * without.radiance[middle][1]);
    let (night, reason) = render(&scene(&lights(-40.0)));
    assert!(reason.contains("sun stands 40.0° down"), "{reason}");
    assert!(night.radiance[0].iter().all(|&radiance| radiance > 0.0 && radiance < 1e-5), "{:?}", night.radiance[0]);
}

#[test]
fn moonlight_along_single_rays_is_what_the_path_tracer_finds() {
    let _alone = common::alone();
    let lights = "[sun]\nelevation_deg = -40\nazimuth_deg = 20\n\
                  [moon]\nelevation_deg = 30\nazimuth_deg = 160\nphase_angle_deg = 60";
    let text = format!("preset = \"hillaire2020\"\n{lights}\n{CAMERA}");
    let scene = Scene::parse(&text, Path::new("moonlight.toml")).unwrap();
    let ray = |zenith_deg: f64, azimuth_deg: f64| Ray {
        altitude_m: 2.0,
        view_zenith_rad: zenith_deg.to_radians(),
        view_azimuth_rad: azimuth_deg.to_radians(),
        sun_zenith_rad: 130_f64.to_radians(),
        sun_azimuth_rad: 20_f64.to_radians(),
        distance_m: f64::INFINITY,
    };
    let rays = [ray(40.0, 150.0), ray(70.0, 250.0), ray(85.0, 20.0), ray(20.0, 340.0), ray(120.0, 90.0)];
    let truth = reference::probe(&scene, &rays, Orders::All, Effort::Walks(2048), 5);
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
    let found = renderer.probe(&scene, Settings::of(Quality::Low), &rays, Orders::All).unwrap();
    let pairs = found.iter().zip(&truth);
    let ratios = pairs.flat_map(|(found, truth)| (0..3).map(|band| found.radiance[band] / truth.radiance[band]));
    let mean = ratios.sum::<f64>() / (3 * rays.len()) as f64;
    let errors = truth.iter().map(|truth| truth.standard_error[1] / truth.radiance[1]);
    // Bands share walks; rays do not.
    let standard_error = errors.map(|error| error.powi(2)).sum::<f64>().sqrt() / rays.len() as f64;
    // What `low` promises in the median by day.
    let bound = 0.015 + 3.0 * standard_error;
    println!("{mean} within {bound}");
    assert!((mean - 1.0).abs() < bound, "{mean}");
    // Negative control: a tenth more moonlight.
    assert!((1.1 * mean - 1.0).abs() > bound);
}
