//! Fog, local volumes and local lights: exact facts, in the reference and in real time.

mod common;

use std::path::Path;

use glam::DVec3;
use welkin::frame::Frame;
use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{CloudScattering, Decision, Outputs, Plan, Quality, Settings, Skipping};
use welkin::probe::{Orders, Ray};
use welkin::reference::probe::probe_world;
use welkin::reference::single::first_order;
use welkin::reference::{Effort, World, transport};
use welkin::renderer::{Rendered, Renderer};
use welkin::scene::{Light, Scene};

const CAPTURE: Outputs = Outputs { capture: true, picture: false };
/// One in so many pixels is compared where lamps are many.
const SPARSE: usize = 73;
const PASSES: [&str; 5] = ["volume_light", "local_clusters", "lamp_froxels", "local_media", "media_interpolation"];

/// Empty space over black ground, without light, and what is said.
fn dark(text: &str) -> Scene {
    let rest = "preset = \"earth\"\nmedium = []\nplanet.ground_albedo = 0\nsun = { elevation_deg = 40, azimuth_deg = 60, irradiance = 0 }\n\
        camera = { altitude_m = 2, elevation_deg = 12, azimuth_deg = 0, width = 24, height = 16 }\n";
    Scene::parse(&format!("{rest}{text}"), Path::new("fog.toml")).unwrap()
}

fn render(scenes: &[(Scene, Settings)]) -> Vec<Rendered> {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let of = |(scene, settings): &(Scene, Settings)| renderer.render(scene, *settings, CAPTURE).unwrap();
    let rendered = scenes.iter().map(of).collect();
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    rendered
}

fn low() -> Settings {
    Settings::of(Quality::Low)
}

/// For each pixel, in order: where it looks from and to.
fn views(scene: &Scene) -> Vec<(DVec3, DVec3)> {
    let camera = &scene.camera;
    let eye = DVec3::new(0.0, 0.0, camera.altitude_m);
    let at = |i: u32| camera.direction_through(f64::from(i % camera.width) + 0.5, f64::from(i / camera.width) + 0.5);
    (0..camera.width * camera.height).map(|i| (eye, at(i))).collect()
}

/// Whether the horizon may run through the pixel: there the picture shows what stands before both of its sides, and not the middle alone.
fn is_on_horizon(scene: &Scene, view: DVec3) -> bool {
    view.z.abs() < scene.camera.vertical_field_of_view_rad / f64::from(scene.camera.height)
}

/// A view ray, where the sun stands as in the scene.
fn ray_of(scene: &Scene, eye: DVec3, view: DVec3) -> Ray {
    let Light::Directional(sun) = &scene.lights[0] else { panic!("the sun is the first light") };
    Ray {
        altitude_m: eye.z,
        view_zenith_rad: view.z.acos(),
        view_azimuth_rad: view.x.atan2(view.y),
        sun_zenith_rad: std::f64::consts::FRAC_PI_2 - sun.direction.elevation_rad,
        sun_azimuth_rad: sun.direction.azimuth_rad,
        distance_m: f64::INFINITY,
    }
}

const FOG: &str = "[[fog]]\nextinction_per_m = [0.004, 0.006, 0.009]\nprofile.exponential.scale_height_m = 60\n";
const MIST: &str = "[[volumes]]\nname = \"mist\"\nshape = \"box\"\ncentre_m = [4, 60, 8]\nsize_m = [30, 20, 25]\nturn_deg = 30\n\
    absorption_per_m = [0.02, 0.05, 0.1]\nemission_per_m = [0.1, 0.2, 0.3]\n";
const BALL: &str = "[[volumes]]\nname = \"ball\"\nshape = \"ellipsoid\"\ncentre_m = [-9, 66, 12]\nsize_m = [30, 40, 22]\n\
    absorption_per_m = [0.01, 0.03, 0.02]\n";

/// A bank in the sun over empty space.
#[derive(Clone, Copy)]
struct Bank {
    albedo: f64,
    /// Mean cosine of its phase function, that of Henyey and Greenstein.
    asymmetry: f64,
    /// From the camera's own.
    sun_azimuth_deg: f64,
    /// A camera 20 m up stands in it and looks up, another stands above it and looks down.
    camera_altitude_m: f64,
}

