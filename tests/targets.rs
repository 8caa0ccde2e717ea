//! Frames drawn into images of the host's, and in pieces, are the frames that are read back.

mod common;
#[path = "../examples/vulkan_host/engine.rs"]
mod engine;
#[path = "../examples/vulkan_host/frames.rs"]
mod frames;
#[path = "../examples/vulkan_host/glass.rs"]
#[allow(dead_code)]
mod glass;
#[path = "../examples/vulkan_host/images.rs"]
mod images;

use std::time::Duration;

use ash::vk;
use engine::{Engine, WALLS};
use welkin::foreground::{Depth, Foreground};
use welkin::gpu::{
    DeviceRequest, Gpu, GpuError, GpuImage, HostUse, ImageFormat, ImageShape, NextUse, Pace, ScreenEncoding,
};
use welkin::output::{display, screen};
use welkin::passes::RenderError;
use welkin::plan::{Decision, Outputs, Quality, Settings};
use welkin::renderer::{Renderer, Targets};
use welkin::scene::Scene;

const OUTPUTS: Outputs = Outputs { capture: false, picture: true };

fn scene(sun_deg: f64, more: &str) -> Scene {
    let text = format!(
        "preset = \"hillaire2020\"\n[sun]\nelevation_deg = {sun_deg}\nazimuth_deg = 90\n\
         [camera]\naltitude_m = 500\nelevation_deg = 5\nazimuth_deg = 80\nwidth = 96\nheight = 64\n{more}"
    );
    Scene::parse(&text, "scene.toml".as_ref()).unwrap()
}

fn settings() -> Settings {
    Settings::of(Quality::Low)
}

fn targets(gpu: &Gpu, width: u32) -> Targets {
    let image = |name: &str, format: ImageFormat| -> Option<GpuImage> {
        Some(gpu.image(name, ImageShape::D2(width, 64), format).unwrap())
    };
    let (radiance, picture) = (image("light", ImageFormat::Rgba32Float), image("shown", ImageFormat::Rgba8Unorm));
    Targets { radiance, picture, ..Targets::default() }
}

/// The picture and the radiance that a target holds.
fn content(gpu: &Gpu, targets: &Targets) -> (Vec<[u8; 4]>, Vec<[f32; 4]>) {
    let picture = gpu.read_image(targets.picture.as_ref().unwrap()).unwrap();
    (picture, gpu.read_image(targets.radiance.as_ref().unwrap()).unwrap())
}

/// The same as it is read back by [`Renderer::render`].
fn read_back(renderer: &mut Renderer, scene: &Scene) -> (Vec<[u8; 4]>, Vec<[f32; 4]>) {
    let rendered = renderer.render(scene, settings(), OUTPUTS).unwrap();
    let picture = rendered.picture.unwrap().chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2], 255]).collect();
    (picture, rendered.frame.radiance.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect())
}

/// Radiance without its fourth component, which means nothing.
fn shown((picture, radiance): &(Vec<[u8; 4]>, Vec<[f32; 4]>)) -> (&[[u8; 4]], Vec<[f32; 3]>) {
    (picture, radiance.iter().map(|&[r, g, b, _]| [r, g, b]).collect())
}

#[test]
fn pixels_that_are_waited_for_later_are_those_of_their_own_frame() {
    common::with_gpu(|gpu| {
        let mut wide = scene(-3.0, "");
        wide.camera.width = 160;
        let scenes = [scene(20.0, ""), scene(2.0, ""), wide, scene(20.0, "")];
        let capture = Outputs { capture: true, picture: true };
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        let mut start = |scene: &Scene| renderer.render_pending(scene, settings(), capture).unwrap();
        // The third is of another size: the images of the first two are freed before anybody has waited for them.
        let pending: Vec<_> = scenes.iter().map(&mut start).collect();
        drop(start(&scenes[1]));
        drop(renderer);
        for (scene, frame) in scenes.iter().zip(pending) {
            let later = std::thread::spawn(move || frame.wait().unwrap()).join().unwrap();
            let at_once = Renderer::on(gpu.clone()).unwrap().render(scene, settings(), capture).unwrap();
            assert!(later.frame == at_once.frame && later.picture == at_once.picture, "{:?}", scene.camera);
        }
    });
}

