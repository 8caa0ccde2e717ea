//! Whatever the text of a scene file is, it is refused with a reason or becomes a scene that can be planned.
#![no_main]

use std::path::Path;

use libfuzzer_sys::{Corpus, fuzz_target};
use welkin::plan::{Outputs, Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::{Scene, SceneError};

const CAPTURE: Outputs = Outputs { capture: true, picture: true };

fuzz_target!(|text: &str| -> Corpus {
    // A path that leads out of this folder might lead to a device that never ends.
    if text.contains('/') {
        return Corpus::Reject;
    }
    match Scene::parse(text, Path::new("fuzz.toml")) {
        Ok(scene) => {
            if let Err(error) = Renderer::plan(&scene, Settings::of(Quality::Low), CAPTURE) {
                assert!(!error.to_string().is_empty());
            }
        }
        Err(SceneError::Invalid(invalid)) => assert!(!invalid.problem.is_empty(), "{invalid:?}"),
        Err(error) => panic!("{error}: the scene's text is given"),
    }
    Corpus::Keep
});