impl Bank {
    fn scene(self) -> Scene {
        let Self { albedo, asymmetry, sun_azimuth_deg, camera_altitude_m } = self;
        let elevation_deg = if camera_altitude_m > 100.0 { -40 } else { 40 };
        let text = format!(
            "preset = \"earth\"\nmedium = []\nplanet.ground_albedo = 0.3\n\
             sun = {{ elevation_deg = 35, azimuth_deg = {sun_azimuth_deg}, irradiance = 1, angular_radius_deg = 0 }}\n\
             camera = {{ altitude_m = {camera_altitude_m}, elevation_deg = {elevation_deg}, azimuth_deg = 0, vertical_field_of_view_deg = 50, width = 12, height = 8 }}\n\
             [[fog]]\nextinction_per_m = 0.03\nalbedo = {albedo}\nphase.henyey_greenstein.g = {asymmetry}\nprofile.layer = {{ top_m = 100 }}\n"
        );
        Scene::parse(&text, Path::new("fog.toml")).unwrap()
    }

    /// The path tracer's mean over some rays, and one standard error of it.
    fn traced(self) -> (f64, f64) {
        let scene = self.scene();
        let rays: Vec<_> = views(&scene).into_iter().step_by(5).map(|(eye, view)| ray_of(&scene, eye, view)).collect();
        let answers = probe_world(&World::from_scene(&scene), &rays, Orders::All, Effort::Walks(4096), 3);
        let count = answers.len() as f64;
        let mean = answers.iter().map(|answer| answer.radiance[1]).sum::<f64>() / count;
        (mean, answers.iter().map(|answer| answer.standard_error[1].powi(2)).sum::<f64>().sqrt() / count)
    }
}

/// Holds the mean radiance of pictures of banks to the path tracer's, and shows that of others to be told apart.
fn assert_as_traced(cases: &[(Bank, f64)], other: impl Fn(Bank) -> Bank) {
    let scenes: Vec<_> = cases.iter().map(|(bank, _)| (bank.scene(), low())).collect();
    for (rendered, &(bank, bound)) in render(&scenes).iter().zip(cases) {
        let radiance: Vec<_> = rendered.frame.radiance.iter().step_by(5).map(|pixel| f64::from(pixel[1])).collect();
        let ours = radiance.iter().sum::<f64>() / radiance.len() as f64;
        let off = |(truth, error): (f64, f64)| (ours / truth - 1.0).abs() - 3.0 * error / truth;
        let Bank { albedo, asymmetry, sun_azimuth_deg, camera_altitude_m } = bank;
        let which =
            format!("albedo {albedo}, g {asymmetry}, sun at {sun_azimuth_deg}°, camera at {camera_altitude_m} m");
        println!("{which}: off by {} beyond three errors", off(bank.traced()));
        assert!(off(bank.traced()) < bound, "{which}: {ours} against {:?}", bank.traced());
        assert!(off(other(bank).traced()) > bound, "{which}: the control, another bank, is told apart");
    }
}

#[test]
fn a_sunlit_bank_is_as_bright_as_the_path_tracer_finds_whatever_it_absorbs() {
    // Cells and nodes of tables err by 2 %.
    let bank = |albedo| Bank { albedo, asymmetry: 0.0, sun_azimuth_deg: 40.0, camera_altitude_m: 400.0 };
    assert_as_traced(&[(bank(1.0), 0.02), (bank(0.6), 0.02)], |bank| Bank { albedo: bank.albedo - 0.1, ..bank });
}

#[test]
fn a_bank_that_scatters_forward_is_as_bright_as_the_path_tracer_finds_on_either_side_of_the_sun() {
    // docs/fog.md has the errors of single pixels; means err by less.
    let bank = |(sun_azimuth_deg, camera_altitude_m)| {
        (Bank { albedo: 1.0, asymmetry: 0.7, sun_azimuth_deg, camera_altitude_m }, 0.02)
    };
    let cases = [(30.0, 20.0), (140.0, 20.0), (180.0, 400.0)].map(bank);
    assert_as_traced(&cases, |bank| Bank { asymmetry: bank.asymmetry - 0.25, ..bank });
}

