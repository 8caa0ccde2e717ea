//! What a scene calls for is computed, and nothing else; what still holds is not computed again.

mod common;

use std::path::Path;

use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Decision, Outputs, Plan, Quality, Settings, Skipping};
use welkin::renderer::{Rendered, Renderer};
use welkin::scene::{EnvironmentLight, Light, Scene};
use welkin_shaders::ParameterBuffers;

const PICTURE: Outputs = Outputs { capture: true, picture: true };

fn noon() -> Scene {
    let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/noon.toml")).unwrap();
    (scene.camera.width, scene.camera.height) = (33, 21);
    scene
}

fn plan(scene: &Scene) -> Plan {
    Renderer::plan(scene, Settings::of(Quality::Low), PICTURE).unwrap()
}

/// The passes of air that gives off light of its own, of what stands before the camera, of local media, of pictures large
/// enough to be interpolated, and of more wavelengths than three.
const OF_OTHER_SCENES: [&str; 14] = [
    "emission_order",
    "view_emission",
    "aerial_optical_depth",
    "aerial_perspective",
    "volume_light",
    "local_clusters",
    "terrain",
    "lamp_froxels",
    "surface_cells",
    "local_media",
    "media_interpolation",
    "sky_lattice",
    "interpolate",
    "colour",
];

/// The passes of other treatments of multiply scattered light than that of the hazy noon; tests/treatment.rs has the rule.
const OTHER_TREATMENTS: [&str; 3] = ["first_order", "higher_order", "isotropic_series"];

/// The passes that directional lights call for.
const LIT: [&str; 6] = ["first_order", "higher_order", "isotropic_series", "first_source", "higher_source", "sky_view"];

/// What is skipped besides the passes of other scenes.
fn skipped_of_sunlight(plan: &Plan) -> Vec<&'static str> {
    names(plan, Decision::Skip).into_iter().filter(|name| !OF_OTHER_SCENES.contains(name)).collect()
}

/// Passes of the clear sky; `tests/cloud_pictures.rs` asks for those of clouds.
fn names(plan: &Plan, decision: Decision) -> Vec<&'static str> {
    let sky = plan.passes.iter().filter(|pass| !pass.name.starts_with("cloud") && !pass.name.starts_with("ordinates"));
    sky.filter(|pass| pass.decision == decision).map(|pass| pass.name).collect()
}

fn reason(plan: &Plan, name: &str) -> String {
    plan.passes.iter().find(|pass| pass.name == name).unwrap().reason.clone()
}

/// Renders scenes one after the other on one renderer, under validation.
fn render(scenes: &[Scene]) -> Vec<Rendered> {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let settings = Settings::of(Quality::Low);
    let rendered = scenes.iter().map(|scene| renderer.render(scene, settings, PICTURE).unwrap()).collect();
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    rendered
}

#[test]
fn a_clear_day_runs_all_that_sunlight_takes_and_every_reason_says_something() {
    let plan = plan(&noon());
    assert_eq!(names(&plan, Decision::Skip), [&OTHER_TREATMENTS[..], &OF_OTHER_SCENES].concat());
    assert!(plan.passes.iter().all(|pass| !pass.reason.is_empty()));
    assert!(plan.passes.iter().all(|pass| (pass.bytes > 0) == (pass.decision == Decision::Run)));
}

#[test]
fn vacuum_runs_no_table_and_shows_lit_ground_under_a_black_sky() {
    let mut scene = noon();
    scene.medium.constituents.clear();
    let plan = plan(&scene);
    assert_eq!(names(&plan, Decision::Run), ["compose", "display"]);
    assert!(reason(&plan, "sky_view").contains("vacuum"));
    let frame = &render(&[scene.clone()])[0].frame;
    // The sun stands 60° high: the ground sends back albedo / pi of its irradiance on the horizontal.
    let Light::Directional(sun) = &scene.lights[0] else { panic!("the sun is directional") };
    let ground =
        scene.planet.ground_albedo[1] / std::f64::consts::PI * sun.irradiance[1] * sun.direction.elevation_rad.sin();
    let below = frame.radiance[33 * 20 + 16][1];
    assert!((f64::from(below) / ground - 1.0).abs() < 1e-5, "{below} against {ground}");
    assert_eq!(frame.radiance[16], [0.0; 3]);
    assert!(frame.transmittance.iter().all(|transmittance| *transmittance == [1.0; 3]));
}

