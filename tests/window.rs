//! The window, used as people use it: on a real desktop without a monitor, with keys and clicks, under validation.
#![cfg(feature = "window")]

mod desktop;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use desktop::{Desktop, Program, until};
use welkin::output::read_exr;
use welkin::scene::Scene;

const SCENE: &str = "preset = \"hillaire2020\"\n[sun]\nelevation_deg = 30\nazimuth_deg = 0\n\
                     [camera]\naltitude_m = 500\nelevation_deg = 5\nazimuth_deg = 0\n[display]\nexposure_ev = 3\n";

/// Small and cheap, with the panel in a place that is known, and with a time for a picture that no machine exceeds, however
/// busy it is: a command names the time only where it is kept.
const SETTINGS: &str = "{\"size\": [640, 400], \"quality\": \"low\", \"truth_scale\": 0.05, \"picture_ms\": 60000}";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::create_dir(folder.path().join("config")).unwrap();
    fs::write(folder.path().join("config/window.json"), SETTINGS).unwrap();
    folder
}

fn welkin(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.env("WELKIN_CACHE", "").current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

/// Waits until a picture's three files are written, and reads the scene that lies beside it.
fn picture(program: &Program, folder: &Path, number: u32) -> Scene {
    let name = format!("scene-{number:03}.toml");
    until(&name, || program.stdout.text().contains(&name).then_some(()));
    Scene::read(&folder.join(name)).unwrap()
}

#[test]
fn the_window_shows_what_render_renders_and_closes_cleanly() {
    let (desktop, folder) = (Desktop::start(), folder());
    let folder = folder.path();
    let program = desktop.open(folder, "scene.toml");
    // Beside the panel there is sky: brighter than the window's black, and bluer than red.
    until("a sky", || {
        let [red, _, blue] = desktop.pixel(500, 60);
        (blue > 60 && blue > red).then_some(())
    });

    // A picture is what `render` makes of the scene beside it, to the last byte.
    program.key("F12");
    let scene = picture(&program, folder, 1);
    assert_eq!((scene.camera.width, scene.camera.height), (640, 400));
    assert!(welkin(folder, "render scene-001.toml -o again.png -o again.exr --quality low").status.success());
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    assert!(bytes("scene-001.png") == bytes("again.png"), "the PNG files differ");
    assert!(read_exr(&folder.join("scene-001.exr")).unwrap() == read_exr(&folder.join("again.exr")).unwrap());
    assert!(welkin(folder, "render scene-001.toml -o other.png --quality medium").status.success());
    assert!(bytes("scene-001.png") != bytes("other.png"), "the control: another quality is another picture");

    // Flying changes the scene, and one step back undoes the flight.
    assert_eq!(program.title(), "welkin: scene");
    program.hold("e", 1.0);
    until("a change", || (program.title() == "welkin: scene *").then_some(()));
    program.key("ctrl+z");
    until("no change", || (program.title() == "welkin: scene").then_some(()));

    // So does reading the file again.
    program.hold("e", 0.5);
    until("a change", || (program.title() == "welkin: scene *").then_some(()));
    program.key("F5");
    until("the file's scene", || (program.title() == "welkin: scene").then_some(()));
    // What is saved is the scene that is seen.
    program.key("bracketright");
    until("a later time", || (program.title() == "welkin: scene *").then_some(()));
    program.key("ctrl+s");
    until("a saved scene", || (program.title() == "welkin: scene").then_some(()));
    let saved = Scene::read(&folder.join("scene.toml")).unwrap();
    assert_ne!(saved.lights, scene.lights, "the sun has moved");

    // Without a mouse: Tab goes to the first slider, which is the altitude's, and the arrows move it.
    let altitude_is_changed = (8..14).any(|buttons_before| {
        let tabs = "Tab sleep 0.1 key ".repeat(buttons_before);
        program.key(&format!("Escape sleep 0.1 key {tabs} Tab sleep 0.2 key Right sleep 0.2 key Right sleep 0.4"));
        program.title() == "welkin: scene *"
    });
    assert!(altitude_is_changed, "no arrow has moved a slider");
    program.key("Escape sleep 0.2 key F12");
    let moved = picture(&program, folder, 2).camera;
    assert_eq!(moved.direction, saved.camera.direction);
    assert!(moved.altitude_m > saved.camera.altitude_m, "{} m", moved.altitude_m);
    program.key("ctrl+z");
    until("the saved scene", || (program.title() == "welkin: scene").then_some(()));

    // Another size, then hidden and shown again: the window goes on.
    program.window("windowsize", "520 300");
    until("another size", || {
        let right = desktop.pixel(505, 60);
        (desktop.pixel(530, 60) == [0; 3] && right[2] > 60).then_some(())
    });
    program.window("windowunmap", "");
    program.window("windowmap", "");
    program.window("windowfocus", "");
    until("the window again", || (desktop.pixel(505, 60)[2] > 60).then_some(()));
    // The button `picture` of the panel.
    program.click(120, 56);
    assert_eq!(picture(&program, folder, 3).camera.width, 520);
    // The list of example scenes, and the third of them.
    program.click(100, 14);
    program.click(45, 60);
    until("another scene", || (program.title() == "welkin: twilight").then_some(()));

    program.key("ctrl+q");
    let stderr = program.stderr.clone();
    assert_eq!(program.exit_code(), 0, "{}", stderr.text());
    let kept = fs::read_to_string(folder.join("config/window.json")).unwrap();
    assert!(kept.contains("520.0") && kept.contains("low"), "{kept}");
}

/// Whether a pixel is of clear sky: neither of the panel's greys, nor of a difference, which has two bands alike.
fn is_blue([red, green, blue]: [u8; 3]) -> bool {
    blue > 60 && green > red.saturating_add(5) && blue > green.saturating_add(5)
}

/// Whether two pixels are the same but for resolution and dither.
fn alike(one: [u8; 3], other: [u8; 3]) -> bool {
    one.iter().zip(other).all(|(one, other)| one.abs_diff(other) <= 8)
}

/// The shaders of the repository in a folder of their own.
fn shaders(folder: &Path) {
    fs::create_dir(folder.join("wgsl")).unwrap();
    for entry in Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/wgsl").read_dir().unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.join("wgsl").join(path.file_name().unwrap())).unwrap();
    }
}