#[test]
fn a_frame_in_the_hosts_images_is_the_frame_that_is_read_back() {
    common::with_gpu(|gpu| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        for scene in [scene(20.0, ""), scene(20.0, "[spectrum]\nwavelengths = 6\n")] {
            let expected = read_back(&mut renderer, &scene);
            let [first, second] = [targets(gpu, 96), targets(gpu, 96)];
            renderer.render_to(&scene, settings(), &first, NextUse::Copy).unwrap();
            assert_eq!(shown(&content(gpu, &first)), shown(&expected));
            // A second frame goes to its own images, and a frame that is read back touches neither.
            renderer.render_to(&scene, settings(), &second, NextUse::Sample).unwrap();
            let other = read_back(&mut renderer, &self::scene(4.0, ""));
            assert_eq!(shown(&content(gpu, &second)), shown(&expected));
            assert_eq!(shown(&content(gpu, &first)), shown(&expected));
            assert_ne!(shown(&other), shown(&expected), "the control: another sun is another picture");
        }
    });
}

/// A picture alone, its radiance kept in half floats; and the same from all digits.
fn for_screen_and_exact(renderer: &mut Renderer, gpu: &Gpu, scene: &Scene) -> [Vec<[u8; 4]>; 2] {
    let all = targets(gpu, 96);
    let picture_alone = Targets { radiance: None, ..all.clone() };
    [picture_alone, all].map(|targets| {
        renderer.render_to(scene, settings(), &targets, NextUse::Copy).unwrap();
        gpu.read_image(targets.picture.as_ref().unwrap()).unwrap()
    })
}

#[test]
fn radiance_that_only_a_screen_is_shown_may_be_half_floats() {
    common::with_gpu(|gpu| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        let night = "[display]\nexposure_ev = 22\n";
        for (sun_deg, more) in [(20.0, ""), (5.0, "[display]\nexposure_ev = -3\n"), (-12.0, night)] {
            let scene = scene(sun_deg, more);
            let [for_screen, exact] = for_screen_and_exact(&mut renderer, gpu, &scene);
            // Half floats round by 1/2048 of a value, and the curve from it to 255 steps has no slope above 255: less than
            // a step, and so at most one.
            let steps = for_screen.iter().flatten().zip(exact.iter().flatten()).map(|(a, b)| a.abs_diff(*b));
            assert!(steps.max() <= Some(1), "sun at {sun_deg} degrees");
            assert!(exact.iter().any(|[red, ..]| (32..224).contains(red)), "the control: it shows something");
        }
        // The control: without an exposure before them, half floats would have no digits for that night.
        let radiance = read_back(&mut renderer, &scene(-12.0, night)).1;
        assert!(radiance.iter().all(|[red, ..]| *red < 6e-5), "the smallest half float with all its digits is 6.1e-5");
    });
}

#[test]
fn a_screen_that_shows_light_above_white_is_sent_what_the_standards_say() {
    common::with_gpu(|gpu| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        // The sun stands in the picture: light far above white.
        let scene = scene(8.0, "[display]\nexposure_ev = 2\n");
        for (encoding, encode) in [
            (ScreenEncoding::ExtendedLinear, screen::extended_linear as fn([f64; 3]) -> [f64; 3]),
            (ScreenEncoding::Hdr10, screen::hdr10),
        ] {
            let picture = gpu.image("bright", ImageShape::D2(96, 64), encoding.image_format()).ok();
            let targets = Targets { picture, encoding, ..targets(gpu, 96) };
            renderer.render_to(&scene, settings(), &targets, NextUse::Copy).unwrap();
            let sent: Vec<[half::f16; 4]> = gpu
                .read_image::<[u16; 4]>(targets.picture.as_ref().unwrap())
                .unwrap()
                .into_iter()
                .map(|texel| texel.map(half::f16::from_bits))
                .collect();
            let radiance: Vec<[f32; 4]> = gpu.read_image(targets.radiance.as_ref().unwrap()).unwrap();
            let exposed = display::exposed_srgb(&scene);
            let expected = |&[r, g, b, _]: &[f32; 4]| {
                let linear = exposed * glam::DVec3::new(r.into(), g.into(), b.into());
                encode(display::tone_map_up_to(screen::HEADROOM, scene.display.tone_map, linear.to_array()))
            };
            let (mut worst, mut brightest) = (0.0_f64, 0.0_f64);
            for (sent, expected) in sent.iter().zip(radiance.iter().map(expected)) {
                for (sent, expected) in sent.iter().zip(expected) {
                    worst = worst.max((sent.to_f64() - expected).abs() / expected.max(0.05));
                    brightest = brightest.max(expected);
                }
            }
            // Noise of a step of ten bits where there is any, and the rounding of half floats.
            let noise = if encoding == ScreenEncoding::Hdr10 { 1.0 / 1023.0 / 0.05 } else { 0.0 };
            assert!(worst < noise + 2e-3, "{encoding:?}: {worst}");
            let white = encode([1.0; 3])[0];
            assert!(brightest > 1.1 * white, "the control: {encoding:?} shows more than white: {brightest} {white}");
        }
    });
}