#[test]
fn air_that_only_absorbs_needs_no_multiple_scattering() {
    let mut scene = noon();
    for constituent in &mut scene.medium.constituents {
        constituent.absorption_per_m = constituent.extinction_per_m();
        constituent.scattering_per_m = [0.0; 3];
    }
    let plan = plan(&scene);
    assert_eq!(skipped_of_sunlight(&plan), LIT);
    assert!(reason(&plan, "first_source").contains("scatters"));
    let frame = &render(&[scene])[0].frame;
    assert_eq!(frame.radiance[16], [0.0; 3]);
    // The sun still lights the ground through the air.
    assert!(frame.radiance[33 * 20 + 16].iter().all(|&radiance| radiance > 0.0));
}

#[test]
fn in_the_dark_nothing_scatters_but_the_air_still_weakens() {
    let mut scene = noon();
    scene.lights.clear();
    assert_eq!(skipped_of_sunlight(&plan(&scene)), LIT);
    let frame = &render(&[scene])[0].frame;
    assert!(frame.radiance.iter().all(|radiance| *radiance == [0.0; 3]));
    assert!(frame.transmittance[16].iter().all(|&t| t > 0.0 && t < 1.0));
}

#[test]
fn from_below_the_ground_one_sees_what_one_sees_from_the_ground() {
    let [mut ground, mut below] = [noon(), noon()];
    ground.camera.altitude_m = 0.0;
    below.camera.altitude_m = -10.0;
    assert!(reason(&plan(&below), "sky_view").contains("10 m below the ground"));
    let rendered = render(&[ground, below, noon()]);
    assert_eq!(rendered[0].frame, rendered[1].frame);
    assert_eq!(rendered[0].picture, rendered[1].picture);
    // Negative control: two metres higher the ground looks different.
    assert_ne!(rendered[0].frame, rendered[2].frame);
}

#[test]
fn what_depends_on_nothing_that_changed_is_reused_and_gives_the_same_picture() {
    let first = noon();
    let mut turned = noon();
    turned.camera.direction.azimuth_rad += 1.0;
    let mut later = noon();
    if let Light::Directional(sun) = &mut later.lights[0] {
        sun.direction.elevation_rad -= 0.1;
    }
    let mut brighter_ground = noon();
    brighter_ground.planet.ground_albedo = [0.9; 3];
    let rendered = render(&[first.clone(), first.clone(), turned, later, brighter_ground, first]);
    let ran = |index: usize| names(&rendered[index].timings.plan, Decision::Run);
    assert_eq!(ran(0).len(), 7);
    assert!(ran(1).is_empty());
    assert_eq!(ran(2), ["compose", "display"]);
    assert_eq!(ran(3), ["sky_view", "compose", "display"]);
    assert_eq!(ran(4), ["first_source", "higher_source", "sky_view", "compose", "display"]);
    assert_eq!(rendered[0].frame, rendered[1].frame);
    assert_eq!(rendered[0].frame, rendered[5].frame);
    // Negative control: what did change is seen.
    assert_ne!(rendered[0].frame, rendered[3].frame);
}

/// The largest relative difference of a pixel.
fn difference(exact: &Rendered, other: &Rendered) -> f64 {
    let pixels = exact.frame.radiance.as_flattened().iter().zip(other.frame.radiance.as_flattened());
    pixels.map(|(exact, other)| f64::from((exact - other).abs()) / (f64::from(*exact) + 1e-11)).fold(0.0, f64::max)
}

/// A sun that sinks by 0.01° a frame from an elevation: the largest error of a pixel in any frame, and how often each pass
/// ran and all were reused.
fn sinking_sun(from_deg: f64, frames: u32, skipping: Skipping) -> (f64, usize, usize) {
    let [mut exact, mut lagging] = [(); 2].map(|()| Renderer::new(&DeviceRequest::default()).unwrap());
    let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hills.toml")).unwrap();
    (scene.camera.width, scene.camera.height) = (24, 14);
    let (mut worst, mut ran, mut together) = (0.0_f64, 0, 0);
    for frame in 0..frames {
        let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
        sun.direction.elevation_rad = (from_deg - 0.01 * f64::from(frame)).to_radians();
        let settings = Settings { skipping, ..Settings::of(Quality::Low) };
        let now = exact.render(&scene, Settings::of(Quality::Low), Outputs::default()).unwrap();
        let late = lagging.render(&scene, settings, Outputs::default()).unwrap();
        worst = worst.max(difference(&now, &late));
        let tables = ["sky_view", "aerial_perspective"].map(|name| late.timings.plan.decision(name));
        let running = tables.iter().filter(|decision| **decision == Some(Decision::Run)).count();
        (ran, together) = (ran + running, together + usize::from(frame > 0 && running == 2));
    }
    (worst, ran, together)
}

