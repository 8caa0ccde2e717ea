//! Scene files: what ships is valid, and what is wrong is refused with its place, its value and what is allowed.

mod json_schema;

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use welkin::scene::{InvalidField, Light, Scene, SceneError};
use welkin_lut::{DensityProfile, PhaseFunction};

const VALID: &str = r#"preset = "earth"

[planet]
ground_albedo = 0.3

[[medium]]
name = "haze"
scattering_per_m = [1e-5, 2e-5, 3e-5]
profile = { exponential = { scale_height_m = 1200 } }
phase = { henyey_greenstein = { g = 0.8 } }

[[medium]]
name = "layer"
absorption_per_m = 1e-6
profile = { layer = { bottom_m = 100, top_m = 200 } }

[sun]
elevation_deg = 30
azimuth_deg = 180

[camera]
altitude_m = 2
elevation_deg = 10
azimuth_deg = 0
width = 64
height = 32
"#;

fn parse(text: &str) -> Result<Scene, SceneError> {
    Scene::parse(text, Path::new("bad.toml"))
}

/// The error of the valid file with one piece of its text replaced.
fn refusal(from: &str, to: &str) -> InvalidField {
    assert!(VALID.contains(from), "'{from}' is not in the valid file");
    match parse(&VALID.replacen(from, to, 1)) {
        Err(SceneError::Invalid(invalid)) => *invalid,
        other => panic!("'{to}' gave {other:?}"),
    }
}

fn shipped_scenes() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = [root.clone(), root.join("reference")].map(|folder| folder.read_dir().unwrap());
    let paths = files.into_iter().flatten().map(|entry| entry.unwrap().path());
    let scenes: Vec<_> = paths.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    assert!(scenes.len() >= 10, "found only {scenes:?}");
    scenes
}

fn json_of_toml(value: toml::Value) -> serde_json::Value {
    match value {
        toml::Value::Datetime(date_time) => date_time.to_string().into(),
        toml::Value::Array(array) => array.into_iter().map(json_of_toml).collect(),
        toml::Value::Table(table) => table.into_iter().map(|(key, value)| (key, json_of_toml(value))).collect(),
        other => serde_json::to_value(other).unwrap(),
    }
}

#[test]
fn the_valid_file_of_these_tests_is_valid() {
    let scene = parse(VALID).unwrap();
    assert_eq!(scene.name, "bad");
    assert_eq!(scene.medium.constituents.len(), 2);
    assert_eq!(scene.planet.ground_albedo, [0.3; 3]);
    assert_eq!((scene.camera.width, scene.camera.height), (64, 32));
}

/// Replaced text, its replacement, the line, the field, what the message says of the value, what it says is allowed.
const REFUSALS: [(&str, &str, usize, &str, &str, &str); 23] = [
    ("ground_albedo", "ground_albdo", 4, "planet.ground_albdo", "unknown field `ground_albdo`", "`ground_albedo`"),
    ("ground_albedo = 0.3", "ground_albedo = 1.5", 4, "planet.ground_albedo", "`1.5`", "a number from 0 to 1"),
    ("= 0.3", "= [0.3, nan, 0.3]", 4, "planet.ground_albedo[1]", "`NaN`", "a number from 0 to 1"),
    ("= 0.3", "= [0.3, 0.3]", 4, "planet.ground_albedo", "invalid length 2", "[r, g, b]"),
    ("ground_albedo = 0.3", "radius_m = 0", 4, "planet.radius_m", "`0`", "a number above 0 and up to 1e10"),
    ("ground_albedo = 0.3", "atmosphere_height_m = -1.0", 4, "planet.atmosphere_height_m", "`-1.0`", "above 0"),
    ("altitude_m = 2", "altitude_m = nan", 22, "camera.altitude_m", "`NaN`", "a number from -1e10 to 1e10"),
    ("altitude_m = 2", "altitude_m = inf", 22, "camera.altitude_m", "`inf`", "a number from -1e10 to 1e10"),
    ("altitude_m = 2", "altitude_m = -7e6", 22, "camera.altitude_m", "`-7000000`", "above -6371009"),
    ("altitude_m = 2", "altitude_m = \"2 m\"", 22, "camera.altitude_m", "string \"2 m\"", "a number from"),
    ("elevation_deg = 10", "elevation_deg = 91", 23, "camera.elevation_deg", "`91`", "a number from -90 to 90"),
    ("m = 1200", "m = -8000", 9, "medium[0].profile.exponential.scale_height_m", "`-8000`", "a number above 0"),
    ("g = 0.8", "g = 1", 10, "medium[0].phase.henyey_greenstein.g", "`1`", "a number above -1 and below 1"),
    ("g = 0.8", "g = nan", 10, "medium[0].phase.henyey_greenstein.g", "`NaN`", "above -1 and below 1"),
    ("top_m = 200", "top_m = 50", 15, "medium[1].profile.layer.top_m", "`50`", "above bottom_m, 100"),
    ("phase = { henyey_greenstein = { g = 0.8 } }", "", 6, "medium[0]", "missing field `phase`", "required"),
    ("{ henyey_greenstein = { g = 0.8 } }", "\"mie\"", 10, "medium[0].phase", "`mie`", "`henyey_greenstein`"),
    ("name = \"layer\"", "name = \"haze\"", 13, "medium[1].name", "`haze`", "no other constituent"),
    ("width = 64", "width = 0", 25, "camera.width", "`0`", "a whole number of pixels from 1 to 16384"),
    ("height = 32", "height = 100000", 26, "camera.height", "`100000`", "a whole number of pixels from 1 to 16384"),
    ("width = 64", "width = 64.5", 25, "camera.width", "`64.5`", "a whole number of pixels"),
    ("azimuth_deg = 180", "", 17, "sun", "missing fields", "both elevation_deg and azimuth_deg, or [sun.when]"),
    ("\"earth\"", "\"venus\"", 1, "preset", "`venus`", "`earth`, `hillaire2020`, `mars`"),
];

