//! Clouds in real time: the field that the reference sees, finite wherever one looks from.

mod common;

use common::with_renderer;
use std::borrow::Cow;
use std::path::Path;

use glam::DVec3;
use welkin::foreground::{Depth, Foreground};
use welkin::frame::Frame;
use welkin::gpu::{DeviceRequest, Gpu};
use welkin::passes::ShaderSources;
use welkin::plan::{CloudScattering, CloudSettings, Decision, Outputs, Plan, Quality, Settings, Skipping};
use welkin::probe::{Orders, Ray};
use welkin::reference::probe::probe_world;
use welkin::reference::{Effort, World, transport};
use welkin::renderer::{Rendered, Renderer};
use welkin::scene::{Light, Scene};

const CAPTURE: Outputs = Outputs { capture: true, picture: false };

fn scene(text: &str) -> Scene {
    let rest = "preset = \"earth\"\ncamera = { altitude_m = 2, elevation_deg = 25, azimuth_deg = 0, width = 40, height = 24 }\n";
    Scene::parse(&format!("{rest}{text}"), Path::new("clouds.toml")).unwrap()
}

fn day(clouds: &str) -> Scene {
    scene(&format!("sun = {{ elevation_deg = 35, azimuth_deg = 200 }}\n{clouds}"))
}

/// Coarse, so that the tests are quick, but with everything that there is.
fn settings() -> Settings {
    let clouds = CloudSettings {
        scattering: CloudScattering::Ordinates16,
        sweeps: 4,
        ordinate_cell_m: 960,
        ordinate_cells: 16,
        near_samples: 2,
        grid_size: 32,
        grid_slices: 6,
        grid_levels: 2,
        ..CloudSettings::of(Quality::Low)
    };
    Settings { clouds, ..Settings::of(Quality::Low) }
}

fn render(scenes: &[Scene], settings: Settings) -> Vec<Rendered> {
    with_renderer(|renderer| scenes.iter().map(|scene| renderer.render(scene, settings, CAPTURE).unwrap()).collect())
}

fn cloud_passes(plan: &Plan) -> Vec<(Decision, u64)> {
    // Frames that stand alone reconstruct nothing.
    let ours = plan.passes.iter().filter(|pass| pass.name.starts_with("cloud") && pass.name != "cloud_reconstruction");
    ours.map(|pass| (pass.decision, pass.bytes)).collect()
}

#[test]
fn a_scene_without_clouds_runs_no_pass_of_theirs_and_keeps_no_byte() {
    let nothing = "[[clouds]]\nkind = \"cumulus\"\ncoverage = 0\n[[clouds]]\nkind = \"cirrus\"\ntop_m = 8500\n";
    for scene in [day(""), day(nothing)] {
        let passes = cloud_passes(&Renderer::plan(&scene, settings(), CAPTURE).unwrap());
        assert!(passes.len() >= 7 && passes.iter().all(|pass| *pass == (Decision::Skip, 0)), "{passes:?}");
    }
    let cloudy = cloud_passes(&Renderer::plan(&day("[[clouds]]\nkind = \"cumulus\"\n"), settings(), CAPTURE).unwrap());
    assert!(cloudy.iter().all(|(decision, bytes)| *decision == Decision::Run && *bytes > 0), "{cloudy:?}");
}

#[test]
fn wind_moves_clouds_without_making_their_noise_anew_and_a_turned_camera_keeps_their_light() {
    let mut still = day("[[clouds]]\nkind = \"cumulus\"\nwind_m_per_s = [10, 0]\n");
    still.time_s = 60.0;
    let mut moved = still.clone();
    moved.time_s = 90.0;
    let mut turned = moved.clone();
    turned.camera.direction.azimuth_rad += 0.1;
    let frames = render(&[still, moved, turned], settings());
    let decision = |frame: usize, name: &str| frames[frame].timings.plan.decision(name).unwrap();
    for noise in ["cloud_shape", "cloud_erosion", "cloud_weather", "cloud_gaps"] {
        assert_eq!(decision(1, noise), Decision::Reuse);
    }
    assert_eq!((decision(1, "cloud_density"), decision(1, "cloud_light")), (Decision::Run, Decision::Run));
    assert_eq!((decision(2, "cloud_light"), decision(2, "clouds")), (Decision::Reuse, Decision::Run));
    assert_ne!(frames[0].frame.radiance, frames[1].frame.radiance);
}

