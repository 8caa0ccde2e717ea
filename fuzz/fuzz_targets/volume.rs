//! Whatever the bytes of a volume's array file are, the scene that names it is refused with a reason or has a grid of sound
//! numbers.
#![no_main]

use std::fs;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;
use welkin::scene::{Scene, SceneError};

const SCENE: &str = include_str!("volume.toml");

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| tempfile::tempdir().expect("a folder for temporary files"));

fuzz_target!(|bytes: &[u8]| {
    fs::write(FOLDER.path().join("smoke.npy"), bytes).expect("room for temporary files");
    match Scene::parse(SCENE, &FOLDER.path().join("scene.toml")) {
        Ok(scene) => {
            let grid = scene.volumes[0].grid.as_ref().expect("the scene's volume has a grid");
            assert_eq!(grid.samples().len(), grid.size().iter().product::<usize>());
            assert!(grid.samples().iter().all(|sample| (0.0..=grid.largest()).contains(sample)));
            // Between samples rounding may lead out of their range by a last place.
            let most = f64::from(grid.largest()) * (1.0 + f64::EPSILON);
            for share in [[0.0; 3], [0.3, 0.5, 0.7], [1.0; 3]] {
                assert!((0.0..=most).contains(&grid.density(share)));
            }
        }
        Err(SceneError::Invalid(invalid)) => {
            assert!(!invalid.problem.is_empty() && invalid.field.is_some(), "{invalid:?}");
        }
        Err(error) => panic!("{error}: the scene's text is given"),
    }
});