#[test]
fn a_wrong_field_is_refused_with_its_place_its_value_and_what_is_allowed() {
    for (from, to, line, field, value, allowed) in REFUSALS {
        let refusal = refusal(from, to);
        assert_eq!(refusal.place.line, line, "{refusal}");
        assert_eq!(refusal.field.as_deref(), Some(field), "{refusal}");
        assert!(refusal.problem.contains(value), "{refusal} does not name {value}");
        assert!(refusal.problem.contains(allowed), "{refusal} does not say {allowed}");
        assert!(refusal.to_string().starts_with(&format!("bad.toml:{line}:")), "{refusal}");
    }
}

#[test]
fn a_missing_preset_and_broken_toml_are_refused_with_a_line() {
    let missing = refusal("preset = \"earth\"", "");
    assert!(missing.problem.contains("missing field `preset`"), "{missing}");
    let broken = refusal("[camera]", "[camera");
    assert_eq!((broken.place.line, broken.field.as_deref()), (21, None), "{broken}");
}

#[test]
fn a_missing_file_is_named() {
    let error = Scene::read(Path::new("no/such.toml")).unwrap_err();
    assert_eq!(error.to_string(), "cannot read the scene 'no/such.toml'");
}

#[test]
fn the_sun_stands_either_at_angles_or_at_a_time_on_earth() {
    let when = "[sun.when]\ndate_time = 2026-06-21T12:00:00Z\nlatitude_deg = 48\nlongitude_deg = 16\n";
    let twice = VALID.replacen("[camera]", &format!("{when}[camera]"), 1);
    let error = parse(&twice).unwrap_err().to_string();
    assert!(error.contains("bad.toml:21:") && error.contains("said twice"), "{error}");

    let timed = twice.replacen("elevation_deg = 30\nazimuth_deg = 180\n", "", 1);
    let scene = parse(&timed).unwrap();
    let Light::Directional(sun) = &scene.lights[0] else { panic!("the first light is no sun") };
    assert!(sun.direction.elevation_rad > 1.0, "{:?}", sun.direction);

    let local = parse(&timed.replacen("12:00:00Z", "12:00:00", 1)).unwrap_err().to_string();
    assert!(local.contains("sun.when.date_time") && local.contains("an offset from UTC"), "{local}");
    let mars = parse(&timed.replacen("earth", "mars", 1)).unwrap_err().to_string();
    assert!(mars.contains("sun.when") && mars.contains("preset `mars`"), "{mars}");
}

const PRESET_AND_SUN: &str =
    "[sun]\nelevation_deg = 30\nazimuth_deg = 0\n[camera]\naltitude_m = 2\nelevation_deg = 0\nazimuth_deg = 0\n";