/// Root mean square over the picture of the difference in transmittance to the reference's, but for pixels on the horizon:
/// there a picture has what both sides let through, each by its share.
fn transmittance_error(rendered: &Rendered, scene: &Scene) -> f64 {
    let world = World::from_scene(scene);
    let camera = &scene.camera;
    let [mut sum, mut count] = [0.0; 2];
    let radius_m = scene.planet.radius_m;
    let horizon_sine = -(1.0 - (radius_m / (radius_m + camera.altitude_m)).powi(2)).sqrt();
    for (i, found) in rendered.frame.transmittance.iter().enumerate() {
        let (x, y) = (i as u32 % camera.width, i as u32 / camera.width);
        let is_below = |dy: f64| camera.direction_through(f64::from(x) + 0.5, f64::from(y) + dy).z < horizon_sine;
        if is_below(-0.5) != is_below(1.5) {
            continue;
        }
        let direction = camera.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let truth = transport::transmittance(&world, DVec3::new(0.0, 0.0, camera.altitude_m), direction);
        sum += (f64::from(found[1]) - truth[1]).powi(2);
        count += 1.0;
    }
    (sum / count).sqrt()
}

#[test]
fn what_clouds_let_through_is_what_the_references_clouds_let_through() {
    let scene = day("[[clouds]]\nkind = \"stratocumulus\"\nwater_g_per_m3 = 0.03\nseed = 4\n");
    let settings =
        Settings { clouds: CloudSettings { step_m: 10, step_permille: 3, ..settings().clouds }, ..settings() };
    let rendered = &render(std::slice::from_ref(&scene), settings)[0];
    let error = transmittance_error(rendered, &scene);
    // A step of 10 m with its sample anywhere in it, through edges of 5e-3 /m and a few dozen metres.
    assert!(error < 0.02, "{error}");
    // Negative control: other clouds.
    let mut other = scene.clone();
    other.clouds[0].seed = 5;
    assert!(transmittance_error(rendered, &other) > 0.1);
}

/// The other hard cases of clouds are in `tests/hard_cases/clouds.rs`; this one has shaders of its own.
#[test]
fn an_anvil_under_cirrus_is_finite_from_orbit() {
    let mut scene = day("[[clouds]]\nkind = \"cumulonimbus\"\n[[clouds]]\nkind = \"cirrus\"\n");
    scene.camera.altitude_m = 300_000.0;
    scene.camera.direction.elevation_rad = (-17.0_f64).to_radians();
    let rendered = &render(std::slice::from_ref(&scene), settings())[0];
    let values = rendered.frame.radiance.iter().chain(&rendered.frame.transmittance).flatten();
    assert!(values.clone().all(|v| v.is_finite() && *v >= 0.0), "{:?}", scene.clouds);
    assert!(values.clone().any(|v| *v > 0.0));
}

/// Root mean square of the difference of two pictures over the mean of the second, in green.
fn difference(a: &Rendered, b: &Rendered) -> f64 {
    let pairs = a.frame.radiance.iter().zip(&b.frame.radiance);
    let (squares, sum) = pairs
        .fold((0.0, 0.0), |(squares, sum), (a, b)| (squares + f64::from(a[1] - b[1]).powi(2), sum + f64::from(b[1])));
    (squares * b.frame.radiance.len() as f64).sqrt() / sum
}

/// Frames of a camera that turns by an angle each time, rad, and then of one that looks the other way.
fn turning(angle_rad: f64, count: u32) -> Vec<Scene> {
    let mut scene = day("[[clouds]]\nkind = \"cumulus\"\nwind_m_per_s = [8, 3]\n");
    // Pixels narrow enough that neighbours see the same clouds.
    scene.camera.vertical_field_of_view_rad = 0.35;
    scene.camera.width = 64;
    scene.camera.height = 36;
    let frame = |i: u32| {
        let mut frame = scene.clone();
        frame.camera.direction.azimuth_rad += f64::from(i) * angle_rad;
        frame.time_s += if angle_rad > 0.0 { f64::from(i) / 24.0 } else { 0.0 };
        frame
    };
    let mut behind = scene.clone();
    behind.camera.direction.azimuth_rad += 2.5;
    (0..count).map(frame).chain([behind]).collect()
}

