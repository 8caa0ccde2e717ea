//! Air that gives off light of its own: what follows from geometry alone, and what the path tracer finds.

mod common;

use std::path::Path;

use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Decision, Outputs, Quality, Settings};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::{self, Effort};
use welkin::renderer::Renderer;
use welkin::scene::Scene;
use welkin_lut::{Constituent, DensityProfile, PhaseFunction};

const NIGHT: &str = "preset = \"earth\"\n[medium.airglow]\n[sun]\nelevation_deg = -60\nazimuth_deg = 0\nirradiance = 0\n\
                     [camera]\naltitude_m = 2\nelevation_deg = 20\nazimuth_deg = 0\nwidth = 24\nheight = 16\n";

fn night() -> Scene {
    Scene::parse(NIGHT, Path::new("night.toml")).unwrap()
}

/// Earth in vacuum but for one layer that absorbs and emits.
fn layer(bottom_m: f64, top_m: f64, absorption_per_m: f64, radiance: f64) -> Scene {
    let mut scene = night();
    scene.medium.constituents = vec![Constituent {
        name: "layer".to_owned(),
        scattering_per_m: [0.0; 3],
        absorption_per_m: [absorption_per_m; 3],
        emission_per_m: [absorption_per_m * radiance; 3],
        profile: DensityProfile::Layer { bottom_m, top_m },
        phase: PhaseFunction::Isotropic,
    }];
    scene
}

fn ray(altitude_m: f64, zenith_deg: f64) -> Ray {
    let view_zenith_rad = zenith_deg.to_radians();
    Ray {
        altitude_m,
        view_zenith_rad,
        view_azimuth_rad: 0.0,
        sun_zenith_rad: 2.6,
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
    }
}

fn probe(scene: &Scene, rays: &[Ray], orders: Orders) -> Vec<RayRadiance> {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let answers = renderer.probe(scene, Settings::of(Quality::Medium), rays, orders).unwrap();
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    answers
}

/// Length of a ray from the ground between two shells, m.
fn path_m(radius_m: f64, zenith_deg: f64, bottom_m: f64, top_m: f64) -> f64 {
    let mu = zenith_deg.to_radians().cos();
    let to = |h: f64| ((radius_m * mu).powi(2) + h * (2.0 * radius_m + h)).sqrt();
    to(top_m) - to(bottom_m)
}

#[test]
fn a_layer_that_absorbs_and_emits_sends_its_emittance_times_its_radiance() {
    // (1 - T) L_e from thin to opaque, at any angle (Kirchhoff).
    let (bottom_m, top_m, radiance) = (30_000.0, 36_000.0, 2.0);
    let zeniths = [0.0, 40.0, 75.0, 88.0];
    let rays = zeniths.map(|zenith| ray(0.0, zenith));
    for optical_thickness in [1e-3, 0.3, 3.0, 300.0] {
        let absorption = optical_thickness / (top_m - bottom_m);
        let scene = layer(bottom_m, top_m, absorption, radiance);
        let found = probe(&scene, &rays, Orders::All);
        let error = |off: f64| {
            let each = found.iter().zip(zeniths).map(|(answer, zenith)| {
                let tau = absorption * path_m(scene.planet.radius_m, zenith, bottom_m, top_m);
                (answer.radiance[1] / (-(-tau * off).exp_m1() * radiance) - 1.0).abs()
            });
            each.fold(0.0, f64::max)
        };
        // Path lengths are interpolated between rows of a table; f32 holds six digits of the paths themselves.
        assert!(error(1.0) < 1e-3, "thickness {optical_thickness}: {}", error(1.0));
        if optical_thickness < 1.0 {
            assert!(error(1.01) > 3e-3, "a thickness one per cent off is not noticed");
        }
    }
}

