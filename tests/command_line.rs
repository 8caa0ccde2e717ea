//! The program as scripts see it: exit codes, messages and files.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;
use welkin::frame::Frame;
use welkin::output::{AtomicFile, display, read_exr, write_exr};
use welkin::scene::Scene;

const SCENE: &str = "preset = \"hillaire2020\"\n[sun]\nelevation_deg = 30\nazimuth_deg = 0\nirradiance = 1\nangular_radius_deg = 0\n\
                     [camera]\naltitude_m = 500\nelevation_deg = 0\nazimuth_deg = 0\nwidth = 8\nheight = 4\n";
const RAYS: &str = "label,altitude_m,view_zenith_deg,view_azimuth_deg,sun_zenith_deg,sun_azimuth_deg\n\
                    up,500,30,0,60,0\nlow,500,80,90,85,10\n";

fn welkin(folder: &Path, arguments: &str) -> Output {
    welkin_with_cache(folder, arguments, Path::new(""))
}

/// Keeps compiled pipelines in a folder; an empty name keeps none.
fn welkin_with_cache(folder: &Path, arguments: &str, cache: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.env("WELKIN_VALIDATION", "1").env("WELKIN_CACHE", cache);
    command.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("the program ended by itself")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn folder_with(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Runs a probe on given files and expects a refusal that says all of `said` and leaves no file behind.
fn refused(scene: &str, rays: &str, arguments: &str, said: &[&str]) {
    let folder = folder_with(&[("scene.toml", scene), ("rays.csv", rays)]);
    let output = welkin(folder.path(), arguments);
    let message = stderr(&output);
    assert_eq!(code(&output), 2, "{message}");
    for words in said {
        assert!(message.contains(words), "'{message}' does not say '{words}'");
    }
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "something was left behind");
    assert!(output.stdout.is_empty());
}

const PROBE: &str = "probe scene.toml --rays rays.csv --out out.csv --backend reference --samples 32";

#[test]
fn a_bad_scene_is_refused_with_file_line_field_value_and_what_is_allowed() {
    let layer = "[medium.fog]\nabsorption_per_m = 1\nprofile.layer = { bottom_m = 20, top_m = 10 }\n";
    let cases = [
        (SCENE.replace("irradiance", "irradiant"), "scene.toml:5:1: sun.irradiant: unknown field", "`irradiance`"),
        (SCENE.replace("= 500", "= nan"), "scene.toml:8:14: camera.altitude_m: invalid value", "a number from"),
        (
            SCENE.replace("width = 8", "width = 0"),
            "scene.toml:11:9: camera.width: invalid value: integer `0`",
            "from 1 to 16384",
        ),
        (
            SCENE.replace("height = 4", "height = 100000"),
            "scene.toml:12:10: camera.height: invalid value: integer `100000`",
            "from 1 to 16384",
        ),
        (
            format!("{SCENE}[medium.mie]\nprofile.exponential.scale_height_m = -8000\n"),
            "scene.toml:14:38: medium.mie.profile.exponential.scale_height_m: invalid value: integer `-8000`",
            "above 0",
        ),
        (
            format!("{SCENE}[medium.mie]\nphase.henyey_greenstein.g = 1.0\n"),
            "scene.toml:14:29: medium.mie.phase.henyey_greenstein.g: invalid value: floating point `1.0`",
            "above -1 and below 1",
        ),
        (
            format!("{SCENE}{layer}"),
            "scene.toml:15:42: medium.fog.profile.layer.top_m: invalid value: `10`",
            "above bottom_m, 20",
        ),
        (SCENE.replace("preset", "# preset"), "scene.toml:1:1: missing field `preset`", "missing"),
    ];
    for (scene, place, allowed) in cases {
        refused(&scene, RAYS, PROBE, &[place, allowed]);
    }
}

#[test]
fn bad_rays_are_refused_with_line_column_value_and_what_is_allowed() {
    let cases = [
        (RAYS.replace("80,90", "nan,90"), "rays.csv:3: column 'view_zenith_deg' is 'nan'", "a number from 0 to 180"),
        (RAYS.replace(",60,", ",181,"), "rays.csv:2: column 'sun_zenith_deg' is '181'", "a number from 0 to 180"),
        (RAYS.replace("500,80", "-7e6,80"), "rays.csv:3: column 'altitude_m' is '-7e6'", "a number from -6359999"),
        (RAYS.replace("500,30", "high,30"), "rays.csv:2: column 'altitude_m' is 'high'", "a number from"),
        (RAYS.replace("sun_zenith_deg", "zenith"), "column 'sun_zenith_deg' is there 0 times", "label, altitude_m"),
        (RAYS.replace("label", "radiance_g"), "column 'radiance_g' is what the result adds", "rename"),
        (RAYS.replace("85,10", "85"), "line: 3", "6 fields"),
    ];
    for (rays, place, allowed) in cases {
        refused(SCENE, &rays, PROBE, &[place, allowed]);
    }
}

#[test]
fn missing_files_and_places_that_cannot_be_written_are_named() {
    refused(SCENE, RAYS, &PROBE.replace("scene.toml", "none.toml"), &["cannot read the scene 'none.toml'"]);
    refused(SCENE, RAYS, &PROBE.replace("rays.csv", "none.csv"), &["cannot read the rays 'none.csv'"]);
    refused(SCENE, RAYS, &PROBE.replace("out.csv", "no/out.csv"), &["cannot write 'no/out.csv'", "no folder 'no'"]);
    refused(SCENE, RAYS, &PROBE.replace("out.csv", "."), &["cannot write '.'", "not a regular file"]);
    refused(SCENE, RAYS, &PROBE.replace("32", "0"), &["--samples", "0 is not in 1.."]);
    refused(SCENE, RAYS, &PROBE.replace("--samples 32", "--quality high"), &["--quality", "--backend gpu"]);
}

#[test]
fn a_probe_keeps_the_rows_and_adds_the_answers() {
    let folder = folder_with(&[("scene.toml", SCENE), ("rays.csv", RAYS)]);
    let output = welkin(folder.path(), &format!("{PROBE} --orders single"));
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let mut lines = text.lines();
    let header = RAYS.lines().next().unwrap();
    let added =
        "radiance_r,radiance_g,radiance_b,transmittance_r,transmittance_g,transmittance_b,stderr_r,stderr_g,stderr_b";
    assert_eq!(lines.next().unwrap(), format!("{header},{added}"));
    for (row, asked) in lines.zip(RAYS.lines().skip(1)) {
        assert!(row.starts_with(&format!("{asked},")), "{row}");
    }
    // Single scattering of variant B at 500 m, sun at 60°, view at 30° in the sun's azimuth; sasktran2 and quadrature agree.
    let green: f64 = text.lines().nth(1).unwrap().split(',').nth(7).unwrap().parse().unwrap();
    assert!((green / 1.050_243_7e-2 - 1.0).abs() < 1e-4, "{green}");
}

#[test]
fn a_machine_without_a_device_is_told_what_to_install() {
    let folder = folder_with(&[("scene.toml", SCENE), ("rays.csv", RAYS)]);
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.env("WELKIN_VALIDATION", "1");
    command.current_dir(folder.path()).args(["probe", "scene.toml", "--rays", "rays.csv", "--out", "out.csv"]);
    // Both names of the variable that tells the loader which drivers there are.
    let output = command.env("VK_DRIVER_FILES", "/none").env("VK_ICD_FILENAMES", "/none").output().unwrap();
    assert_eq!(code(&output), 3, "{}", stderr(&output));
    assert!(stderr(&output).contains("apt-get install libvulkan1 mesa-vulkan-drivers"), "{}", stderr(&output));
    assert!(!folder.path().join("out.csv").exists());
}

fn write_frame(folder: &Path, name: &str, width: u32, factor: f32) {
    let scene = Scene::parse(SCENE, Path::new("scene.toml")).unwrap();
    let mut frame = Frame::new(width, 4);
    for (index, pixel) in frame.radiance.iter_mut().enumerate() {
        *pixel = [0.1, 0.2, 0.4].map(|band| factor * band * (1.0 + index as f32));
    }
    write_exr(AtomicFile::create(&folder.join(name)).unwrap(), &frame, &scene).unwrap();
}

#[test]
fn compare_exits_with_1_only_when_over() {
    let folder = tempfile::tempdir().unwrap();
    write_frame(folder.path(), "a.exr", 8, 1.05);
    write_frame(folder.path(), "b.exr", 8, 1.0);
    let codes = [
        ("compare b.exr b.exr --max-relative 0 --max-flip 0", 0),
        ("compare a.exr b.exr", 0),
        ("compare a.exr b.exr --max-relative 0.051 --max-flip 0.5", 0),
        ("compare a.exr b.exr --max-relative 0.049", 1),
        ("compare a.exr b.exr --max-flip 0.0001", 1),
        ("compare a.exr b.exr --max-flip nan", 2),
    ];
    for (arguments, expected) in codes {
        let output = welkin(folder.path(), arguments);
        assert_eq!(code(&output), expected, "{arguments}: {}", stderr(&output));
    }
    let json = welkin(folder.path(), "compare a.exr b.exr --json --max-relative 0.01");
    let metrics: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let median = metrics["relative_error"]["median"].as_f64().unwrap();
    assert!((median - 0.05).abs() < 1e-6, "{metrics}");
    assert!(stderr(&json).contains("relative error is 0.0500"), "{}", stderr(&json));
}

#[test]
fn compare_refuses_what_is_no_pair_of_pictures() {
    let folder = folder_with(&[("text.exr", "not an image")]);
    write_frame(folder.path(), "a.exr", 8, 1.0);
    write_frame(folder.path(), "wide.exr", 9, 1.0);
    write_frame(folder.path(), "nan.exr", 8, f32::NAN);
    let cases = [
        ("compare a.exr wide.exr", 2, "8 x 4 against 9 x 4"),
        ("compare a.exr text.exr", 2, "cannot read 'text.exr'"),
        ("compare a.exr none.exr", 2, "cannot read 'none.exr'"),
        ("compare nan.exr a.exr", 1, "first picture at column 0, row 0, band r is NaN"),
    ];
    for (arguments, expected, said) in cases {
        let output = welkin(folder.path(), arguments);
        assert_eq!(code(&output), expected, "{arguments}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn the_schema_command_prints_the_schema() {
    let output = welkin(Path::new("."), "schema");
    assert_eq!(code(&output), 0);
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(printed, welkin::scene::schema());
}

#[test]
fn explain_says_what_becomes_of_every_pass_without_a_device() {
    let vacuum = format!(
        "{SCENE}[medium.rayleigh]\ndensity_factor = 0\n[medium.mie]\ndensity_factor = 0\n[medium.ozone]\ndensity_factor = 0\n"
    );
    let folder = folder_with(&[("scene.toml", SCENE), ("vacuum.toml", &vacuum)]);
    let decisions = |scene: &str| -> Vec<(String, String)> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
        command.env("WELKIN_VALIDATION", "1");
        let output = command.current_dir(folder.path()).args(["explain", scene, "--json"]);
        let output = output.env("VK_DRIVER_FILES", "/none").env("VK_ICD_FILENAMES", "/none").output().unwrap();
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let text = |pass: &serde_json::Value, key: &str| pass[key].as_str().unwrap().to_owned();
        let passes = json["passes"].as_array().unwrap();
        assert!(passes.iter().all(|pass| !text(pass, "reason").is_empty() && pass["bytes"].is_u64()));
        passes.iter().map(|pass| (text(pass, "name"), text(pass, "decision"))).collect()
    };
    let decision = |scene: &str, name: &str| decisions(scene).into_iter().find(|pass| pass.0 == name).unwrap().1;
    assert_eq!(decision("scene.toml", "sky_view"), "run");
    assert_eq!(decision("vacuum.toml", "sky_view"), "skip");
    assert_eq!(decision("vacuum.toml", "display"), "run");
}

#[test]
fn explain_says_what_skipped_passes_would_cost() {
    let cloudy = format!("{SCENE}[[clouds]]\nkind = \"cumulus\"\n");
    let folder = folder_with(&[("clear.toml", SCENE), ("cloudy.toml", &cloudy)]);
    let explain = |arguments: &str| -> serde_json::Value {
        let output = welkin(folder.path(), arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let pass = |plan: &serde_json::Value, name: &str| -> serde_json::Value {
        plan["passes"].as_array().unwrap().iter().find(|pass| pass["name"] == name).unwrap().clone()
    };
    let clear = explain("explain clear.toml --quality low --json");
    let cloudy = explain("explain cloudy.toml --quality low --no-prices --json");
    let price = pass(&clear, "clouds")["would_cost"].clone();
    assert_eq!(price["with"], "fair-weather cumulus");
    assert!(price["milliseconds"].as_f64().unwrap() > 0.0);
    // The price is what the pass takes where it runs, which has no price itself.
    assert_eq!(price["bytes"], pass(&cloudy, "clouds")["bytes"]);
    assert!(pass(&cloudy, "clouds")["would_cost"].is_null() && pass(&clear, "compose")["would_cost"].is_null());
    let harmonics = pass(&clear, "first_order")["would_cost"]["with"].as_str().unwrap_or_default().to_owned();
    let ran = pass(&clear, "first_order")["decision"] == "run";
    assert!(ran || harmonics.contains("--multiple-scattering"), "{clear}");
    assert!(cloudy["passes"].as_array().unwrap().iter().all(|pass| pass["would_cost"].is_null()));
}

#[test]
fn a_place_that_cannot_be_written_costs_no_rendering() {
    for (out, said) in
        [("out.jpg", ".exr or .png"), ("no/out.png", "no folder 'no'"), ("ok.png -o no/a.exr", "no folder")]
    {
        refused(SCENE, RAYS, &format!("render scene.toml -o {out}"), &[said]);
    }
    refused(SCENE, RAYS, "render scene.toml -o out.png --json no/out.json", &["no folder 'no'"]);
    refused(SCENE, RAYS, "render scene.toml -o out.png --quality best", &["best", "low, low+1/2, low+3/4, medium"]);
}

/// Renders the scene to a PNG and an EXR file and says by how many of 255 steps the two differ at most, once the EXR
/// file's radiance is multiplied by a factor.
fn steps_between_png_and_exr(scene: &str, factor: f64) -> u8 {
    let folder = folder_with(&[("scene.toml", scene)]);
    let output = welkin(folder.path(), "render scene.toml -o a.png -o a.exr --json a.json");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let scene = Scene::read(&folder.path().join("scene.toml")).unwrap();
    let frame = read_exr(&folder.path().join("a.exr")).unwrap();
    assert!(frame.radiance.as_flattened().iter().any(|&value| value > 0.0), "the picture is black");
    let exposed = factor * display::exposed_srgb(&scene);
    let host = display::picture(&frame, exposed, scene.display.tone_map);
    let device = image::open(folder.path().join("a.png")).unwrap().into_rgb8().into_raw();
    let json: serde_json::Value = serde_json::from_slice(&fs::read(folder.path().join("a.json")).unwrap()).unwrap();
    let ran = |pass: &&serde_json::Value| pass["decision"] == "run";
    assert!(json["passes"].as_array().unwrap().iter().filter(ran).all(|pass| pass["milliseconds"].is_f64()), "{json}");
    host.iter().zip(&device).map(|(host, device)| host.abs_diff(*device)).max().unwrap()
}

#[test]
fn a_rendered_png_shows_the_radiance_of_the_exr() {
    for tone_map in ["filmic", "none"] {
        let scene = format!("{SCENE}[display]\nexposure_ev = 3\ntone_map = \"{tone_map}\"\n");
        // The device adds noise of less than one step and both round: less than two.
        assert!(steps_between_png_and_exr(&scene, 1.0) <= 2, "{tone_map}");
        assert!(steps_between_png_and_exr(&scene, 1.1) > 2, "{tone_map}: a tenth more light was not seen");
    }
}

#[test]
fn a_damaged_file_of_compiled_pipelines_is_said_and_made_anew() {
    let folder = folder_with(&[("scene.toml", SCENE)]);
    let cache = folder.path().join("cache");
    let render = |picture: &str, cache: &Path| {
        let output = welkin_with_cache(folder.path(), &format!("render scene.toml --quality low -o {picture}"), cache);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output)
    };
    let kept = || fs::read_dir(&cache).unwrap().map(|entry| entry.unwrap().path()).next().unwrap();
    render("first.png", &cache);
    let whole = fs::read(kept()).unwrap();
    assert!(!render("second.png", &cache).contains("damaged"));
    fs::write(kept(), &whole[..whole.len() - 1]).unwrap();
    assert!(render("third.png", &cache).contains("is damaged: pipelines are compiled anew"));
    assert_eq!(fs::read(kept()).unwrap(), whole, "the file was not mended");
    // A file where the folder should be: a warning, and the picture all the same.
    assert!(render("fourth.png", &folder.path().join("scene.toml")).contains("pipelines are not kept"));
    let picture = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for other in ["second.png", "third.png", "fourth.png"] {
        assert_eq!(picture("first.png"), picture(other), "{other}");
    }
}

#[test]
fn settings_follow_from_an_error_or_a_time() {
    let folder = folder_with(&[("scene.toml", SCENE)]);
    let cache = folder.path().join("cache");
    let goal = |arguments: &str| -> (String, serde_json::Value) {
        let output =
            welkin_with_cache(folder.path(), &format!("explain scene.toml --no-prices --json {arguments}"), &cache);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        (json["quality"].as_str().unwrap().to_owned(), json["goal"].clone())
    };
    let kept = |kind: &str| {
        let files = fs::read_dir(&cache).unwrap().map(|entry| entry.unwrap().path());
        let kept = files.filter(|path| path.file_name().unwrap().to_string_lossy().starts_with(kind));
        kept.map(|path| fs::read_to_string(path).unwrap()).collect::<Vec<_>>()
    };
    let (coarse, found) = goal("--target-error 0.1");
    assert!(found["predicted_error"].as_f64().unwrap() <= 0.1, "{found}");
    let (fine, found) = goal("--target-error 0.002");
    assert!(fine != coarse && found["predicted_error"].as_f64().unwrap() <= 0.002, "{coarse}, {fine}: {found}");
    // The scene is tried once.
    let tried = kept("distances");
    assert_eq!((goal("--target-error 0.002").0, kept("distances")), (fine, tried));
    // With all the time of the world the best; the device is measured once.
    let (best, predicted) = goal("--budget-ms 1e9");
    let measured = kept("calibration");
    assert_eq!(measured.len(), 1);
    let budget = 0.5 * predicted["predicted_milliseconds"].as_f64().unwrap();
    let (cheaper, predicted) = goal(&format!("--budget-ms {budget}"));
    assert!(cheaper != best && predicted["predicted_milliseconds"].as_f64().unwrap() <= budget, "{predicted}");
    assert_eq!(kept("calibration"), measured);
}

#[test]
fn goals_that_cannot_be_met_or_make_no_sense_are_refused() {
    for (arguments, said) in [
        ("--target-error 1e-9", &["0.0000001 %", "closest"][..]),
        ("--target-error 0", &["above 0"]),
        ("--target-error 0.1 --quality low", &["cannot be used with"]),
        ("--target-error 0.1 --backend reference", &["--target-error", "--backend gpu"]),
    ] {
        refused(SCENE, RAYS, &format!("render scene.toml -o out.png {arguments}"), said);
    }
    let cloudy = format!("{SCENE}[[clouds]]\nkind = \"cumulus\"\n");
    refused(&cloudy, RAYS, "render scene.toml -o out.png --target-error 0.1", &["clouds", "--budget-ms"]);
}