#[test]
fn frames_of_a_sequence_follow_the_clouds_and_a_cut_leaves_nothing_behind() {
    let settings = settings();
    assert_eq!(settings.clouds.block, 4, "a sixteenth of the pixels a frame");
    for angle_rad in [0.0, 0.015] {
        let scenes = turning(angle_rad, 5);
        let alone = render(&scenes, settings);
        let next: Vec<_> = with_renderer(|renderer| {
            scenes.iter().map(|scene| renderer.render_next(scene, settings, CAPTURE).unwrap()).collect()
        });
        let decision = |frame: usize| next[frame].timings.plan.decision("cloud_reconstruction").unwrap();
        // The first frame and that after the cut are whole. Radiance is a sum of terms above zero, and what sequences keep as half
        // floats are factors of them: of 11 digits, rounded either way.
        assert_eq!([0, 1, 4, 5].map(decision), [Decision::Skip, Decision::Run, Decision::Run, Decision::Skip]);
        let mut after_cut = next[5].frame.radiance.iter().flatten().zip(alone[5].frame.radiance.iter().flatten());
        assert!(after_cut.all(|(next, alone)| (next - alone).abs() <= 2f32.powi(-10) * alone), "something stays");
        let (error, moved) = (difference(&next[4], &alone[4]), difference(&alone[0], &alone[4]));
        match angle_rad > 0.0 {
            // A picture that stays where it was is off by all that has moved since the first frame.
            true => assert!(error < 0.5 * moved, "{error} of {moved}"),
            false => assert!(error < 1e-3, "{error}"),
        }
    }
}

/// The frames of a sequence, by a renderer of its own.
fn sequence(scenes: &[Scene], shaders: ShaderSources) -> Vec<Rendered> {
    let gpu = Gpu::new(&DeviceRequest::default()).unwrap();
    let mut renderer = Renderer::with_shaders(gpu, shaders).unwrap();
    scenes.iter().map(|scene| renderer.render_next(scene, settings(), CAPTURE).unwrap()).collect()
}

#[test]
fn a_device_that_interpolates_no_32_bit_floats_follows_the_same_clouds() {
    let _alone = common::alone();
    let text = include_str!("../shaders/wgsl/cloud_reconstruction.wgsl");
    let as_if_unable = text.replace("#ifdef FILTERED", "#ifdef UNABLE").replace("#ifndef FILTERED", "#ifndef UNABLE");
    assert_eq!(text.matches("FILTERED").count() - as_if_unable.matches("FILTERED").count(), 2, "the pass has changed");
    let scenes = &turning(0.015, 4)[..4];
    let interpolated = sequence(scenes, ShaderSources::embedded());
    let unable = ShaderSources::embedded().with("cloud_reconstruction.wgsl", Cow::Owned(as_if_unable));
    let written_out = sequence(scenes, unable);
    // Filters may round a texel's share to a 256th, and a pixel differs from the next by up to all of its light.
    let apart = difference(&written_out[3], &interpolated[3]);
    assert!(apart <= 1.0 / 256.0, "{apart}");
}

#[test]
fn before_near_surfaces_there_are_no_clouds_and_before_distant_ones_all() {
    let cloudy = day("[[clouds]]\nkind = \"stratus\"\ncoverage = 1\n");
    let clear = day("");
    let camera = &cloudy.camera;
    let at = |distance_m: f32| {
        let distances = vec![distance_m; (camera.width * camera.height) as usize];
        Foreground::new(camera, Depth::Distance, &distances, None).unwrap()
    };
    let middle = |rendered: &Rendered| rendered.frame.transmittance[(12 * camera.width + 20) as usize][1];
    let [near, near_in_clear_air, far] = with_renderer(|renderer| {
        let mut over = |scene: &Scene, distance_m: f32| {
            middle(&renderer.render_over(scene, settings(), CAPTURE, &at(distance_m)).unwrap())
        };
        [over(&cloudy, 100.0), over(&clear, 100.0), over(&cloudy, 60_000.0)]
    });
    assert!((near - near_in_clear_air).abs() < 1e-6, "{near} {near_in_clear_air}");
    assert!(far < 0.01, "{far}");
}

