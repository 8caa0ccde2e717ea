//! Froxels that an engine asks for hold what stands before a surface at their place, for what it draws that light passes through.

mod common;
#[path = "../examples/vulkan_host/engine.rs"]
#[allow(dead_code)]
mod engine;
#[path = "../examples/vulkan_host/frames.rs"]
#[allow(dead_code)]
mod frames;
#[path = "../examples/vulkan_host/glass.rs"]
#[allow(dead_code)]
mod glass;
#[path = "../examples/vulkan_host/images.rs"]
mod images;

use ash::vk;
use engine::Engine;
use glass::{Froxels, sample};
use welkin::foreground::{Depth, Foreground};
use welkin::gpu::{DeviceRequest, HostUse};
use welkin::plan::{Decision, FroxelGrid, Outputs, Quality, Settings};
use welkin::renderer::{HostFrame, HostFroxels, Renderer};
use welkin::scene::Scene;

const SIZE: [u32; 2] = [48, 32];
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn scene(altitude_m: f64, more: &str) -> Scene {
    seen(altitude_m, "elevation_deg = 5\nazimuth_deg = 80", more)
}

/// From an altitude towards a direction.
fn seen(altitude_m: f64, towards: &str, more: &str) -> Scene {
    let [width, height] = SIZE;
    let text = format!(
        "preset = \"hillaire2020\"\n[sun]\nelevation_deg = 20\nazimuth_deg = 90\n\
         [camera]\naltitude_m = {altitude_m}\n{towards}\nwidth = {width}\nheight = {height}\n{more}"
    );
    Scene::parse(&text, "scene.toml".as_ref()).unwrap()
}

const FOG: &str = "[[fog]]\nextinction_per_m = 0.002\nprofile.layer = { top_m = 400, edge = 0.5 }\n\
                   [[light.point]]\nname = \"lamp\"\nposition_m = [300, 50, 20]\nintensity = [2e4, 2e4, 1e4]\n";
const CLOUDS: &str = "[[clouds]]\nkind = \"stratocumulus\"\n";

/// Every pixel marched, so that what is interpolated is what the froxels are.
fn settings() -> Settings {
    let mut settings = Settings::of(Quality::Low);
    settings.volumes.lattice_permille = 0;
    settings
}

/// What stands before a black wall at a distance along every ray, of a frame without an engine: radiance and transmittance.
fn before_wall(renderer: &mut Renderer, scene: &Scene, distance_m: f64) -> [Vec<[f32; 3]>; 2] {
    let pixels = (SIZE[0] * SIZE[1]) as usize;
    let depth = vec![distance_m as f32; pixels];
    let wall = Foreground::new(&scene.camera, Depth::Distance, &depth, Some(&vec![[0.0; 3]; pixels])).unwrap();
    let outputs = Outputs { capture: true, picture: false };
    let frame = renderer.render_over(scene, settings(), outputs, &wall).unwrap().frame;
    [frame.radiance, frame.transmittance]
}

/// Froxels of a frame of the engine, whose walls they pass through, in metres from near to far.
fn froxels(engine: &Engine, scene: &Scene, grid: FroxelGrid) -> [Vec<[f32; 4]>; 2] {
    let froxels = Froxels::of_grid(engine, FLOATS, grid).unwrap();
    frames::render(engine, Some(&froxels), std::slice::from_ref(scene), settings(), 1.0).unwrap();
    let read = froxels.read(engine).unwrap();
    froxels.destroy(engine);
    read
}

/// The three channels of some texels.
fn channels(texels: &[[f32; 4]]) -> Vec<f32> {
    texels.iter().flat_map(|texel| texel[..3].to_vec()).collect()
}

/// The mean over some values of how far others are from them.
fn mean_difference(found: &[f32], expected: &[f32]) -> f32 {
    let sum: f32 = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).sum();
    sum / expected.len() as f32
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