#[test]
fn what_absorbs_hides_a_bank_by_beers_law_however_the_bank_scatters() {
    let bank = Bank { albedo: 1.0, asymmetry: 0.85, sun_azimuth_deg: 140.0, camera_altitude_m: 400.0 }.scene();
    // A pane, two metres before the camera, whose shadow lies elsewhere.
    let pane = dark(
        "[[volumes]]\nname = \"pane\"\nshape = \"ellipsoid\"\ncentre_m = [0, 1.53, 398.71]\nsize_m = [1, 1, 1]\nabsorption_per_m = 1.5\n",
    );
    let behind_pane = Scene { volumes: [bank.volumes.clone(), pane.volumes].concat(), ..bank.clone() };
    let rendered = render(&[(bank.clone(), low()), (behind_pane, low())]);
    let pixel = (bank.camera.width * bank.camera.height / 2 + bank.camera.width / 2) as usize;
    let [open, hidden] = [0, 1].map(|i| f64::from(rendered[i].frame.radiance[pixel][1]));
    let behind = f64::from(rendered[1].frame.transmittance[pixel][1] / rendered[0].frame.transmittance[pixel][1]);
    assert!(behind < 0.3, "the pane hides: {behind}");
    assert!((hidden / open / behind - 1.0).abs() < 2e-3, "{} for {behind}", hidden / open);
    // Negative control: dimmed by as much of the depth as turns light away in the bank it would be another.
    assert!((hidden / open / behind.powf(1.0 - 0.85 * 0.85) - 1.0).abs() > 0.1);
}

#[test]
fn fog_and_volumes_without_light_let_through_what_beers_law_says() {
    let scene = dark(&format!("{FOG}{MIST}{BALL}"));
    let frame = &render(&[(scene.clone(), low())])[0].frame;
    let world = World::from_scene(&scene);
    let (mut hidden, mut worst, mut of_another) = (0, 0.0_f64, 0.0_f64);
    let denser = World::from_scene(&dark(&format!("{FOG}{MIST}{}", BALL.replace("0.03", "0.031"))));
    for (pixel, (eye, view)) in views(&scene).into_iter().enumerate() {
        if is_on_horizon(&scene, view) {
            continue;
        }
        let exact = transport::transmittance(&world, eye, view)[1];
        let found = f64::from(frame.transmittance[pixel][1]);
        worst = worst.max((found - exact).abs());
        of_another = of_another.max((found - transport::transmittance(&denser, eye, view)[1]).abs());
        hidden += usize::from(exact < 0.5);
    }
    assert!(hidden > 50, "hardly anything is hidden");
    assert!(worst < 1e-4, "{worst}");
    // Negative control: a thirtieth more of one volume is seen.
    assert!(of_another > 1e-3, "{of_another}");
}