#[test]
fn what_is_edited_beside_the_window_is_seen_in_it_and_faults_change_nothing() {
    let (desktop, folder) = (Desktop::start(), folder());
    let folder = folder.path();
    shaders(folder);
    let program = desktop.open(folder, "scene.toml --shaders wgsl");
    program.wait_for("shaders are compiled", 0);
    let sky = until("a sky", || Some(desktop.pixel(500, 60)).filter(|[red, _, blue]| *blue > 60 && blue > red));

    // A broken shader is named with its line, and the picture stays.
    let display = folder.join("wgsl/display.wgsl");
    let whole = fs::read_to_string(&display).unwrap();
    let last = "textureStore(picture_image, id.xy, vec4<f32>(shown + dither(id.xy), 1.0));";
    let line = 1 + whole.lines().position(|line| line.contains(last)).expect("the line that stores a pixel");
    fs::write(&display, whole.replace(last, "textureStore(picture_image, id.xy, nothing);")).unwrap();
    program.wait_for(&format!("wgsl/display.wgsl:{line}:"), 0);
    assert!(alike(desktop.pixel(500, 60), sky), "the picture changed");
    // Mended to paint all red.
    let said = program.stderr.text().len();
    fs::write(&display, whole.replace(last, "textureStore(picture_image, id.xy, vec4<f32>(1.0, 0.0, 0.0, 1.0));"))
        .unwrap();
    program.wait_for("shaders are compiled", said);
    until("a red sky", || (desktop.pixel(500, 60) == [255, 0, 0]).then_some(()));
    fs::write(&display, whole).unwrap();
    until("the sky again", || alike(desktop.pixel(500, 60), sky).then_some(()));

    // A broken scene is named with its line; a whole one is taken.
    fs::write(folder.join("scene.toml"), SCENE.replace("altitude_m = 500", "altitude_m = high")).unwrap();
    program.wait_for("scene.toml:6:", 0);
    fs::write(folder.join("scene.toml"), SCENE.replace("altitude_m = 500", "altitude_m = 700")).unwrap();
    program.wait_for("read 'scene.toml'", 0);
    program.key("ctrl+c");
    until("a command", || program.stdout.text().contains("SCENE\n").then_some(()));
    let command = program.stdout.text();
    assert!(command.contains("altitude_m = 700") && command.contains("welkin render /dev/stdin"), "{command}");

    // The truth comes beside the picture: the line moves, and what the two differ by is grey where they agree.
    program.key("h");
    program.key("t");
    program.wait_for("walks a pixel, relative error", 0);
    until("the sky to the left of the line", || is_blue(desktop.pixel(310, 60)).then_some(()));
    program.key("y");
    until("the difference to its right", || (!is_blue(desktop.pixel(500, 60))).then_some(()));
    program.key("x x x");
    until("the line further left", || (!is_blue(desktop.pixel(310, 60))).then_some(()));
    program.key("t");
    until("the sky alone", || is_blue(desktop.pixel(500, 60)).then_some(()));

    // Settings for an error are predicted; for a time the device is measured first, here without air that would take long.
    program.key("5");
    program.wait_for("settings for an error of 2 %: ", 0);
    let airless: String =
        ["rayleigh", "mie", "ozone"].map(|name| format!("[medium.{name}]\ndensity_factor = 0\n")).concat();
    fs::write(folder.join("scene.toml"), format!("{SCENE}{airless}")).unwrap();
    program.wait_for("read 'scene.toml'", program.stderr.text().rfind("settings for").unwrap());
    program.key("6");
    program.wait_for("settings for 60000 ms: ", 0);
    let copied = program.stdout.text().len();
    program.key("ctrl+c");
    // Settings that were chosen are named: a goal might lead elsewhere on the command line.
    until("a command", || program.stdout.text()[copied..].contains("--multiple-scattering ").then_some(()));
    program.key("ctrl+q");
    let stderr = program.stderr.clone();
    assert_eq!(program.exit_code(), 0, "{}", stderr.text());
    // The command that was copied renders the scene, in any shell.
    let mut shell = Command::new("sh");
    let path = Path::new(env!("CARGO_BIN_EXE_welkin")).parent().unwrap();
    let path = format!("{}:{}", path.display(), std::env::var("PATH").unwrap_or_default());
    let output = shell.current_dir(folder).env("PATH", path).env("WELKIN_CACHE", "").args(["-c", &command]).output();
    assert!(output.unwrap().status.success() && folder.join("scene.png").exists());
}