#[test]
fn a_preset_can_be_changed_field_by_field() {
    let of = |changes: &str| parse(&format!("preset = \"hillaire2020\"\n{changes}\n{PRESET_AND_SUN}"));
    let plain = of("").unwrap().medium;
    let changed = of("[medium.mie]\ndensity_factor = 5\nphase.henyey_greenstein.g = 0.7").unwrap().medium;
    assert_eq!(changed.constituents[0], plain.constituents[0]);
    assert_eq!(changed.constituents[1].scattering_per_m, plain.constituents[1].scattering_per_m.map(|b| b * 5.0));
    assert_eq!(changed.constituents[1].phase, PhaseFunction::HenyeyGreenstein { g: 0.7 });
    let without = of("[medium.ozone]\ndensity_factor = 0").unwrap().medium;
    assert_eq!(without.constituents, plain.constituents[..2]);
    let smoke = "[medium.smoke]\nabsorption_per_m = 1e-5\nprofile.layer = { bottom_m = 1000, top_m = 2000 }";
    let with = of(smoke).unwrap().medium;
    assert_eq!(with.constituents[3].profile, DensityProfile::Layer { bottom_m: 1000.0, top_m: 2000.0 });
    let misspelt = of("[medium.ozon]\ndensity_factor = 0").unwrap_err().to_string();
    assert!(misspelt.contains("it has `rayleigh`, `mie`, `ozone`"), "{misspelt}");
}

#[test]
fn every_phase_function_has_its_words() {
    let phases = [
        ("\"isotropic\"", PhaseFunction::Isotropic),
        ("\"rayleigh\"", PhaseFunction::Rayleigh),
        (
            "{ double_henyey_greenstein = { weight = 0.9, g1 = 0.85, g2 = -0.2 } }",
            PhaseFunction::DoubleHenyeyGreenstein { weight: 0.9, g1: 0.85, g2: -0.2 },
        ),
        ("{ schlick = { k = 0.6 } }", PhaseFunction::Schlick { k: 0.6 }),
        ("{ cornette_shanks = { g = 0.7 } }", PhaseFunction::CornetteShanks { g: 0.7 }),
        ("{ draine = { g = 0.5, alpha = 1 } }", PhaseFunction::Draine { g: 0.5, alpha: 1.0 }),
        (
            "{ henyey_greenstein_draine = { droplet_diameter_um = 10 } }",
            PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 10.0 },
        ),
    ];
    for (text, phase) in phases {
        let scene = parse(&VALID.replacen("{ henyey_greenstein = { g = 0.8 } }", text, 1)).unwrap();
        assert_eq!(scene.medium.constituents[0].phase, phase);
    }
}

#[test]
fn a_phase_table_is_read_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let text = VALID.replacen("{ henyey_greenstein = { g = 0.8 } }", "{ table = { file = \"mie.csv\" } }", 1);
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, text).unwrap();
    let missing = Scene::read(&scene).unwrap_err().to_string();
    assert!(missing.contains(":10:") && missing.contains("mie.csv"), "{missing}");
    std::fs::write(folder.path().join("mie.csv"), "theta_deg,phase_per_sr\n0,1\n90,1\n180,-1\n").unwrap();
    let negative = Scene::read(&scene).unwrap_err().to_string();
    assert!(negative.contains("line 4"), "{negative}");
    std::fs::write(folder.path().join("mie.csv"), "theta_deg,phase_per_sr\n0,1\n90,1\n180,1\n").unwrap();
    let PhaseFunction::Tabulated(table) = &Scene::read(&scene).unwrap().medium.constituents[0].phase else {
        panic!("not a table")
    };
    assert!((table.value(0.3) - 0.25 / std::f64::consts::PI).abs() < 1e-12);
}

#[test]
fn lights_besides_the_sun_are_read_in_order() {
    let lights = "[[light.directional]]\nname = \"moon\"\nelevation_deg = 20\nazimuth_deg = 90\nirradiance = 1e-6\n\
                  [[light.point]]\nname = \"lamp\"\nposition_m = [1, 2, 3]\nintensity = 10\n\
                  [light.environment]\nradiance = 1e-9\n";
    let scene = parse(&format!("{VALID}{lights}")).unwrap();
    assert!(matches!(&scene.lights[..], [
        Light::Directional(sun), Light::Directional(moon), Light::Point(lamp), Light::Environment(_),
    ] if sun.name == "sun" && moon.name == "moon" && lamp.position_m.z == 3.0));
    let twice = parse(&format!("{VALID}{lights}").replacen("\"lamp\"", "\"moon\"", 1)).unwrap_err().to_string();
    assert!(twice.contains("light.point[0].name") && twice.contains("`moon`"), "{twice}");
}