#[test]
fn a_hundred_frames_without_change_run_no_pass() {
    let _alone = common::alone();
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
    let mut scene = noon();
    let mut settings = Settings { skipping: Skipping::IN_SEQUENCE, ..Settings::of(Quality::Low) };
    for frame in 0..100 {
        let plan = renderer.render(&scene, settings, PICTURE).unwrap().timings.plan;
        assert_eq!(names(&plan, Decision::Run).is_empty(), frame > 0, "frame {frame}");
    }
    // Control: what moves runs, and in single pictures all of it.
    scene.camera.direction.azimuth_rad += 0.01;
    assert_eq!(names(&renderer.render(&scene, settings, PICTURE).unwrap().timings.plan, Decision::Run)[0], "compose");
    let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
    sun.direction.elevation_rad += 1e-9;
    settings.skipping = Skipping::USUAL;
    assert_eq!(names(&renderer.render(&scene, settings, PICTURE).unwrap().timings.plan, Decision::Run)[0], "sky_view");
}

#[test]
fn tables_lag_behind_a_moving_sun_by_what_does_not_show_and_come_in_different_frames() {
    let _alone = common::alone();
    let share = Skipping::IN_SEQUENCE.lag_share;
    let (worst, ran, together) = sinking_sun(40.0, 60, Skipping::IN_SEQUENCE);
    println!("from 40°: {worst}, {ran} tables, {together} frames with two");
    assert!(worst < share && ran < 60 && together == 0, "{worst} {ran} {together}");
    // Lower down there is more to do.
    for from_deg in [20.3, 0.2] {
        let (worst, ran, _) = sinking_sun(from_deg, 30, Skipping::IN_SEQUENCE);
        println!("from {from_deg}°: {worst}, {ran} tables");
        assert!(worst < share, "from {from_deg}°: {worst}, {ran} tables");
    }
    // Control: too much lag shows.
    let careless = Skipping { lag_share: 200.0 * share, ..Skipping::IN_SEQUENCE };
    let (worst, ..) = sinking_sun(12.0, 60, careless);
    assert!(worst > share, "{worst}");
}

#[test]
fn fifty_frames_of_changing_scene_and_size_leave_nothing_behind() {
    let _alone = common::alone();
    let growth_kib = |parameters: Option<ParameterBuffers>| {
        let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
        if let Some(parameters) = parameters {
            renderer.place_parameters(parameters);
        }
        let mut scene = noon();
        let mut frame = |step: u32| {
            (scene.camera.width, scene.camera.height) = if step.is_multiple_of(2) { (160, 90) } else { (80, 45) };
            scene.display.exposure_ev = f64::from(step) * 0.1;
            let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
            sun.direction.elevation_rad = 1.0 - f64::from(step) * 0.01;
            renderer.render(&scene, Settings::of(Quality::Low), PICTURE).unwrap();
            (renderer.gpu().population(), common::resident_kib())
        };
        let warm = (0..10).map(&mut frame).last().unwrap();
        let last = (10..60).map(&mut frame).last().unwrap();
        assert_eq!(last.0, warm.0);
        let is_mesa_22 = renderer.gpu().info().driver_version.contains("Mesa 22");
        (last.1.saturating_sub(warm.1), is_mesa_22)
    };
    // Frames of this size have 0.5 MB: keeping them, or the code of one dispatch of each, would take 25 MB.
    let (grown, is_mesa_22) = growth_kib(None);
    assert!(grown < 5 * 1024, "{grown} KiB");
    // Control: the driver of which this was learnt keeps what it compiles for uniform buffers.
    let (grown, _) = growth_kib(Some(ParameterBuffers::Uniform));
    assert!(!is_mesa_22 || grown > 10 * 1024, "uniform buffers: {grown} KiB");
}

#[test]
fn another_quadrature_is_another_result() {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let settings = Settings::of(Quality::Low);
    renderer.render(&noon(), settings, PICTURE).unwrap();
    let finer = Settings { nodes_per_leg: settings.nodes_per_leg + 1, ..settings };
    let plan = renderer.render(&noon(), finer, PICTURE).unwrap().timings.plan;
    for name in ["first_source", "higher_source", "sky_view", "compose"] {
        assert_eq!(plan.decision(name), Some(Decision::Run), "{name}");
    }
}