#[test]
fn a_glowing_volume_alone_shows_its_source_times_its_opacity() {
    let scene = dark(MIST);
    let frame = &render(&[(scene.clone(), low())])[0].frame;
    let mut seen = 0;
    for (pixel, (eye, view)) in views(&scene).into_iter().enumerate() {
        if is_on_horizon(&scene, view) {
            continue;
        }
        let transmittance = transport::transmittance(&World::from_scene(&scene), eye, view);
        for (band, source) in [0.1 / 0.02, 0.2 / 0.05, 0.3 / 0.1].into_iter().enumerate() {
            let exact = (1.0 - transmittance[band]) * source;
            let found = f64::from(frame.radiance[pixel][band]);
            assert!((found - exact).abs() <= 1e-4 * source, "pixel {pixel}, band {band}: {found} and {exact}");
            // Negative control: light that the volume does not weaken is another.
            seen += usize::from(band == 2 && (found + transmittance[band].ln() * source).abs() > 0.1 * source);
        }
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn the_order_of_volumes_and_lights_in_the_file_changes_nothing() {
    let lamps = "[[light.point]]\nname = \"a\"\nposition_m = [3, 50, 9]\nintensity = 2\n\
        [[light.spot]]\nname = \"b\"\nposition_m = [-6, 40, 20]\nintensity = 5\nelevation_deg = -80\ninner_deg = 10\nouter_deg = 40\n";
    let scattering = |volume: &str| format!("{volume}scattering_per_m = 0.03\nphase = \"isotropic\"\n");
    let (mist, ball) = (scattering(MIST), scattering(BALL));
    let one = dark(&format!("{FOG}{mist}{ball}{lamps}"));
    let mut other = dark(&format!("{FOG}{ball}{mist}{lamps}"));
    other.lights.reverse();
    let without = dark(&format!("{FOG}{mist}{lamps}"));
    let frames = render(&[(one, low()), (other, low()), (without, low())]);
    assert_eq!(frames[0].frame.radiance, frames[1].frame.radiance);
    assert_eq!(frames[0].frame.transmittance, frames[1].frame.transmittance);
    assert!(frames[0].frame.radiance != frames[2].frame.radiance, "the ball is seen");
}

fn of_media(plan: &Plan) -> Vec<(Decision, u64)> {
    plan.passes.iter().filter(|pass| PASSES.contains(&pass.name)).map(|pass| (pass.decision, pass.bytes)).collect()
}

#[test]
fn a_scene_without_fog_volumes_and_lamps_runs_nothing_of_theirs_and_keeps_no_byte() {
    let nothing = "[[fog]]\nextinction_per_m = 0\nprofile.layer.top_m = 9\n\
        [[light.point]]\nname = \"off\"\nposition_m = [0, 9, 9]\nintensity = 0\n";
    for scene in [dark(""), dark(nothing)] {
        let plan = Renderer::plan(&scene, low(), CAPTURE).unwrap();
        assert_eq!(of_media(&plan), [(Decision::Skip, 0); PASSES.len()]);
        assert!(plan.passes.iter().all(|pass| !PASSES.contains(&pass.name) || pass.reason.contains("no fog")));
    }
    let runs = |scene: &Scene| -> Vec<bool> {
        let media = of_media(&Renderer::plan(scene, low(), CAPTURE).unwrap());
        media.iter().map(|&(decision, bytes)| decision == Decision::Run && bytes > 0).collect()
    };
    // Froxels of lamps' light are for many of them, interpolation for pictures of many pixels.
    assert_eq!(runs(&dark(FOG)), [true, true, false, true, false]);
    assert_eq!(runs(&dark(&format!("{FOG}{}", row_of_lamps(12, 1.0)))), [true, true, true, true, false]);
    let mut large = dark(FOG);
    (large.camera.width, large.camera.height) = (96, 64);
    large.camera.vertical_field_of_view_rad = 0.4;
    assert_eq!(runs(&large), [true, true, false, true, true]);
}

/// So many lamps in two rows along the view, of different brightness.
fn row_of_lamps(count: usize, intensity: f64) -> String {
    let lamp = |i: usize| {
        let (side, north) = (if i.is_multiple_of(2) { -7 } else { 6 }, 18 + 9 * i);
        let brightness = intensity * (1.0 + (i % 3) as f64);
        format!("[[light.point]]\nname = \"{i}\"\nposition_m = [{side}, {north}, 5]\nintensity = {brightness}\n")
    };
    (0..count).map(lamp).collect()
}

/// Root mean square of the relative difference over pixels that see more than a thousandth of the brightest.
fn difference(frame: &Frame, exact: &[f64]) -> f64 {
    let most = exact.iter().copied().fold(0.0, f64::max);
    let pairs = frame.radiance.iter().zip(exact).filter(|(_, exact)| **exact > 1e-3 * most);
    let squares: Vec<f64> = pairs.map(|(found, exact)| (f64::from(found[1]) / exact - 1.0).powi(2)).collect();
    assert!(squares.len() > 100, "only {} pixels see light", squares.len());
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn light_of_many_lamps_that_comes_through_froxels_is_what_quadrature_finds() {
    let fog = "[[fog]]\nextinction_per_m = 0.012\nprofile.layer.top_m = 40\n";
    let scene = |intensity: f64| {
        let mut scene = dark(&format!("{fog}{}", row_of_lamps(24, intensity)));
        (scene.camera.width, scene.camera.height) = (160, 96);
        scene
    };
    let mut single = Settings::of(Quality::High);
    single.clouds.scattering = CloudScattering::Single;
    let mut frame = render(&[(scene(1.0), single)]).remove(0).frame;
    frame.radiance = frame.radiance.into_iter().step_by(SPARSE).collect();
    let exact = |scene: &Scene| -> Vec<f64> {
        let world = World::from_scene(scene);
        let seen = |(eye, view): (DVec3, DVec3)| first_order(&world, eye, view, 1e-2).total()[1];
        views(scene).into_iter().step_by(SPARSE).map(seen).collect()
    };
    // Stated: 5 per cent, as the light of far lamps is interpolated.
    let rms = difference(&frame, &exact(&scene(1.0)));
    assert!(rms < 0.05, "{rms}");
    // Negative control: lamps a tenth brighter are told from them.
    assert!(difference(&frame, &exact(&scene(1.1))) > 0.05);
}

#[test]
fn light_of_a_lamp_that_fog_scatters_once_is_what_quadrature_finds() {
    let fog = "[[fog]]\nextinction_per_m = 0.02\nprofile.layer.top_m = 40\n";
    let lamp = |intensity: f64| {
        dark(&format!("{fog}[[light.point]]\nname = \"lamp\"\nposition_m = [2, 30, 6]\nintensity = {intensity}\n"))
    };
    let mut single = Settings::of(Quality::High);
    single.clouds.scattering = CloudScattering::Single;
    let scene = lamp(3.0);
    let frame = &render(&[(scene.clone(), single)])[0].frame;
    let exact = |scene: &Scene| -> Vec<f64> {
        let world = World::from_scene(scene);
        views(scene).into_iter().map(|(eye, view)| first_order(&world, eye, view, 1e-3).total()[1]).collect()
    };
    let rms = difference(frame, &exact(&scene));
    assert!(rms < 0.02, "{rms}");
    // Negative control: a lamp a twentieth brighter is told from it.
    assert!(difference(frame, &exact(&lamp(3.15))) > 0.04);
}

#[test]
fn volumes_out_of_the_picture_keep_no_light_and_do_not_show() {
    let ball = |name: &str, north_m: f64| {
        format!(
            "[[volumes]]\nname = \"{name}\"\nshape = \"ellipsoid\"\ncentre_m = [0, {north_m}, 8]\nsize_m = [9, 9, 9]\n\
             scattering_per_m = 0.2\nphase = \"isotropic\"\n"
        )
    };
    let mut scene = dark(&format!("{}{}{}", ball("ahead", 40.0), ball("behind", -40.0), ball("farther behind", -80.0)));
    let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
    sun.irradiance = [1.5; 3];
    let with = |skipping| (scene.clone(), Settings { skipping, ..low() });
    let wrong = Skipping { out_of_view_share: -1.0, ..Skipping::USUAL };
    // The wrong one first: in memory that held the right light before it might be found again.
    let frames = render(&[with(wrong), with(Skipping::USUAL), with(Skipping::NONE)]);
    let bytes = |rendered: &Rendered| of_media(&rendered.timings.plan)[0].1;
    assert_eq!(3 * bytes(&frames[1]), bytes(&frames[2]));
    assert!(frames[1].frame.radiance == frames[2].frame.radiance);
    // Negative control: the light of what is in the picture is missed.
    assert!(frames[0].frame.radiance != frames[2].frame.radiance);
}

/// A stroke of lightning in a sheet of cloud of some density, seen from below.
fn stroke(density: f64, time_s: f64) -> Scene {
    let mut scene = dark(&format!(
        "time_s = {time_s}\n[[clouds]]\nkind = \"stratus\"\ncoverage = 1\nbase_m = 300\ntop_m = 700\n\
         water_g_per_m3 = {}\n[[light.point]]\nname = \"stroke\"\nposition_m = [60, 500, 420]\nintensity = 1e4\n\
         flash = {{ start_s = 2, decay_s = 0.1 }}\n",
        0.3 * density
    ));
    scene.camera.direction.elevation_rad = 0.6;
    scene
}

#[test]
fn lightning_inside_a_cloud_is_what_quadrature_finds_and_fades() {
    let mut single = Settings::of(Quality::High);
    single.clouds.scattering = CloudScattering::Single;
    let at_once = stroke(1.0, 2.0);
    let scenes = [at_once.clone(), stroke(1.0, 2.1), stroke(1.0, 1.9), stroke(1.4, 2.0)];
    let mut frames = render(&scenes.map(|scene| (scene, single)));
    assert_eq!(of_media(&frames[2].timings.plan), [(Decision::Skip, 0); PASSES.len()]);
    assert!(frames[2].frame.radiance.iter().flatten().all(|&radiance| radiance == 0.0));
    let sum = |frame: &Frame| frame.radiance.iter().map(|radiance| f64::from(radiance[1])).sum::<f64>();
    let faded = sum(&frames[1].frame) / sum(&frames[0].frame);
    assert!((faded * 1.0_f64.exp() - 1.0).abs() < 1e-3, "{faded}");
    frames.iter_mut().for_each(|it| it.frame.radiance = it.frame.radiance.iter().copied().step_by(31).collect());
    let world = World::from_scene(&at_once);
    let seen = |(eye, view): (DVec3, DVec3)| first_order(&world, eye, view, 2e-2).total()[1];
    let exact: f64 = views(&at_once).into_iter().step_by(31).map(seen).sum();
    // Clouds weaken the lamp's light by samples on the way to it.
    let ratio = sum(&frames[0].frame) / exact;
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    // Negative control: a denser cloud is told from it.
    let denser = sum(&frames[3].frame) / exact;
    assert!((denser - 1.0).abs() > 0.05, "{denser}");
}