/// What the schema says against a scene file, nothing where it is valid.
fn schema_error(text: &str) -> Option<String> {
    let schema = welkin::scene::schema();
    json_schema::error(&schema, &schema, &json_of_toml(toml::from_str(text).unwrap()))
}

#[test]
fn every_shipped_scene_is_valid_to_the_reader_and_to_the_schema() {
    for path in shipped_scenes() {
        Scene::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let error = schema_error(&std::fs::read_to_string(&path).unwrap());
        assert_eq!(error, None, "{}", path.display());
    }
}

#[test]
fn the_schema_refuses_what_the_reader_refuses_in_a_single_field() {
    assert_eq!(schema_error(VALID), None);
    // What two fields say together is beyond a schema, and JSON has no NaN.
    let beyond = ["nan", "inf", "top_m = 50", "name = \"haze\"", "-7e6"];
    let single = REFUSALS.iter().filter(|(_, to, ..)| !to.is_empty() && !beyond.iter().any(|text| to.contains(text)));
    for (from, to, ..) in single {
        assert!(schema_error(&VALID.replacen(from, to, 1)).is_some(), "the schema lets '{to}' pass");
    }
}

#[test]
fn the_schema_in_the_repository_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/scene.schema.json");
    let copy: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    assert_eq!(copy, welkin::scene::schema(), "write it anew: welkin schema > schemas/scene.schema.json");
}

/// The names of all fields and choices that a schema knows.
fn names(schema: &serde_json::Value, found: &mut Vec<String>) {
    if let Some(properties) = schema.get("properties").and_then(serde_json::Value::as_object) {
        found.extend(properties.keys().cloned());
    }
    found.extend(schema.get("const").and_then(|name| name.as_str()).map(str::to_owned));
    match schema {
        serde_json::Value::Object(object) => object.values().for_each(|value| names(value, found)),
        serde_json::Value::Array(array) => array.iter().for_each(|value| names(value, found)),
        _ => {}
    }
}

#[test]
fn the_page_on_scene_files_names_every_field() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene-format.md")).unwrap();
    let mut fields = Vec::new();
    names(&welkin::scene::schema(), &mut fields);
    assert!(fields.len() > 40, "found only {fields:?}");
    let words: Vec<&str> = page.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-')).collect();
    let missing: Vec<_> = fields.iter().filter(|field| !words.contains(&field.as_str())).collect();
    assert!(missing.is_empty(), "docs/scene-format.md does not name {missing:?}");
}

#[test]
fn every_example_on_the_page_on_scene_files_is_a_scene() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene-format.md")).unwrap();
    let examples: Vec<&str> = page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    let [smallest, additions @ ..] = &examples[..] else { panic!("there is no example") };
    parse(smallest).unwrap();
    assert!(additions.len() >= 2, "there are {} additions", additions.len());
    for addition in additions {
        parse(&format!("{smallest}{addition}")).unwrap();
    }
}

#[test]
fn the_reference_scenes_are_the_problem_of_the_reference_tables() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/reference");
    let engines = parse(&format!("preset = \"hillaire2020\"\n{PRESET_AND_SUN}")).unwrap();
    for (variant, mie_absorption) in [("a", 4.40e-6), ("b", 0.444e-6)] {
        for albedo in ["0", "0.3"] {
            let scene = Scene::read(&root.join(format!("earth-{variant}-{albedo}.toml"))).unwrap();
            let mut expected = engines.medium.clone();
            expected.constituents[1].absorption_per_m = [mie_absorption; 3];
            assert_eq!(scene.medium, expected);
            assert_eq!((scene.planet.radius_m, scene.planet.atmosphere_height_m), (6_360_000.0, 100_000.0));
            assert_eq!(scene.planet.ground_albedo, [albedo.parse::<f64>().unwrap(); 3]);
            let [Light::Directional(sun)] = &scene.lights[..] else { panic!("more than the sun shines") };
            assert_eq!((sun.irradiance, sun.angular_radius_rad), ([1.0; 3], 0.0));
        }
    }
}