#[test]
fn a_window_of_a_fine_screen_is_full_and_minimised_and_its_panel_waits_for_no_sky() {
    let (desktop, folder) = (Desktop::managed(), folder());
    let folder = folder.path();
    // Two pixels to a point; settings where the platform has them.
    fs::create_dir(folder.join("config/welkin")).unwrap();
    fs::write(
        folder.join("config/welkin/window.json"),
        "{\"size\": [300, 200], \"quality\": \"low\", \"panel\": false}",
    )
    .unwrap();
    let program = desktop.open_with(folder, "scene.toml", |command| {
        command.env("XDG_CONFIG_HOME", folder.join("config")).env("WINIT_X11_SCALE_FACTOR", "2");
    });
    // No screen of the test shows light above white, and the log says what it offers instead.
    program.wait_for("the screen shows no light above white; it offers B8G8R8A8", 0);
    program.act_on_window("windowactivate WINDOW sleep 1");
    // A key that is held asks for one picture.
    program.hold("F12", 1.2);
    let camera = picture(&program, folder, 1).camera;
    assert_eq!((camera.width, camera.height), (600, 400), "300 x 200 points");

    // Full.
    program.key("F11");
    until("a full screen", || (is_blue(desktop.pixel(20, 20)) && is_blue(desktop.pixel(780, 20))).then_some(()));
    // The keys are shown at once, however long the sky takes: here, on a CPU, a quarter of a minute and more.
    program.key("4");
    std::thread::sleep(Duration::from_millis(700));
    let pressed = Instant::now();
    program.key("F1");
    until("the keys", || (!is_blue(desktop.pixel(400, 120))).then_some(()));
    assert!(pressed.elapsed() < Duration::from_secs(5), "the panel waits for the sky: {:?}", pressed.elapsed());
    program.key("1 Escape");
    until("no keys", || is_blue(desktop.pixel(400, 120)).then_some(()));
    program.key("h");
    until("the panel", || (!is_blue(desktop.pixel(20, 20))).then_some(()));
    program.key("h");
    until("no panel", || is_blue(desktop.pixel(20, 20)).then_some(()));

    // Minimised and shown again, it goes on.
    program.act_on_window("windowminimize WINDOW sleep 1 windowactivate WINDOW sleep 1");
    let written = || program.stdout.text().matches(".exr").count();
    assert_eq!(written(), 1, "{}", program.stdout.text());
    program.key("F12");
    until("a picture", || (written() > 1).then_some(()));
    program.key("ctrl+q");
    let stderr = program.stderr.clone();
    assert_eq!(program.exit_code(), 0, "{}", stderr.text());
    let kept = fs::read_to_string(folder.join("config/welkin/window.json")).unwrap();
    assert!(kept.contains("300.0") && kept.contains("200.0"), "{kept}");
}

#[test]
fn without_a_display_the_message_says_so_and_the_exit_code_is_3() {
    let folder = folder();
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let output = command.current_dir(folder.path()).args(["window", "scene.toml"]).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.contains("no display to open a window on") && !message.contains("panicked"), "{message}");
    assert!(message.contains("welkin render"), "it says what works without: {message}");
    // A scene that is none is said first.
    let output = welkin(folder.path(), "window none.toml");
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
}
