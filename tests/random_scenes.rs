//! Whatever a scene file says, it is refused with a reason or becomes a picture of sound numbers.
//!
//! A scene that does not is shrunk, printed and kept in `tests/regressions/`, whose files are all tried again.

mod common;
#[path = "hard_cases/laws.rs"]
#[allow(dead_code)]
mod laws;
mod scene_strategy;

use std::fs;
use std::path::Path;

use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use scene_strategy::trial::{Fate, fate, regressions, try_scenes};
use scene_strategy::values::with_other_numbers;
use welkin::gpu::DeviceRequest;
use welkin::renderer::Renderer;

/// Scene files that are read and planned.
const SCENES: u32 = 1000;
/// One in so many of those that can be planned is rendered: nearly all of the time is the compiling of their shaders.
const ONE_IN: usize = 20;

#[test]
fn every_random_scene_file_is_refused_with_a_reason_or_rendered_with_sound_numbers() {
    let _alone = common::alone();
    let renderer = Renderer::new(&DeviceRequest { poisons_memory: true, ..DeviceRequest::default() }).unwrap();
    let random = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let fates = try_scenes(renderer, SCENES, ONE_IN, random).unwrap_or_else(|words| panic!("{words}"));
    println!("{fates:?}");
    // The strategy means something: a good part of what it makes is refused, and a good part is not.
    let count = |fate| fates.get(&fate).copied().unwrap_or(0);
    let planned = count(Fate::Planned) + count(Fate::Rendered);
    assert!(count(Fate::Refused) > 100 && planned > 200 && count(Fate::Rendered) > 8, "{fates:?}");
}

/// Scenes whose numbers are changed, and how many of each are rendered: they need few shaders.
const WITH_OTHER_NUMBERS: [(&str, usize); 2] = [("noon", 600), ("moonlight", 400)];

#[test]
fn a_thousand_scenes_with_other_numbers_are_rendered_with_sound_numbers() {
    let _alone = common::alone();
    let mut renderer = Renderer::new(&DeviceRequest { poisons_memory: true, ..DeviceRequest::default() }).unwrap();
    let random = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut runner = TestRunner::new_with_rng(Config::default(), random);
    let schema = welkin::scene::schema();
    for (name, count) in WITH_OTHER_NUMBERS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
        let mut whole: toml::Table = fs::read_to_string(path).unwrap().parse().unwrap();
        let camera = whole["camera"].as_table_mut().unwrap();
        camera.extend(["width", "height"].map(|side| (side.to_owned(), toml::Value::Integer(3))));
        let (mut rendered, mut refused) = (0, 0);
        while rendered < count {
            let text = with_other_numbers(&schema, &whole, &mut runner).to_string();
            match fate(&mut renderer, &text, true).unwrap_or_else(|words| panic!("{words}\n{text}")) {
                Fate::Rendered => rendered += 1,
                _ => refused += 1,
            }
            assert!(refused < count, "nearly all of {name} are refused");
        }
    }
}

#[test]
fn what_once_failed_does_not_fail_again() {
    let _alone = common::alone();
    let mut renderer = Renderer::new(&DeviceRequest { poisons_memory: true, ..DeviceRequest::default() }).unwrap();
    let files = fs::read_dir(regressions()).unwrap().map(|entry| entry.unwrap().path());
    for file in files.filter(|file| file.extension().is_some_and(|ending| ending == "toml")) {
        let text = fs::read_to_string(&file).unwrap();
        fate(&mut renderer, &text, true).unwrap_or_else(|words| panic!("{}: {words}", file.display()));
    }
}