#[test]
fn hillaire_2020_has_the_numbers_of_the_engines() {
    let scene = parse(&format!("preset = \"hillaire2020\"\n{PRESET_AND_SUN}")).unwrap();
    let [rayleigh, mie, ozone] = &scene.medium.constituents[..] else { panic!("not three constituents") };
    assert_eq!(rayleigh.scattering_per_m, [5.802e-6, 13.558e-6, 33.1e-6]);
    assert_eq!(rayleigh.profile, DensityProfile::Exponential { scale_height_m: 8000.0 });
    assert!(mie.extinction_per_m().iter().all(|c| (c - 4.44e-6).abs() < 1e-20));
    assert_eq!(mie.phase, PhaseFunction::HenyeyGreenstein { g: 0.8 });
    assert_eq!(ozone.absorption_per_m, [0.650e-6, 1.881e-6, 0.085e-6]);
    let [Light::Directional(sun)] = &scene.lights[..] else { panic!("more than the sun shines") };
    assert_eq!((sun.irradiance, sun.angular_radius_rad), ([1.474, 1.8504, 1.91198], 0.004675));
}

proptest! {
    /// Any replacement of a piece of a valid file ends in a scene or in an error with a place inside the file.
    #[test]
    fn no_text_makes_the_reader_panic(start in 0..VALID.len(), length in 0..40_usize, piece in "[\\PC\n]{0,30}") {
        let end = (start + length).min(VALID.len());
        let text = format!("{}{piece}{}", &VALID[..start], &VALID[end..]);
        match parse(&text) {
            Ok(scene) => { prop_assert!(scene.medium.validate().is_ok() && scene.planet.validate().is_ok()) }
            Err(SceneError::Invalid(invalid)) => prop_assert!(invalid.place.line <= text.lines().count().max(1) + 1),
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        }
    }

    /// What a file says in degrees and metres is what the scene holds.
    #[test]
    fn a_valid_file_keeps_its_numbers(
        elevation in -90.0..=90.0_f64, azimuth in -360.0..=360.0_f64, altitude in -6e6..1e9_f64,
        g in -0.999..0.999_f64, scale_height in 1e-3..1e9_f64, scattering in prop::array::uniform3(0.0..1e3_f64),
    ) {
        let text = VALID
            .replacen("elevation_deg = 30", &format!("elevation_deg = {elevation:?}"), 1)
            .replacen("azimuth_deg = 180", &format!("azimuth_deg = {azimuth:?}"), 1)
            .replacen("altitude_m = 2", &format!("altitude_m = {altitude:?}"), 1)
            .replacen("g = 0.8", &format!("g = {g:?}"), 1)
            .replacen("scale_height_m = 1200", &format!("scale_height_m = {scale_height:?}"), 1)
            .replacen("[1e-5, 2e-5, 3e-5]", &format!("{scattering:?}"), 1);
        let scene = parse(&text).unwrap();
        let Light::Directional(sun) = &scene.lights[0] else { panic!("the first light is no sun") };
        let haze = &scene.medium.constituents[0];
        prop_assert_eq!(sun.direction.elevation_rad, elevation.to_radians());
        prop_assert_eq!(sun.direction.azimuth_rad, azimuth.to_radians());
        prop_assert_eq!(scene.camera.altitude_m, altitude);
        prop_assert_eq!(&haze.phase, &PhaseFunction::HenyeyGreenstein { g });
        prop_assert_eq!(haze.profile, DensityProfile::Exponential { scale_height_m: scale_height });
        prop_assert_eq!(haze.scattering_per_m, scattering);
    }
}

#[test]
fn airglow_is_switched_on_by_its_name_and_only_over_the_earth() {
    let of = |preset: &str, changes: &str| parse(&format!("preset = \"{preset}\"\n{changes}\n{PRESET_AND_SUN}"));
    assert!(!of("earth", "").unwrap().medium.constituents.iter().any(|constituent| constituent.emits()));
    let glow = |changes: &str| of("hillaire2020", changes).unwrap().medium.constituents.pop().unwrap();
    let (plain, twice) = (glow("[medium.airglow]"), glow("[medium.airglow]\ndensity_factor = 2"));
    assert!(plain.name == "airglow" && plain.emits() && !plain.scatters());
    assert_eq!(twice.emission_per_m, plain.emission_per_m.map(|emission| 2.0 * emission));
    let mars = of("mars", "[medium.airglow]").unwrap_err().to_string();
    assert!(mars.contains("medium.airglow") && mars.contains("missing field `profile`"), "{mars}");
}