#[test]
fn a_target_of_another_size_is_refused() {
    common::with_gpu(|gpu| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        let refused = renderer.render_to(&scene(20.0, ""), settings(), &targets(gpu, 95), NextUse::Copy);
        let Err(error @ RenderError::Target { .. }) = refused else { panic!("{:?}", refused.map(|_| ())) };
        assert!(error.to_string().contains("D2(95, 64)") && error.to_string().contains("D2(96, 64)"), "{error}");
    });
}

fn lattice_is_used(scene: &Scene) -> bool {
    let plan = Renderer::plan(scene, settings(), OUTPUTS).unwrap();
    plan.decision("interpolate") == Some(Decision::Run)
}

#[test]
fn a_frame_in_pieces_is_the_same_to_the_last_bit() {
    common::with_gpu(|gpu| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        let clouds = "[[clouds]]\nkind = \"stratocumulus\"\n";
        // Through a narrow lens the sky is interpolated, but for the cells of the horizon, which the device counts.
        let narrow = scene(20.0, "vertical_field_of_view_deg = 11.8\n");
        assert!(lattice_is_used(&narrow));
        let hazy = scene(4.0, "[medium.mie]\ndensity_factor = 40\n");
        let scenes = [scene(20.0, ""), narrow, hazy, scene(30.0, clouds)];
        let whole = scenes.each_ref().map(|scene| read_back(&mut renderer, scene));
        let mut in_pieces = Renderer::on(gpu.clone()).unwrap();
        in_pieces.set_pace(Some(Pace::new(Duration::from_micros(200))));
        for (scene, whole) in scenes.iter().zip(&whole) {
            assert_eq!(shown(&read_back(&mut in_pieces, scene)), shown(whole));
        }
    });
}

#[test]
fn a_stopped_frame_leaves_nothing_half_done_for_the_next() {
    common::with_gpu(|gpu| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        let (before, wanted) = (scene(20.0, ""), scene(4.0, ""));
        let expected = read_back(&mut renderer, &before);
        let pace = Pace::new(Duration::from_micros(200));
        renderer.set_pace(Some(pace.clone()));
        pace.stop();
        let stopped = renderer.render(&wanted, settings(), OUTPUTS);
        assert!(matches!(&stopped, Err(RenderError::Gpu(error)) if error.is_stopped()), "it ran on");
        pace.resume();
        // The tables of the first scene may be overwritten: they are not taken for whole.
        let again = renderer.render(&before, settings(), OUTPUTS).unwrap();
        assert_eq!(again.timings.plan.decision("sky_view"), Some(Decision::Run));
        assert_eq!(shown(&read_back(&mut renderer, &before)), shown(&expected));
    });
}

const SIZE: [u32; 2] = [96, 64];

/// What the engine draws, as a picture of distances and one of light.
fn walls(scene: &Scene, engine: &Engine, units_per_radiance: f32) -> Foreground {
    let mut depth = vec![f32::INFINITY; (SIZE[0] * SIZE[1]) as usize];
    let mut light = vec![[0.0_f32; 3]; depth.len()];
    for wall in &WALLS {
        let [left, top, right, bottom] = engine.pixels(wall);
        for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))) {
            let pixel = (y * SIZE[0] + x) as usize;
            (depth[pixel], light[pixel]) = (wall.planar_m, wall.colour.map(|value| value / units_per_radiance));
        }
    }
    Foreground::new(&scene.camera, Depth::Planar, &depth, Some(&light)).unwrap()
}

