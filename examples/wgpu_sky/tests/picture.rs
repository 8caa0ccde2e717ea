//! The program's picture beside that of `welkin render` of the same scene.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use exr::prelude::write_rgb_file;
use welkin_wgpu_sky::{Camera, draw};

const SIZE: [u32; 2] = [320, 180];
/// Low enough that ground and horizon are in the picture.
const ELEVATION_DEG: f32 = 11.5;
/// Of the mean FLIP error: what docs/engines/README.md states.
const BOUND: f64 = 0.02;
/// The same with the sun below the horizon, beside a texel of the pack's sun or between two of them.
const TWILIGHT_BOUND: f64 = 0.04;

/// The command, where Cargo puts it.
fn welkin(arguments: &[&str]) -> serde_json::Value {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target = env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let program = target.join("release/welkin");
    let output = Command::new(&program).args(arguments).output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}; cargo build --release", program.display()));
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap_or_default()
}

fn scene(sun_elevation_deg: f32) -> String {
    format!(
        "preset = \"earth\"\n\
         [planet]\nground_albedo = [0.11, 0.13, 0.06]\n\
         [sun]\nelevation_deg = {sun_elevation_deg}\nazimuth_deg = 180\n\
         [camera]\naltitude_m = 2\nazimuth_deg = 0\nelevation_deg = {ELEVATION_DEG}\nwidth = {}\nheight = {}\n",
        SIZE[0], SIZE[1]
    )
}

/// Mean FLIP error of the program's picture, drawn from `pack`, against another.
fn flip(pack: &Path, camera: &Camera, rendered: &str) -> f64 {
    let pixels = draw(pack, camera, SIZE).unwrap();
    let drawn = pack.with_file_name("drawn.exr");
    let [width, height] = SIZE.map(|side| side as usize);
    write_rgb_file(&drawn, width, height, |x, y| pixels[y * width + x].into()).unwrap();
    let comparison = welkin(&["compare", drawn.to_str().unwrap(), rendered, "--json"]);
    comparison["mean_flip"].as_f64().unwrap()
}

#[test]
fn a_wgpu_program_draws_from_a_pack_what_welkin_renders() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (pack, file, rendered) = (place("pack"), place("scene.toml"), place("rendered.exr"));
    let mut failed = false;
    for sun_elevation_deg in [60.0, 30.0, 5.0, 0.0, -3.0, -3.6, -4.0] {
        let bound = if sun_elevation_deg < 0.0 { TWILIGHT_BOUND } else { BOUND };
        fs::write(&file, scene(sun_elevation_deg)).unwrap();
        if !Path::new(&pack).exists() {
            welkin(&["bake", &file, "--out", &pack, "--format", "raw"]);
        }
        welkin(&["render", &file, "-o", &rendered]);
        let camera = Camera::towards_north(ELEVATION_DEG, sun_elevation_deg);
        let found = flip(Path::new(&pack), &camera, &rendered);
        // Negative control: up is taken for north, as where Z is up.
        let [x, y, z] = camera.sun;
        let wrong = flip(Path::new(&pack), &Camera { sun: [x, z, y], ..camera }, &rendered);
        println!("sun at {sun_elevation_deg}°: FLIP {found:.4}; with another axis up {wrong:.4}");
        failed |= found > bound || wrong < 5.0 * bound;
    }
    assert!(!failed, "more than the bound, or the control less than five times that");
}