#[test]
fn froxels_hold_what_a_black_wall_at_their_place_shows() {
    let _alone = common::alone();
    let engine = Engine::new(SIZE, FLOATS, true).unwrap();
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
    let texels = (SIZE[0] * SIZE[1]) as usize;
    // Marches stop at slices, so that their steps through what is uneven are others: by what clouds differ in the mean with steps begun
    // elsewhere at this quality (0.9 % of the light, 0.0011 of the transmittance, measured), and twice that at most.
    for (name, scene, far_m, light_bound, transmittance_bound) in [
        ("air", scene(500.0, ""), 60_000.0, 1e-5, 1e-5),
        ("space", seen(400_000.0, "elevation_deg = -25\nazimuth_deg = 80", ""), 2_500_000.0, 1e-5, 1e-5),
        ("clouds", scene(500.0, CLOUDS), 60_000.0, 0.025, 0.005),
        ("within clouds", scene(1_000.0, CLOUDS), 2_000.0, 0.03, 0.005),
        ("fog and a lamp", scene(30.0, FOG), 60_000.0, 0.02, 0.005),
    ] {
        // A froxel of each pixel, before the engine's walls, between them and behind.
        let grid = FroxelGrid { size: [SIZE[0], SIZE[1], 6], near_m: 1e-3 * far_m, far_m };
        let [radiance, transmittance] = froxels(&engine, &scene, grid);
        assert!(radiance[..texels].iter().all(|texel| texel[..3] == [0.0; 3]), "{name}: nothing before the camera");
        assert!(transmittance[..texels].iter().all(|texel| *texel == [1.0; 4]), "{name}: nothing before the camera");
        let mut nearest: Option<[f32; 2]> = None;
        for slice in 1..6 {
            let distance_m = grid.distance_m(slice);
            let range = slice as usize * texels..(slice as usize + 1) * texels;
            let found = [&radiance, &transmittance].map(|all| channels(&all[range.clone()]));
            let expected = before_wall(&mut renderer, &scene, distance_m).map(|values| values.concat());
            let light = mean_difference(&found[0], &expected[0]) / mean(&expected[0]).max(f32::MIN_POSITIVE);
            let through = mean_difference(&found[1], &expected[1]);
            println!("{name}, {distance_m:.0} m: light {light:.1e}, transmittance {through:.1e}");
            assert!(light < light_bound && through < transmittance_bound, "{name}, {distance_m:.0} m");
            let means = expected.each_ref().map(|values| mean(values));
            // The control: from the nearest slice to the farthest there is more light and less behind it, by more than what is allowed.
            let [light_near, through_near] = *nearest.get_or_insert(means);
            if slice == 5 {
                assert!(means[0] > (1.0 + 2.0 * light_bound) * light_near, "{name}");
                assert!(means[1] < through_near - 2.0 * transmittance_bound, "{name}");
            }
        }
    }
    assert_eq!(engine.close(), Vec::<String>::new());
}

#[test]
fn between_froxels_a_linear_sampler_reads_what_is_there() {
    let _alone = common::alone();
    let engine = Engine::new(SIZE, FLOATS, true).unwrap();
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
    let towards = "elevation_deg = 5\nazimuth_deg = 220\nvertical_field_of_view_deg = 12";
    for (name, scene) in [
        ("air", seen(500.0, towards, "")),
        ("fog and a lamp", seen(30.0, towards, FOG)),
        ("clouds", seen(500.0, towards, CLOUDS)),
    ] {
        let grid = FroxelGrid { size: [SIZE[0] / 4, SIZE[1] / 4, 32], near_m: 100.0, far_m: 60_000.0 };
        let [radiance, transmittance] = froxels(&engine, &scene, grid);
        for distance_m in [40.0, 150.0, 900.0, 7_000.0, 40_000.0] {
            let [light, through] = before_wall(&mut renderer, &scene, distance_m).map(|values| values.concat());
            let read = |texels: &[[f32; 4]]| -> Vec<f32> {
                let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
                let texels = places.map(|[x, y]| {
                    let place = [(x as f32 + 0.5) / SIZE[0] as f32, (y as f32 + 0.5) / SIZE[1] as f32];
                    sample(&grid, texels, place, distance_m)
                });
                channels(&texels.collect::<Vec<_>>())
            };
            let light = mean_difference(&read(&radiance), &light) / mean(&light);
            let through = mean_difference(&read(&transmittance), &through);
            println!("{name}, {distance_m:.0} m: light {light:.1e}, transmittance {through:.1e}");
            // Columns are 1.5° wide: edges of clouds, from 900 m up, are not in them.
            let is_ragged = name == "clouds" && distance_m > 900.0;
            let bounds = if is_ragged { [0.2, 0.08] } else { [0.01, 0.002] };
            assert!(light < bounds[0] && through < bounds[1], "{name}, {distance_m:.0} m");
        }
        // The control: at another slice the light is another.
        let [far, _] = before_wall(&mut renderer, &scene, 900.0).map(|values| values.concat());
        let [near, _] = before_wall(&mut renderer, &scene, 150.0).map(|values| values.concat());
        assert!(mean_difference(&near, &far) > 0.2 * mean(&far), "{name}");
    }
    assert_eq!(engine.close(), Vec::<String>::new());
}