#[test]
fn hills_lie_in_the_clouds_shade() {
    let hills = "terrain = { height_m = 500, wavelength_m = 6000, albedo = 0.3 }\n";
    let looking_down = |clouds: &str| {
        let mut scene = scene(&format!("{hills}sun = {{ elevation_deg = 35, azimuth_deg = 200 }}\n{clouds}"));
        scene.camera.altitude_m = 900.0;
        scene.camera.direction.elevation_rad = -0.9;
        scene
    };
    let scenes = [looking_down(""), looking_down("[[clouds]]\nkind = \"stratus\"\nbase_m = 1500\ncoverage = 1\n")];
    let frames = render(&scenes, settings());
    let mean = |rendered: &Rendered| {
        rendered.frame.radiance.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
            / rendered.frame.radiance.len() as f64
    };
    let [clear, overcast] = [mean(&frames[0]), mean(&frames[1])];
    // A sheet of optical depth 10 and more leaves between a twentieth and three fifths of the light.
    assert!(overcast < 0.6 * clear && overcast > 0.05 * clear, "{clear} {overcast}");
}

#[test]
fn light_in_clouds_follows_the_sun_in_a_few_sweeps_and_settles_when_it_rests() {
    let clouds = CloudSettings { block: 1, sweeps: 12, warm_sweeps: 2, ..settings().clouds };
    // The sky's tables do not lag, so that nothing but the clouds is late.
    let skipping = Skipping { lag_share: 0.0, ..settings().skipping };
    let settings = Settings { clouds, skipping, ..settings() };
    let scene = day("[[clouds]]\nkind = \"stratocumulus\"\nwind_m_per_s = [8, 3]\n");
    // 0.2° a frame, and then nothing.
    let frame = |i: u32| {
        let mut frame = scene.clone();
        frame.time_s = f64::from(i.min(8)) / 24.0;
        if let Light::Directional(sun) = &mut frame.lights[0] {
            sun.direction.elevation_rad += 0.2_f64.to_radians() * f64::from(i.min(8));
        }
        frame
    };
    let scenes: Vec<_> = (0..17).map(frame).collect();
    let next: Vec<_> = with_renderer(|renderer| {
        scenes.iter().map(|scene| renderer.render_next(scene, settings, CAPTURE).unwrap()).collect()
    });
    let [first, last] = &render(&[scenes[0].clone(), scenes[8].clone()], settings)[..] else { unreachable!() };
    let pass = |i: usize| next[i].timings.plan.passes.iter().find(|pass| pass.name == "ordinates_sweep").unwrap();
    assert!(pass(0).reason.contains("12 sweeps"), "{}", pass(0).reason);
    let (runs, reuses): (Vec<_>, Vec<_>) = (1..9).partition(|&i| pass(i).decision == Decision::Run);
    assert!(runs.iter().all(|&i| pass(i).reason.contains("2 sweeps")) && !runs.is_empty() && !reuses.is_empty());
    // The field may lag behind by a quarter of a degree of 1.6°, and by what two sweeps leave of each change.
    let (error, moved) = (difference(&next[8], last), difference(first, last));
    assert!(error < 0.25 * moved, "{error} of {moved}");
    // At rest as many sweeps follow as from darkness.
    let settled = difference(&next[16], last);
    assert!(settled < 0.2 * error.max(1e-4) + 1e-3, "{settled} of {error}");
    assert_eq!(pass(16).decision, Decision::Reuse);
}

/// Mean radiance of the pixels of a picture that see as far as those of another, in units of the other's.
fn between_clouds(cloudy: &Frame, clear: &Frame) -> f64 {
    let pixels = (0..clear.radiance.len()).filter(|&i| cloudy.transmittance[i][1] > 0.995 * clear.transmittance[i][1]);
    let sums =
        pixels.fold([0.0; 2], |[a, b], i| [a + f64::from(cloudy.radiance[i][0]), b + f64::from(clear.radiance[i][0])]);
    sums[0] / sums[1]
}

