//! Pipelines are made side by side before a frame is recorded, and none that it does without.

mod common;

use std::path::Path;

use welkin::gpu::DeviceRequest;
use welkin::plan::{Outputs, Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

#[test]
fn no_pipeline_is_made_that_a_frame_does_without() {
    let _alone = common::alone();
    for name in ["noon", "orbit", "mountains", "clouds/sunset", "fog/valley-morning", "fog/street-lamp"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml");
        let mut scene = Scene::read(&path).unwrap();
        // Wide enough to be interpolated.
        (scene.camera.width, scene.camera.height) = (160, 90);
        let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
        for outputs in [Outputs { capture: false, picture: true }, Outputs { capture: true, picture: false }] {
            renderer.compute(&scene, Settings::of(Quality::Low), outputs).unwrap();
            assert_eq!(renderer.idle_pipelines(), 0, "{name}, {outputs:?}");
        }
        assert!(renderer.compiled_pipelines() > 5, "{name}");
    }
}