/// The same frame without an engine, in its unit.
fn headless(renderer: &mut Renderer, scene: &Scene, engine: &Engine, units_per_radiance: f32) -> Vec<[f32; 3]> {
    let foreground = walls(scene, engine, units_per_radiance);
    let rendered = renderer.render_over(scene, settings(), Outputs::default(), &foreground).unwrap();
    rendered.frame.radiance.iter().map(|rgb| rgb.map(|value| value * units_per_radiance)).collect()
}

/// The largest difference relative to the brighter, or to a thousandth of the picture's mean.
fn largest_difference(found: &[[f32; 4]], expected: &[[f32; 3]]) -> f32 {
    let all = || expected.iter().flatten();
    let mean = all().sum::<f32>() / all().count() as f32;
    let pairs = found.iter().flat_map(|rgba| &rgba[..3]).zip(all());
    pairs.map(|(a, b)| (a - b).abs() / a.max(*b).max(1e-3 * mean)).fold(0.0, f32::max)
}

#[test]
fn an_engine_gets_in_its_own_images_what_is_rendered_headless() {
    let _alone = common::alone();
    let clouds = "[[clouds]]\nkind = \"stratocumulus\"\n";
    let scenes = [scene(20.0, ""), scene(4.0, clouds), scene(20.0, "")];
    let mut without = Renderer::new(&DeviceRequest::default()).unwrap();
    // Distances are found in f32 from reversed depth. Devices may cut off what half floats cannot hold, 2^-10 of it: of
    // the walls' light when they are drawn, and of the picture.
    for (format, units_per_radiance, bound) in
        [(vk::Format::R32G32B32A32_SFLOAT, 1.0, 1e-4), (vk::Format::R16G16B16A16_SFLOAT, 4.0, 2.1e-3)]
    {
        let engine = Engine::new(SIZE, format, true).unwrap();
        // Three frames, two of them in flight; one where only the format is another.
        let scenes = if units_per_radiance == 1.0 { &scenes[..] } else { &scenes[..1] };
        let pictures = frames::render(&engine, None, scenes, settings(), f64::from(units_per_radiance)).unwrap();
        let mut headless = |scene: &Scene| headless(&mut without, scene, &engine, units_per_radiance);
        let expected: Vec<_> = scenes.iter().map(&mut headless).collect();
        for (index, (picture, expected)) in pictures.iter().zip(&expected).enumerate() {
            let difference = largest_difference(picture, expected);
            println!("{format:?} frame {index}: {difference:.1e}");
            assert!(difference < bound, "{format:?} frame {index}: {difference}");
        }
        // Negative controls: another sun, and the frame without the engine's walls.
        assert!(largest_difference(&pictures[0], &headless(&scene(4.0, ""))) > 0.1);
        let bare = without.render(&scenes[0], settings(), Outputs::default());
        let bare: Vec<_> = bare.unwrap().frame.radiance.iter().map(|rgb| rgb.map(|l| l * units_per_radiance)).collect();
        assert!(largest_difference(&pictures[0], &bare) > 0.1);
        // The layer also hears of what is left when the engine closes its device.
        assert_eq!(engine.close(), Vec::<String>::new());
    }
}

#[test]
fn a_frame_that_is_given_up_leaves_nothing_for_the_next() {
    let _alone = common::alone();
    let engine = Engine::new(SIZE, vk::Format::R32G32B32A32_SFLOAT, true).unwrap();
    let gpu = frames::open(&engine).unwrap();
    let frame = frames::frame(&engine, &gpu, 1.0).unwrap();
    let mut renderer = Renderer::on(gpu.clone()).unwrap();
    let mut left = [HostUse::default(); 2];
    let mut record = |renderer: &mut Renderer, slot, scene: &Scene| {
        frames::record(&engine, &engine.slots[slot], renderer, scene, settings(), &frame, &mut left).unwrap().recorded
    };
    // Its tables were never computed, though they are recorded.
    let recorded = record(&mut renderer, 0, &scene(20.0, ""));
    renderer.abandon(recorded);
    left = [HostUse::default(); 2];
    let mut record = |renderer: &mut Renderer, slot, scene: &Scene| {
        frames::record(&engine, &engine.slots[slot], renderer, scene, settings(), &frame, &mut left).unwrap().recorded
    };
    let recorded = record(&mut renderer, 1, &scene(20.0, ""));
    engine.submit(&engine.slots[1]).unwrap();
    let picture = engine.picture(&engine.slots[1]).unwrap();
    let expected = headless(&mut Renderer::new(&DeviceRequest::default()).unwrap(), &scene(20.0, ""), &engine, 1.0);
    assert!(largest_difference(&picture, &expected) < 1e-4);
    // Nothing is read back here: the queue is the engine's.
    let image = gpu.image("own", ImageShape::D2(8, 8), ImageFormat::R32Float).unwrap();
    let refused = gpu.write_image(&image, &[0.0_f32; 64]);
    assert!(matches!(refused, Err(GpuError::HostsQueue { .. })), "{refused:?}");
    drop((recorded, renderer, frame, image, gpu));
    assert_eq!(engine.close(), Vec::<String>::new());
}