#[test]
fn sky_between_clouds_is_brighter_and_the_horizon_below_an_overcast_is_no_brighter_than_both_sides() {
    let up = |clouds: &str| {
        let mut scene = day(clouds);
        scene.camera.direction.elevation_rad = 0.9;
        scene
    };
    let cumulus = "[[clouds]]\nkind = \"cumulus\"\ncoverage = 0.3\n";
    let [clear, cloudy, overcast]: [Rendered; 3] =
        render(&[up(""), up(cumulus), day("[[clouds]]\nkind = \"stratus\"\ncoverage = 1\n")], settings())
            .try_into()
            .unwrap_or_else(|_| unreachable!("three scenes"));
    // The path tracer's sky between fair-weather clouds is 5 to 10 % brighter in red than without them (docs/clouds.md).
    let ratio = between_clouds(&cloudy.frame, &clear.frame);
    assert!((1.01..1.15).contains(&ratio), "{ratio}");

    let [width, height] = [overcast.frame.width, overcast.frame.height].map(|n| n as usize);
    let row = |y: usize| -> f64 {
        (0..width).map(|x| f64::from(overcast.frame.radiance[y * width + x][1])).sum::<f64>() / width as f64
    };
    let infinite = |y: usize| overcast.frame.distance_m[y * width].is_infinite();
    let first_ground = (0..height).find(|&y| !infinite(y)).unwrap();
    for y in [first_ground - 1, first_ground] {
        let (above, below) = (row(first_ground - 2), row(first_ground + 1));
        assert!(row(y) <= 1.02 * above.max(below), "row {y}: {} between {above} and {below}", row(y));
    }
}

#[test]
fn droplets_that_hardly_turn_light_hide_nothing_of_the_sky_low_above_the_horizon() {
    let at_the_horizon = |clouds: &str| {
        let mut scene = day(clouds);
        scene.camera.direction.elevation_rad = 0.1;
        scene.camera.vertical_field_of_view_rad = 0.1;
        scene
    };
    // Close by, so that nearly all of the air is behind them.
    let straight =
        "[[clouds]]\nkind = \"stratus\"\ncoverage = 1\nwater_g_per_m3 = 1e-3\nphase.henyey_greenstein.g = 0.99\n";
    let frames = render(&[at_the_horizon(""), at_the_horizon(straight)], settings());
    let (clear, cloudy) = (&frames[0].frame, &frames[1].frame);
    let hidden: Vec<usize> = (0..clear.radiance.len())
        .filter(|&pixel| cloudy.transmittance[pixel][1] < 0.7 * clear.transmittance[pixel][1])
        .collect();
    assert!(hidden.len() > 100, "{} pixels", hidden.len());
    let sum = |frame: &Frame| hidden.iter().map(|&pixel| f64::from(frame.radiance[pixel][1])).sum::<f64>();
    // 1 - g² of the light is turned, and sky comes back for it. The mean of the sky's half in place of what is behind: 0.86.
    let ratio = sum(cloudy) / sum(clear);
    assert!((ratio - 1.0).abs() < 0.03, "{ratio}");
}

/// Towers in a vacuum over black ground, of droplets that scatter evenly.
fn towers(droplets: &str, view: &str) -> Scene {
    let text = "preset = \"earth\"\nmedium = []\nplanet.ground_albedo = 0\nsun = { elevation_deg = 30, azimuth_deg = 250 }\n\
        camera = { altitude_m = 500, width = 32, height = 18, ";
    let cloud = "[[clouds]]\nkind = \"congestus\"\ncoverage = 0.3\nphase.henyey_greenstein.g = 0\n";
    Scene::parse(&format!("{text}{view} }}\n{cloud}{droplets}\n"), Path::new("towers.toml")).unwrap()
}

fn mean_radiance(frame: &Frame) -> f64 {
    frame.radiance.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / frame.radiance.len() as f64
}

