//! Frames drawn into images of the host's, and in pieces, are the frames that are read back.

mod common;

use std::time::Duration;

use welkin::gpu::{Gpu, GpuImage, ImageFormat, ImageShape, NextUse, Pace, ScreenEncoding};
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