#[test]
fn froxels_are_made_only_where_they_are_asked_for_and_media_only_when_something_moves() {
    let _alone = common::alone();
    let engine = Engine::new(SIZE, FLOATS, true).unwrap();
    let gpu = frames::open(&engine).unwrap();
    let froxels = Froxels::new(&engine, FLOATS).unwrap();
    let without = HostFrame { depth: None, ..frames::frame(&engine, &gpu, 1.0).unwrap() };
    let with = HostFrame { froxels: Some(froxels.for_welkin(&gpu).unwrap()), ..without.clone() };
    let mut renderer = Renderer::on(gpu).unwrap();
    let mut left = [HostUse::default(); 2];
    let mut decisions = |scene: &Scene, frame: &HostFrame| {
        let slot = &engine.slots[0];
        let hosted = frames::record(&engine, slot, &mut renderer, scene, settings(), frame, &mut left).unwrap();
        engine.submit(slot).unwrap();
        engine.finish().unwrap();
        ["aerial_perspective", "froxel_media", "host_froxels"].map(|pass| hosted.plan.decision(pass).unwrap())
    };
    use Decision::{Reuse, Run, Skip};
    assert_eq!(decisions(&scene(500.0, ""), &without), [Skip, Skip, Skip]);
    assert_eq!(decisions(&scene(500.0, ""), &with), [Run, Skip, Run], "clear air has no media");
    assert_eq!(decisions(&scene(500.0, CLOUDS), &with), [Reuse, Run, Run]);
    assert_eq!(decisions(&scene(500.0, CLOUDS), &with), [Reuse, Reuse, Run], "the host's images may be others");
    assert_eq!(decisions(&scene(600.0, CLOUDS), &with), [Run, Run, Run], "another place");
    drop((renderer, with, without));
    froxels.destroy(&engine);
    assert_eq!(engine.close(), Vec::<String>::new());
}

#[test]
fn froxels_that_cannot_be_filled_are_refused_in_words() {
    let _alone = common::alone();
    let engine = Engine::new(SIZE, FLOATS, true).unwrap();
    let gpu = frames::open(&engine).unwrap();
    let froxels = Froxels::new(&engine, FLOATS).unwrap();
    let small = FroxelGrid { size: [3, 2, 16], ..froxels.grid };
    let other = Froxels::of_grid(&engine, FLOATS, small).unwrap();
    let frame = frames::frame(&engine, &gpu, 1.0).unwrap();
    let good = froxels.for_welkin(&gpu).unwrap();
    let refused = |froxels: HostFroxels| {
        let frame = HostFrame { froxels: Some(froxels), ..frame.clone() };
        frame.check(&scene(500.0, "").camera).unwrap_err().to_string()
    };
    let of_another_size = HostFroxels { transmittance: other.for_welkin(&gpu).unwrap().transmittance, ..good.clone() };
    assert!(refused(of_another_size).contains("D3(3, 2, 16)"));
    let flat = HostFroxels { radiance: frame.colour.clone(), ..good.clone() };
    assert!(refused(flat).contains("two slices or more"));
    for far_m in [f64::INFINITY, 0.0, f64::NAN] {
        assert!(refused(HostFroxels { far_m, ..good.clone() }).contains("finite distances above 0"), "{far_m}");
    }
    // SAFETY: it is refused before it is looked at.
    let too_deep = unsafe { gpu.host_volume("deep", vk::Image::null(), FLOATS, [4, 4, 1 << 20]) };
    assert!(too_deep.err().unwrap().to_string().contains("4 x 4 x 1048576 texels"));
    drop((good, frame, gpu));
    [&froxels, &other].into_iter().for_each(|froxels| froxels.destroy(&engine));
    assert_eq!(engine.close(), Vec::<String>::new());
}