/// Mean radiance and its standard error by the path tracer.
fn traced(scene: &Scene) -> [f64; 2] {
    let Light::Directional(sun) = &scene.lights[0] else { panic!("the sun is the first light") };
    let camera = &scene.camera;
    let ray = |i: u32| {
        let (x, y) = (f64::from(i % camera.width) + 0.5, f64::from(i / camera.width) + 0.5);
        let view = camera.direction_through(x, y);
        Ray {
            altitude_m: camera.altitude_m,
            view_zenith_rad: view.z.acos(),
            view_azimuth_rad: view.x.atan2(view.y),
            sun_zenith_rad: std::f64::consts::FRAC_PI_2 - sun.direction.elevation_rad,
            sun_azimuth_rad: sun.direction.azimuth_rad,
            distance_m: f64::INFINITY,
        }
    };
    let rays: Vec<_> = (0..camera.width * camera.height).map(ray).collect();
    let answers = probe_world(&World::from_scene(scene), &rays, Orders::All, Effort::Walks(48), 1);
    let count = answers.len() as f64;
    let mean = answers.iter().map(|answer| answer.radiance[1]).sum::<f64>() / count;
    [mean, answers.iter().map(|answer| answer.standard_error[1].powi(2)).sum::<f64>().sqrt() / count]
}

/// What is seen of droplets that absorb nearly all was scattered once, and is as bright as their depths towards the sun let it be.
#[test]
fn towers_are_lit_as_deep_as_the_sun_shines_into_them() {
    let scene = towers("albedo = 0.02", "elevation_deg = 14, azimuth_deg = 330");
    // Light scattered many times needs no sweeps here: there is none.
    let clouds = CloudSettings { sweeps: 1, ..CloudSettings::of(Quality::Medium) };
    let mean = |scattering| {
        let settings = Settings { clouds: CloudSettings { scattering, ..clouds }, ..Settings::of(Quality::Low) };
        mean_radiance(&render(std::slice::from_ref(&scene), settings)[0].frame)
    };
    let [truth, error] = traced(&scene);
    let [texels, grid] =
        [CloudScattering::Ordinates8, CloudScattering::Single].map(|scattering| (mean(scattering) / truth - 1.0).abs());
    let least = 3.0 * error / truth;
    println!("off by {texels}, from the grid of depths by {grid}, three standard errors of the truth {least}");
    // Depths to the sun that texels of 60 m and wider know to a few per cent of what they leave (`examples/cloud_depths.rs`).
    assert!(texels < 0.05 + least);
    // Negative control: means over the cells of the grid of depths.
    assert!(grid > 0.05 + least);
}

/// Light that is scattered many times leaves the sharp edges of clouds too easily where cells are wide: the next level says how much.
#[test]
fn wide_cells_cost_clouds_no_light() {
    let _alone = common::alone();
    // One 3 km away, so thin that cells are less than a free path wide: edges are all that they cannot tell.
    let near = "elevation_deg = 20, azimuth_deg = 358, vertical_field_of_view_deg = 20";
    let scene = towers("water_g_per_m3 = 0.2", near);
    let clouds =
        CloudSettings { scattering: CloudScattering::Ordinates8, sweeps: 12, ..CloudSettings::of(Quality::Medium) };
    let settings = Settings { clouds, ..Settings::of(Quality::Low) };
    let text = include_str!("../shaders/wgsl/ordinates_light.wgsl");
    let as_each_level_has_it = text.replace("const MOST_REFINED: f32 = 2.0;", "const MOST_REFINED: f32 = 1.0;");
    assert_ne!(text, as_each_level_has_it, "the shader has changed");
    let [truth, error] = traced(&scene);
    let off = |shaders| {
        let gpu = Gpu::new(&DeviceRequest::default()).unwrap();
        let rendered = Renderer::with_shaders(gpu, shaders).unwrap().render(&scene, settings, CAPTURE).unwrap();
        (mean_radiance(&rendered.frame) / truth - 1.0).abs()
    };
    let refined = off(ShaderSources::embedded());
    let coarse = off(ShaderSources::embedded().with("ordinates_light.wgsl", Cow::Owned(as_each_level_has_it)));
    let least = 3.0 * error / truth;
    println!("off by {refined}, as each level has it by {coarse}, three standard errors of the truth {least}");
    // The energy that is asked of `ultra`, whose cells are as wide at this distance.
    assert!(refined < 0.05 + least);
    // Negative control.
    assert!(coarse > 0.05 + least);
}
