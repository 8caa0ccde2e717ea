//! Mountains before the sky.

mod common;

use std::path::Path;

use glam::DVec3;
use welkin::frame::Frame;
use welkin::plan::{Outputs, Quality, Settings};
use welkin::reference::World;
use welkin::scene::Scene;
use welkin_lut::height_field::HeightField;

const CAPTURE: Outputs = Outputs { capture: true, picture: false };

/// Runs a test on a renderer under validation, of which a single message fails it.
fn with_renderer(test: impl FnOnce(&mut dyn FnMut(&Scene) -> Frame)) {
    common::with_renderer(|renderer| {
        test(&mut |scene| renderer.render(scene, Settings::of(Quality::Low), CAPTURE).unwrap().frame);
    });
}

/// The mountains of the gallery in a picture of so many pixels.
fn mountains(width: u32, height: u32) -> Scene {
    let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/mountains.toml")).unwrap();
    (scene.camera.width, scene.camera.height) = (width, height);
    scene
}

/// Share of the pixels whose distance is within a per cent of where the reference's ray meets the ground.
fn share_of_right_distances(scene: &Scene, frame: &Frame) -> f64 {
    let world = World::from_scene(scene);
    let camera = &scene.camera;
    let right = |pixel: usize| {
        let (x, y) = (pixel as u32 % camera.width, pixel as u32 / camera.width);
        let direction = camera.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let span = world.span(DVec3::new(0.0, 0.0, camera.altitude_m), direction).unwrap();
        match world.shape.altitude(DVec3::new(0.0, 0.0, camera.altitude_m) + direction * span.end_m) {
            altitude_m if altitude_m > 50_000.0 => frame.distance_m[pixel] == f32::INFINITY,
            _ => (f64::from(frame.distance_m[pixel]) / span.end_m - 1.0).abs() < 0.01,
        }
    };
    let pixels = frame.distance_m.len();
    (0..pixels).filter(|&pixel| right(pixel)).count() as f64 / pixels as f64
}

#[test]
fn the_device_finds_the_mountains_where_the_reference_does_and_without_holes() {
    with_renderer(|render| {
        let mut scene = mountains(64, 36);
        // A pixel of 0.2 mrad leaves out only what is smaller than 2 m at 5 km.
        scene.camera.vertical_field_of_view_rad = 36.0 * 2e-4;
        scene.camera.direction.elevation_rad = -0.025;
        let frame = render(&scene);
        let share = share_of_right_distances(&scene, &frame);
        assert!(share > 0.97, "{share}");
        // Below the horizon every ray ends on the ground.
        let mut down = mountains(32, 18);
        down.camera.direction.elevation_rad = -0.6;
        assert!(render(&down).distance_m.iter().all(|distance_m| distance_m.is_finite()));
        // Negative control: other mountains stand elsewhere.
        let terrain = scene.terrain.as_mut().unwrap();
        terrain.field = HeightField::new(terrain.field.height_m, terrain.field.wavelength_m, 99, [0.0; 2]);
        assert!(share_of_right_distances(&scene, &frame) < 0.5);
    });
}

#[test]
fn from_far_above_mountains_are_the_smooth_sphere() {
    with_renderer(|render| {
        let mut with = mountains(24, 24);
        with.camera.direction.elevation_rad = -std::f64::consts::FRAC_PI_2;
        let mut differences = |altitude_m: f64| {
            with.camera.altitude_m = altitude_m;
            let mut without = with.clone();
            without.terrain = None;
            let (with, without) = (render(&with), render(&without));
            let worst = with.radiance.iter().zip(&without.radiance).map(|(a, b)| (a[1] / b[1] - 1.0).abs());
            worst.fold(0.0, f32::max)
        };
        // Of a surface at the distance of the ground the air is the same, up to the froxels' half floats.
        let far = differences(2e6);
        assert!(far < 2e-3, "{far}");
        assert!(differences(2e4) > 0.1);
    });
}

#[test]
fn inside_a_mountain_one_sees_what_one_sees_standing_on_it() {
    with_renderer(|render| {
        let mut inside = mountains(16, 9);
        let ground_m = inside.terrain.as_ref().unwrap().height_below_camera_m();
        assert!(ground_m > 100.0);
        let mut standing = inside.clone();
        inside.camera.altitude_m = 0.5 * ground_m;
        standing.camera.altitude_m = ground_m + 1.0;
        assert_eq!(render(&inside), render(&standing));
        standing.camera.altitude_m = ground_m + 30.0;
        assert_ne!(render(&inside), render(&standing));
    });
}

#[test]
fn a_step_of_a_metre_changes_the_picture_a_little() {
    with_renderer(|render| {
        // Mean over the picture of the relative change of radiance.
        let change = |a: &Frame, b: &Frame| {
            let changes = a.radiance.iter().zip(&b.radiance).map(|(a, b)| f64::from((a[1] / b[1] - 1.0).abs()));
            changes.sum::<f64>() / a.radiance.len() as f64
        };
        let mut at = |east_m: f64, up_m: f64| {
            let mut scene = mountains(64, 36);
            let terrain = scene.terrain.as_mut().unwrap();
            let (height_m, wavelength_m) = (terrain.field.height_m, terrain.field.wavelength_m);
            terrain.field = HeightField::new(height_m, wavelength_m, 12, [east_m, 0.0]);
            scene.camera.altitude_m += up_m;
            render(&scene)
        };
        let here = at(0.0, 0.0);
        let mut moved = |east_m: f64, up_m: f64| change(&at(east_m, up_m), &here);
        // Pixels are 11 mrad wide: at 1 km a step is a tenth of one.
        assert!(moved(1.0, 0.0) < 0.02 && moved(0.0, 1.0) < 0.02, "{} {}", moved(1.0, 0.0), moved(0.0, 1.0));
        assert!(moved(300.0, 0.0) > 0.02);
    });
}
