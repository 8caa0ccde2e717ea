//! Which treatment of multiply scattered light a scene gets, and that one treatment leaves nothing behind for another.

mod common;

use std::path::Path;

use welkin::frame::Frame;
use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Decision, MultipleScattering, Outputs, Plan, Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

const HARMONICS: [&str; 2] = ["first_order", "higher_order"];
const SOURCE_FUNCTION: [&str; 2] = ["first_source", "higher_source"];
const ISOTROPIC_SERIES: [&str; 1] = ["isotropic_series"];

fn scene(file: &str) -> Scene {
    let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(file)).unwrap();
    (scene.camera.width, scene.camera.height) = (33, 21);
    scene
}

fn plan(scene: &Scene, settings: Settings) -> Plan {
    Renderer::plan(scene, settings, Outputs::default()).unwrap()
}

/// The passes of multiply scattered light that a plan runs.
fn treatment(plan: &Plan) -> Vec<&'static str> {
    let all = [&HARMONICS[..], &SOURCE_FUNCTION, &ISOTROPIC_SERIES].concat();
    let runs = |name: &&str| plan.decision(name) == Some(Decision::Run);
    all.into_iter().filter(runs).collect()
}

fn reason<'a>(plan: &'a Plan, name: &str) -> &'a str {
    &plan.passes.iter().find(|pass| pass.name == name).unwrap().reason
}

#[test]
fn clear_air_gets_what_its_twilight_needs_and_haze_gets_the_source_function() {
    for quality in Quality::ALL {
        let clear = plan(&scene("reference/earth-b-0.3.toml"), Settings::of(quality));
        if quality <= Quality::Medium {
            assert_eq!(treatment(&clear), HARMONICS, "{quality}");
            assert!(reason(&clear, "first_source").contains("spherical harmonics"));
        } else {
            assert_eq!(treatment(&clear), SOURCE_FUNCTION, "{quality}");
            assert!(reason(&clear, "first_source").contains("planet's shadow"));
        }
        let dusty = plan(&scene("mars.toml"), Settings::of(quality));
        assert_eq!(treatment(&dusty), SOURCE_FUNCTION, "{quality}");
        assert!(reason(&dusty, "first_source").contains("haze scatters forward"));
        assert!(reason(&dusty, "first_order").contains("source function"));
    }
}

#[test]
fn every_table_that_is_made_says_how_large_it_is_at_every_quality() {
    for quality in Quality::ALL {
        for name in ["reference/earth-b-0.3.toml", "mars.toml", "moonlight.toml", "mountains.toml"] {
            let plan = plan(&scene(name), Settings::of(quality));
            let made = plan.passes.iter().filter(|pass| pass.decision == Decision::Run);
            let tables: Vec<_> = made.map(|pass| (pass.name, pass.bytes)).collect();
            assert!(tables.len() >= 5, "{name} at {quality}: {tables:?}");
            assert!(tables.iter().all(|(_, bytes)| *bytes > 0), "{name} at {quality}: {tables:?}");
            let skipped = plan.passes.iter().filter(|pass| pass.decision == Decision::Skip);
            assert!(skipped.into_iter().all(|pass| pass.bytes == 0), "{name} at {quality}");
        }
    }
    // Of the same scene finer tables are larger ones.
    let bytes = |quality| plan(&scene("mars.toml"), Settings::of(quality)).passes.iter().map(|pass| pass.bytes).sum();
    let all: Vec<u64> = Quality::ALL.map(bytes).to_vec();
    assert!(all.is_sorted_by(|a, b| a < b), "{all:?}");
}

#[test]
fn the_rule_follows_the_haze_and_not_the_molecules() {
    // Views into the planet's shadow may be off by any amount.
    let settings = Settings { shadow_limit: 1.0, ..Settings::of(Quality::High) };
    let mut scene = scene("reference/earth-b-0.3.toml");
    assert_eq!(treatment(&plan(&scene, settings)), HARMONICS);
    // However dense, air whose phase function ends with degree 2 loses nothing.
    scene.medium.constituents[0].scattering_per_m.iter_mut().for_each(|b| *b *= 100.0);
    let dense = plan(&scene, settings);
    assert_eq!(treatment(&dense), HARMONICS);
    assert!(reason(&dense, "first_order").contains("0.00 % (limit 0.75 %)"), "{}", reason(&dense, "first_order"));
    scene.medium.constituents[0].scattering_per_m.iter_mut().for_each(|b| *b /= 100.0);
    scene.medium.constituents[1].scattering_per_m.iter_mut().for_each(|b| *b *= 20.0);
    assert_eq!(treatment(&plan(&scene, settings)), SOURCE_FUNCTION);
}

#[test]
fn a_treatment_that_is_asked_for_by_name_is_the_one_that_runs() {
    for (multiple_scattering, passes) in [
        (MultipleScattering::Harmonics, &HARMONICS[..]),
        (MultipleScattering::SourceFunction, &SOURCE_FUNCTION),
        (MultipleScattering::IsotropicSeries, &ISOTROPIC_SERIES),
    ] {
        let plan = plan(&scene("noon.toml"), Settings { multiple_scattering, ..Settings::of(Quality::Low) });
        assert_eq!(treatment(&plan), passes);
        assert!(reason(&plan, passes[0]).contains("by name"));
        assert_eq!(multiple_scattering.name().parse(), Ok(multiple_scattering));
    }
    assert!("octaves".parse::<MultipleScattering>().unwrap_err().to_string().contains("isotropic-series"));
}

#[test]
fn one_treatment_after_another_gives_what_each_gives_alone() {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let noon = scene("noon.toml");
    let render = |renderer: &mut Renderer, multiple_scattering: MultipleScattering| -> Frame {
        let settings = Settings { multiple_scattering, ..Settings::of(Quality::Low) };
        renderer.render(&noon, settings, Outputs { capture: true, picture: false }).unwrap().frame
    };
    let named = &MultipleScattering::ALL[1..];
    let alone: Vec<Frame> = named.iter().map(|&m| render(&mut Renderer::new(&request).unwrap(), m)).collect();
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    for index in [0, 1, 2, 1, 0, 2, 0] {
        assert_eq!(render(&mut renderer, named[index]), alone[index], "{}", named[index]);
    }
    // Negative control: the treatments differ.
    assert!(alone[0] != alone[1] && alone[1] != alone[2] && alone[0] != alone[2]);
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
}
