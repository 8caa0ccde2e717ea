//! `welkin shaders`: files for other engines, in every language.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn welkin(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn names(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn every_language_has_its_functions_and_passes_and_says_how_they_are_bound() {
    let folder = tempfile::tempdir().unwrap();
    let endings =
        [("wgsl", "wgsl", "wgsl"), ("glsl", "glsl", "comp"), ("hlsl", "hlsl", "hlsl"), ("msl", "metal", "metal")];
    for (language, functions, pass) in endings {
        let output = welkin(folder.path(), &format!("shaders --language {language} --out {language}"));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let found = names(&folder.path().join(language));
        let stems = ["sky_probe", "bake_optical_depth", "bake_first_source", "bake_higher_source"];
        let mut expected: BTreeSet<String> = stems.iter().map(|stem| format!("{stem}.{pass}")).collect();
        expected.extend([format!("bake_scattering.{pass}"), format!("sky.{functions}"), "interface.json".to_owned()]);
        assert_eq!(found, expected, "{language}");
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), expected.len());
    }
    let text = fs::read_to_string(folder.path().join("hlsl/interface.json")).unwrap();
    let interface: serde_json::Value = serde_json::from_str(&text).unwrap();
    let probe = &interface["entry_points"][0];
    assert_eq!((&probe["file"], &probe["name"]), (&"sky_probe.hlsl".into(), &"main".into()));
    let bound: Vec<_> = probe["bindings"].as_array().unwrap().iter().map(|b| b["name"].as_str().unwrap()).collect();
    let tables = ["transmittance_table", "irradiance_table", "scattering_table"];
    assert_eq!(bound, [["sky", "table_sampler"].as_slice(), &tables, &["probes", "answers"]].concat());
    let radius = &probe["bindings"][0]["members"][1];
    assert_eq!((&radius["name"], &radius["offset_bytes"]), (&"radius_m".into(), &12.into()));
}

#[test]
fn passes_that_bake_are_made_for_the_air_of_the_scene_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/mars.toml");
    for arguments in ["--out earth".to_owned(), format!("--out mars --scene {scene} --quality low")] {
        let output = welkin(folder.path(), &format!("shaders --language wgsl {arguments}"));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let pass = |name: &str| fs::read_to_string(folder.path().join(name).join("bake_scattering.wgsl")).unwrap();
    assert!(pass("earth").contains("NODE_COUNT: u32 = 12u") && pass("mars").contains("NODE_COUNT: u32 = 10u"));
    let said = fs::read_to_string(folder.path().join("mars/interface.json")).unwrap();
    assert!(said.contains("dust") && said.contains("10 nodes"), "{said}");
    // What reads a pack is the same for every air.
    let functions = |name: &str| fs::read(folder.path().join(name).join("sky.wgsl")).unwrap();
    assert!(functions("earth") == functions("mars"));
}

#[test]
fn a_language_that_is_not_there_is_refused_with_those_that_are() {
    let folder = tempfile::tempdir().unwrap();
    let output = welkin(folder.path(), "shaders --language cg --out out");
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("wgsl, glsl, hlsl, msl, spirv"), "{said}");
    assert!(names(folder.path()).is_empty());
}
