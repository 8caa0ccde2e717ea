//! The program's picture beside welkin's own of the same scene.

use std::path::Path;

use welkin::bake::{air_of, bake_on_device, describe, shaders};
use welkin::frame::Frame;
use welkin::gpu::DeviceRequest;
use welkin::plan::{Outputs, Quality, Settings, bake_settings};
use welkin::renderer::Renderer;
use welkin::report::compare;
use welkin::scene::Scene;
use welkin_lut::pack::{FileFormat, PackOptions, Precision, write_pack};
use welkin_wgpu_sky::{Camera, draw};

/// East, north, up as x right, y up, z towards the viewer, who looks north.
fn y_up([east, north, up]: [f64; 3]) -> [f32; 3] {
    [east as f32, up as f32, -north as f32]
}

fn camera(scene: &Scene, sun: [f64; 3]) -> Camera {
    let [right, up, forward] = scene.camera.basis();
    Camera {
        altitude_m: scene.camera.altitude_m as f32,
        right: y_up(right.to_array()),
        up: y_up(up.to_array()),
        forward: y_up(forward.to_array()),
        half_height: (0.5 * scene.camera.vertical_field_of_view_rad).tan() as f32,
        sun: y_up(sun),
    }
}

#[test]
fn a_wgpu_program_draws_from_a_pack_what_welkin_renders() {
    let folder = tempfile::tempdir().unwrap();
    let pack = folder.path().join("pack");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/noon.toml");
    let mut scene = Scene::read(&path).unwrap();
    // Lower, so that ground and horizon are in the picture.
    scene.camera.direction.elevation_rad = 0.2;
    (scene.camera.width, scene.camera.height) = (320, 180);
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
    let (air, settings) = (air_of(&scene).unwrap(), bake_settings(Quality::Medium));
    let baked = bake_on_device(&mut renderer, &scene, &air, settings).unwrap();
    let options = PackOptions { formats: vec![FileFormat::Raw], precisions: vec![Precision::F16] };
    let files = shaders(&scene, &settings).unwrap();
    write_pack(&pack, &baked, &describe(&scene, &air, "gpu"), &options, &files).unwrap();
    // What docs/engines/README.md states; the sky of a low sun is farther off than what was asked for, 0.02.
    for (elevation_deg, bound) in [(60.0_f64, 0.02), (5.0, 0.035)] {
        let welkin::scene::Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun comes first") };
        sun.direction.elevation_rad = elevation_deg.to_radians();
        let sun = sun.direction;
        let rendered = renderer.render(&scene, Settings::of(Quality::Medium), Outputs::default()).unwrap().frame;
        let drawn = |direction: [f64; 3]| {
            let mut frame = Frame::new(320, 180);
            frame.channels = rendered.channels;
            frame.radiance = draw(&pack, &camera(&scene, direction), [320, 180]).unwrap();
            frame
        };
        let picture = compare(&drawn(sun.to_vector().to_array()), &rendered).unwrap();
        println!("sun at {elevation_deg}°: FLIP {:.4}", picture.mean_flip);
        assert!(picture.mean_flip <= bound, "{}", picture.mean_flip);
        // Negative control: up is taken for north, as where Z is up.
        let [x, y, z] = sun.to_vector().to_array();
        let wrong = compare(&drawn([x, z, y]), &rendered).unwrap();
        println!("with another axis up: {:.4}", wrong.mean_flip);
        assert!(wrong.mean_flip > 10.0 * bound, "{}", wrong.mean_flip);
    }
}
