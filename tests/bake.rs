//! Packs of scenes: the device's tables against the CPU's, and the command.

mod common;
mod json_schema;
#[path = "../lut/tests/small_air/mod.rs"]
mod small_air;

use common::with_renderer;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use small_air::SMALL;
use welkin::bake::{air_of, bake_on_device, describe};
use welkin::scene::Scene;
use welkin_lut::bake::Baked;
use welkin_lut::sky_tables::TableSet;
use welkin_lut::{PhaseFunction, Table};

fn scene(name: &str) -> Scene {
    Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap()
}

/// Irradiance of moonlight, and light per metre that makes a millionth of the sun's over a hundred kilometres: ln.
const DARK: f64 = -14.0;
const DARK_PER_M: f64 = -25.0;

/// Differences of logarithms, ascending, where either is above a limit: under suns at the zenith, the last of `suns` columns,
/// or elsewhere.
fn differences_above(limit: f64, suns: u32, at_zenith: bool, [one, other]: [&Table; 2]) -> Vec<f64> {
    assert_eq!(one.size(), other.size());
    let pairs = one.texels().iter().zip(other.texels());
    let chosen = pairs.enumerate().filter(|(i, _)| (*i as u32 % suns == suns - 1) == at_zenith);
    let values = chosen.flat_map(|(_, (a, b))| a.iter().zip(b));
    let mut all: Vec<_> = values.filter(|(a, b)| a.max(**b) > limit).map(|(a, b)| (a - b).abs()).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// By how much tables differ: optical depths, relative to 1 or to themselves; then for suns off the zenith and at it irradiance,
/// relative, and scattered light, relative, at the 95th percentile and at most.
fn differences(one: &TableSet, other: &TableSet) -> [f64; 7] {
    let pairs = one.transmittance.texels().iter().flatten().zip(other.transmittance.texels().iter().flatten());
    let depth = pairs.map(|(a, b)| (a - b).abs() / b.max(1.0)).fold(0.0, f64::max);
    let under = |at_zenith: bool| {
        let both = [&one.irradiance, &other.irradiance];
        let irradiance = differences_above(DARK, SMALL.source_size[0], at_zenith, both);
        let both = [&one.scattering, &other.scattering];
        let light = differences_above(DARK_PER_M, SMALL.scattering.suns, at_zenith, both);
        [irradiance[irradiance.len() - 1], light[light.len() * 95 / 100], light[light.len() - 1]]
    };
    let ([a, b, c], [d, e, f]) = (under(false), under(true));
    [depth, a, b, c, d, e, f]
}

/// What packs state (docs/tables.md). Scattered light differs most along rays that graze the ground, in the first rows, where an
/// f32 rounds the sine of their small angle below the horizon. Under a sun at the zenith the azimuth between it and a ray is
/// a quotient of roundings in f32, and so few directions as here are seen to differ by it.
const BOUNDS: [f64; 7] = [1e-5, 1e-5, 5e-5, 0.02, 2e-3, 5e-3, 0.04];

fn assert_device_and_processor_bake_the_same(scene: &Scene) {
    with_renderer(|renderer| {
        let air = air_of(scene).unwrap();
        let on_device = bake_on_device(renderer, scene, &air, SMALL).unwrap();
        let on_cpu = Baked::new(&air, SMALL, &|_| {});
        let within = |other: &Baked| {
            let found = differences(on_device.tables().set(), other.tables().set());
            println!("{found:?}");
            found.iter().zip(BOUNDS).all(|(found, bound)| *found <= bound)
        };
        assert!(within(&on_cpu));
        // Negative control: one per cent more of the first scatterer.
        let mut denser = scene.clone();
        denser.medium.constituents[0].scattering_per_m.iter_mut().for_each(|b| *b *= 1.01);
        let air = air_of(&denser).unwrap();
        assert!(!within(&Baked::new(&air, SMALL, &|_| {})));
    });
}

#[test]
fn device_and_processor_bake_the_same_tables() {
    assert_device_and_processor_bake_the_same(&scene("noon.toml"));
}

#[test]
fn device_and_processor_bake_the_same_tables_of_haze_that_throws_light_back() {
    let mut scene = scene("noon.toml");
    let haze = scene.medium.constituents.iter_mut().find(|constituent| constituent.phase.mean_cosine() > 0.1).unwrap();
    haze.phase = PhaseFunction::HenyeyGreenstein { g: -0.9 };
    assert_device_and_processor_bake_the_same(&scene);
}

#[test]
fn a_pack_says_what_of_the_scene_it_leaves_out() {
    let mountains = scene("mountains.toml");
    let air = air_of(&mountains).unwrap();
    let description = describe(&mountains, &air, "cpu");
    assert!(description.left_out.iter().any(|what| what.starts_with("terrain")), "{description:?}");
    let noon = scene("noon.toml");
    let description = describe(&noon, &air_of(&noon).unwrap(), "cpu");
    assert!(description.left_out.is_empty(), "{description:?}");
    assert_eq!(description.scatterers.len(), air_of(&noon).unwrap().scatterers().len());
}

fn welkin(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.env("WELKIN_VALIDATION", "1").env("WELKIN_CACHE", "");
    command.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

#[test]
fn the_command_bakes_a_pack_verifies_it_and_refuses_it_when_a_byte_has_changed() {
    let folder = tempfile::tempdir().unwrap();
    let noon = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/noon.toml");
    let output = welkin(folder.path(), &format!("bake {noon} --out pack --quality low --format ktx2,exr"));
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("scattering 200 x 24 x"), "{}", said(&output));
    for file in ["scattering.f16.ktx2", "scattering.f16.exr", "shaders/hlsl/sky.hlsl", "shaders/spirv/sky_probe.spv"] {
        assert!(folder.path().join("pack").join(file).is_file(), "no {file}");
    }
    for (file, document) in [("manifest.json", "pack"), ("probes.json", "probes")] {
        let schema =
            fs::read_to_string(format!("{}/schemas/{document}.schema.json", env!("CARGO_MANIFEST_DIR"))).unwrap();
        let printed = welkin(folder.path(), &format!("schema {document}")).stdout;
        assert!(printed == schema.as_bytes(), "make schemas/{document}.schema.json anew: CONTRIBUTING.md says how");
        let schema: serde_json::Value = serde_json::from_str(&schema).unwrap();
        let mut value = serde_json::from_slice(&fs::read(folder.path().join("pack").join(file)).unwrap()).unwrap();
        assert_eq!(json_schema::error(&schema, &schema, &value), None, "{file}");
        // Negative control.
        value.as_object_mut().unwrap().insert("surprise".to_owned(), true.into());
        assert!(json_schema::error(&schema, &schema, &value).is_some(), "{file}");
    }
    let output = welkin(folder.path(), "bake --verify pack");
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("8 files of tables"), "{}", said(&output));
    let table = folder.path().join("pack/irradiance.f16.exr");
    let mut bytes = fs::read(&table).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&table, bytes).unwrap();
    let output = welkin(folder.path(), "bake --verify pack");
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("irradiance.f16.exr' was changed"), "{}", said(&output));
    for (arguments, words) in [
        ("bake --verify nothing", "manifest.json"),
        ("bake scene.toml", "--out"),
        ("bake --verify pack --quality low", "cannot be used with"),
        ("bake scene.toml --out pack --format png", "exr, ktx2, dds, raw"),
        ("bake scene.toml --out pack --backend cpu --device 0", "--device"),
    ] {
        let output = welkin(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", said(&output));
        assert!(said(&output).contains(words), "{arguments}: {}", said(&output));
    }
}