#[test]
fn an_engine_that_lies_about_its_images_is_told_by_the_validation_layer() {
    let _alone = common::alone();
    let engine = Engine::new(SIZE, vk::Format::R32G32B32A32_SFLOAT, true).unwrap();
    let gpu = frames::open(&engine).unwrap();
    let mut frame = frames::frame(&engine, &gpu, 1.0).unwrap();
    // It copies its picture, and does not say so.
    let layout = engine::COPIED_COLOUR.layout;
    frame.colour.after = Some(HostUse { layout, ..HostUse::default() });
    let mut renderer = Renderer::on(gpu.clone()).unwrap();
    let (slot, mut left) = (&engine.slots[0], [HostUse::default(); 2]);
    let scene = scene(20.0, "");
    let recorded = frames::record(&engine, slot, &mut renderer, &scene, settings(), &frame, &mut left).unwrap();
    engine.submit(slot).unwrap();
    engine.finish().unwrap();
    drop((recorded, renderer, frame, gpu));
    let messages = engine.close();
    assert!(messages.iter().any(|message| message.contains("SYNC-HAZARD")), "{messages:?}");
}

#[test]
fn a_host_that_lacks_something_is_told_what() {
    let _alone = common::alone();
    let mut engine = Engine::new(SIZE, vk::Format::R32G32B32A32_SFLOAT, true).unwrap();
    engine.features.synchronization2 = false;
    engine.features.robust_image_access = false;
    engine.queue_family = 99;
    let Err(error) = frames::open(&engine) else { panic!("it was not refused") };
    let text = error.to_string();
    for lacks in ["synchronization2", "robustImageAccess", "queue family 99"] {
        assert!(text.contains(lacks), "{text}");
    }
    assert!(!text.contains("robustBufferAccess"), "it has that: {text}");
    engine.features =
        welkin::gpu::HostFeatures { synchronization2: true, robust_image_access: true, ..engine.features };
    engine.queue_family = 0;
    let gpu = frames::open(&engine).unwrap();
    let mut frame = frames::frame(&engine, &gpu, 1.0).unwrap();
    let refused = |frame: &welkin::renderer::HostFrame| {
        let mut renderer = Renderer::on(gpu.clone()).unwrap();
        let (slot, mut left) = (&engine.slots[0], [HostUse::default(); 2]);
        let recorded = frames::record(&engine, slot, &mut renderer, &scene(20.0, ""), settings(), frame, &mut left);
        recorded.map(|_| ()).unwrap_err().to_string()
    };
    std::mem::swap(&mut frame.colour.image, &mut frame.depth.as_mut().unwrap().image.image);
    assert!(refused(&frame).contains("Rgba16Float"));
    std::mem::swap(&mut frame.colour.image, &mut frame.depth.as_mut().unwrap().image.image);
    frame.depth.as_mut().unwrap().buffer = welkin::renderer::DepthBuffer::Planar;
    assert!(refused(&frame).contains("R32Float"));
    frame.depth.as_mut().unwrap().buffer =
        welkin::renderer::DepthBuffer::Perspective { near_m: 10.0, far_m: 1.0, reversed: false };
    assert!(refused(&frame).contains("10 and 1 m"));
    frame.depth = None;
    // SAFETY: it is refused before it is looked at.
    let unknown = unsafe { gpu.host_image("flags", vk::Image::null(), vk::Format::R8_UINT, SIZE) };
    assert!(unknown.err().unwrap().to_string().contains("R8_UINT"));
    drop((frame, gpu));
    assert_eq!(engine.close(), Vec::<String>::new());
}