#[test]
fn a_thin_shell_brightens_towards_the_horizon_as_van_rhijn_found() {
    // 1 / √(1 - (R / (R + h))² sin² z) (van Rhijn 1921), seen through nothing.
    let (bottom_m, top_m) = (89_900.0, 90_100.0);
    let scene = layer(bottom_m, top_m, 1e-9, 1.0);
    let zeniths = [0.0, 30.0, 60.0, 75.0, 85.0, 89.0];
    let found = probe(&scene, &zeniths.map(|zenith| ray(0.0, zenith)), Orders::All);
    let radius_m = scene.planet.radius_m;
    let worst = |height_m: f64| {
        let shares = zeniths.iter().zip(&found).map(|(zenith, answer)| {
            let sine = radius_m / (radius_m + height_m) * zenith.to_radians().sin();
            (answer.radiance[1] / found[0].radiance[1] * (1.0 - sine * sine).sqrt() - 1.0).abs()
        });
        shares.fold(0.0, f64::max)
    };
    assert!(worst(90_000.0) < 2e-3, "{}", worst(90_000.0));
    assert!(worst(85_000.0) > 1e-2, "a shell 5 km lower is not noticed");
}

#[test]
fn airglow_through_the_whole_atmosphere_is_what_the_path_tracer_finds() {
    let scene = night();
    let rays = [(2.0, 0.0), (2.0, 75.0), (2.0, 120.0), (10_000.0, 85.0), (50_000.0, 91.0), (400_000.0, 107.5)];
    let rays = rays.map(|(altitude, zenith)| ray(altitude, zenith));
    let found = probe(&scene, &rays, Orders::All);
    let kept = |scene: &Scene| {
        let truth = reference::probe(scene, &rays, Orders::All, Effort::Walks(12_000), 1);
        let within = |(found, truth): (&RayRadiance, &RayRadiance)| {
            (0..3).all(|band| {
                let off = (found.radiance[band] - truth.radiance[band]).abs();
                // docs/accuracy.md promises 1.5 %; the walks' own error comes on top.
                off <= 0.015 * truth.radiance[band] + 3.0 * truth.standard_error[band]
            })
        };
        found.iter().zip(&truth).all(within)
    };
    assert!(kept(&scene));
    let mut brighter = scene.clone();
    let airglow = brighter.medium.constituents.last_mut().unwrap();
    airglow.emission_per_m.iter_mut().for_each(|emission| *emission *= 1.05);
    assert!(!kept(&brighter), "five per cent more airglow are not noticed");
}

#[test]
fn airglow_seen_from_the_ground_is_as_bright_as_photometers_see_it() {
    // 145 tenth-magnitude stars of solar colour a square degree, 1.2e-11 W/m²/sr/nm each (Leinert et al. 1998); the air
    // below takes a tenth and gives most of it back.
    let zenith = probe(&night(), &[ray(2.0, 0.0)], Orders::All)[0].radiance[1];
    assert!((zenith / (145.0 * 1.2e-11) - 1.0).abs() < 0.15, "{zenith}");
}

#[test]
fn light_scattered_once_leaves_out_what_comes_straight_from_the_layer() {
    let scene = night();
    let rays = [ray(2.0, 60.0), ray(2.0, 120.0)];
    let found = probe(&scene, &rays, Orders::Single);
    let truth = reference::probe(&scene, &rays, Orders::Single, Effort::Walks(40_000), 1);
    for (found, truth) in found.iter().zip(&truth) {
        let off = (found.radiance[1] - truth.radiance[1]).abs();
        assert!(off <= 0.02 * truth.radiance[1] + 3.0 * truth.standard_error[1], "{found:?} against {truth:?}");
    }
}

#[test]
fn a_night_without_any_light_but_airglow_runs_only_what_that_takes() {
    let scene = night();
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let outputs = Outputs { capture: true, picture: true };
    let rendered = renderer.render(&scene, Settings::of(Quality::Low), outputs).unwrap();
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    for pass in ["first_order", "higher_order", "sky_view"] {
        assert_eq!(rendered.timings.plan.decision(pass), Some(Decision::Skip), "{pass}");
    }
    assert!(rendered.frame.radiance.iter().flatten().all(|&radiance| radiance > 1e-10 && radiance < 1e-7));
}