#[test]
fn each_light_adds_its_own_sky() {
    let one = noon();
    let mut two = noon();
    let Light::Directional(sun) = &two.lights[0] else { panic!("the sun is directional") };
    let mut twin = sun.clone();
    twin.direction.azimuth_rad += 2.0;
    two.lights.push(Light::Directional(twin.clone()));
    let mut other = noon();
    other.lights = vec![Light::Directional(twin)];
    let frames: Vec<_> = render(&[one, other, two]).into_iter().map(|rendered| rendered.frame).collect();
    for (pixel, both) in frames[2].radiance.iter().enumerate() {
        let [one, other] = [&frames[0], &frames[1]].map(|frame| frame.radiance[pixel]);
        for ((both, one), other) in both.iter().zip(one).zip(other) {
            assert!((both / (one + other) - 1.0).abs() < 1e-5, "pixel {pixel}: {both} against {one} + {other}");
        }
    }
}

#[test]
fn what_the_renderer_cannot_do_is_refused_with_the_way_out() {
    let mut scene = noon();
    scene.lights.push(Light::Environment(EnvironmentLight { radiance: [1.0; 3] }));
    let error = Renderer::plan(&scene, Settings::of(Quality::Low), PICTURE).unwrap_err().to_string();
    assert!(error.contains("environment") && error.contains("--backend reference"), "{error}");
}

#[test]
fn every_view_from_the_ground_to_the_moon_is_finite_and_never_negative() {
    let mut scenes = Vec::new();
    for altitude_m in [0.0, 1e-3, 2.0, 99_999.99, 100_000.0, 100_000.01, 400_000.0, 3.8e8] {
        for elevation_deg in [90.0_f64, 0.0, -1e-5, -45.0, -90.0] {
            for sun_deg in [90.0_f64, 0.0, -6.0, -90.0] {
                let mut scene = noon();
                scene.camera.altitude_m = altitude_m;
                scene.camera.direction.elevation_rad = elevation_deg.to_radians();
                if let Light::Directional(sun) = &mut scene.lights[0] {
                    sun.direction.elevation_rad = sun_deg.to_radians();
                }
                scenes.push(scene);
            }
        }
    }
    for (scene, rendered) in scenes.iter().zip(render(&scenes)) {
        let radiance = rendered.frame.radiance.iter().flatten();
        assert!(radiance.clone().all(|value| value.is_finite() && *value >= 0.0), "{:?}", scene.camera);
        let mut transmittance = rendered.frame.transmittance.iter().flatten();
        assert!(transmittance.all(|t| (0.0..=1.0).contains(t)), "{:?}", scene.camera);
    }
}

#[test]
fn the_suns_disc_brings_its_irradiance_however_few_pixels_it_covers() {
    // Pixels of 1.2°, 0.5° and 0.04°, around a disc of 0.53°.
    for (field_of_view_deg, height) in [(60.0_f64, 50), (60.0, 121), (4.0, 100)] {
        let mut scene = noon();
        scene.medium.constituents.clear();
        let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
        let irradiance = sun.irradiance;
        scene.camera.direction = sun.direction;
        scene.camera.direction.azimuth_rad += 0.01;
        scene.camera.vertical_field_of_view_rad = field_of_view_deg.to_radians();
        (scene.camera.width, scene.camera.height) = (height, height);
        let frame = &render(&[scene.clone()])[0].frame;
        let [_, _, forward] = scene.camera.basis();
        let side = 2.0 * (0.5 * scene.camera.vertical_field_of_view_rad).tan() / f64::from(height);
        for band in 0..3 {
            let mut sum = 0.0;
            for (pixel, radiance) in frame.radiance.iter().enumerate() {
                let (x, y) = (pixel as u32 % height, pixel as u32 / height);
                let view = scene.camera.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5);
                sum += f64::from(radiance[band]) * side * side * view.dot(forward).powi(3);
            }
            // A disc of a pixel or two is caught by few samples of its blur, which leaves some per cent.
            let error = (sum / irradiance[band] - 1.0).abs();
            assert!(error < 0.12, "{field_of_view_deg}° in {height} rows, band {band}: {error}");
        }
    }
}
