//! What a user sees when the machine fails: a full disk, no memory, a kill at any moment, two programs at once. Nothing
//! half-written appears under a picture's name.
//!
//! Limits of a shell stand for the machine's: on the size of files for a full disk, on address space for memory.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use tempfile::TempDir;

const SCENE: &str = "preset = \"hillaire2020\"\n[sun]\nelevation_deg = 30\nazimuth_deg = 0\nangular_radius_deg = 0\n\
                     [camera]\naltitude_m = 500\nelevation_deg = 0\nazimuth_deg = 0\nwidth = 64\nheight = 64\n";
const RENDER: &str = "render scene.toml --quality low -o out.exr";

fn desk() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::write(folder.path().join("huge.toml"), SCENE.replace("= 64", "= 16384")).unwrap();
    folder
}

/// A shell that ends as the program, with limits set before it.
fn shell(folder: &Path, limits: &str, arguments: &str) -> Command {
    let mut command = Command::new("sh");
    let line = format!("{limits} exec '{}' {arguments}", env!("CARGO_BIN_EXE_welkin"));
    command.current_dir(folder).args(["-c", &line]).env("WELKIN_CACHE", "").env("RUST_BACKTRACE", "0");
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// What lies in the folder besides the scenes.
fn left(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.filter(|name| !name.ends_with(".toml")).collect();
    names.sort();
    names
}

/// Expects exit code 2, words, and nothing left behind.
fn refused(limits: &str, arguments: &str, words: &[&str]) {
    let desk = desk();
    let output = shell(desk.path(), limits, arguments).output().unwrap();
    let said = message(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments}: {said}");
    assert!(words.iter().all(|word| said.contains(word)), "{arguments}: {said}");
    assert!(!said.contains("panicked"), "{said}");
    assert!(left(desk.path()).is_empty(), "{arguments} left {:?}", left(desk.path()));
}

/// The driver of `failing_driver/`, compiled: the file that has the loader take it.
fn failing_driver(folder: &Path) -> PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/failing_driver/driver.c");
    let library = folder.join("driver.so");
    let mut cc = Command::new("cc");
    cc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-o"])
        .arg(&library)
        .arg(source)
        .arg("-ldl");
    assert!(cc.status().expect("cc, which scripts/setup.sh installs").success());
    let manifest = folder.join("driver.json");
    let driver = serde_json::json!({ "library_path": library, "api_version": "1.3.0" });
    fs::write(&manifest, serde_json::json!({ "file_format_version": "1.0.0", "ICD": driver }).to_string()).unwrap();
    manifest
}

/// The driver behind it: a file that the loader would take of itself.
fn real_driver() -> String {
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].into_iter().find_map(|name| std::env::var(name).ok());
    let installed = || {
        let files = fs::read_dir("/usr/share/vulkan/icd.d").expect("drivers, which scripts/setup.sh installs");
        let mut names = files.map(|file| file.unwrap().path().display().to_string());
        names.find(|name| name.contains("lvp")).expect("lavapipe")
    };
    let manifest = named.unwrap_or_else(installed);
    let text = fs::read_to_string(manifest.split(':').next().unwrap_or_default()).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    manifest["ICD"]["library_path"].as_str().unwrap().to_owned()
}

/// Renders on a driver whose `call` returns a number in place of a result, after so many that it has answered.
fn rendered_on(driver: &Path, folder: &Path, call: &str, result: i32, after: u32) -> Output {
    let mut command = shell(folder, "", RENDER);
    command.env("VK_DRIVER_FILES", driver).env("VK_ICD_FILENAMES", driver).env("WELKIN_TEST_DRIVER", real_driver());
    command.env("WELKIN_TEST_CALL", call).env("WELKIN_TEST_RESULT", result.to_string());
    command.env("WELKIN_TEST_AFTER", after.to_string()).output().unwrap()
}

#[test]
fn a_lost_device_and_a_driver_without_memory_are_named_with_what_to_do() {
    const OUT_OF_HOST_MEMORY: i32 = -1;
    const OUT_OF_DEVICE_MEMORY: i32 = -2;
    const DEVICE_LOST: i32 = -4;
    let built = tempfile::tempdir().unwrap();
    let driver = failing_driver(built.path());
    let lost = &["the device was lost", "run it again"][..];
    let host = &["memory of the host", "smaller picture"][..];
    let faults = [
        ("vkQueueSubmit2", DEVICE_LOST, 0, lost),
        ("vkWaitForFences", DEVICE_LOST, 1, lost),
        ("vkCreateComputePipelines", OUT_OF_HOST_MEMORY, 2, host),
        ("vkCreateImage", OUT_OF_HOST_MEMORY, 3, host),
        ("vkCreateBuffer", OUT_OF_DEVICE_MEMORY, 1, &["the device has no memory left", "lower quality"]),
        ("vkAllocateMemory", OUT_OF_DEVICE_MEMORY, 0, &["no memory for `"]),
    ];
    for (call, result, after, words) in faults {
        let desk = desk();
        let output = rendered_on(&driver, desk.path(), call, result, after);
        let said = message(&output);
        assert_eq!(output.status.code(), Some(2), "{call}: {said}");
        assert!(words.iter().all(|word| said.contains(word)), "{call}: {said}");
        assert!(said.contains(call) || call == "vkAllocateMemory", "{call}: {said}");
        assert!(left(desk.path()).is_empty(), "{call} left {:?}", left(desk.path()));
    }
    // Control: the same driver without a fault.
    let desk = desk();
    assert!(rendered_on(&driver, desk.path(), "none", 0, 0).status.success());
    assert_eq!(left(desk.path()), ["out.exr"]);
}

/// No file longer than a few KiB, as if the disk were full; the signal that comes with it is ignored.
const FULL_DISK: &str = "trap '' XFSZ; ulimit -f 8;";

#[test]
fn on_a_full_disk_the_file_is_named_and_nothing_is_left() {
    refused(FULL_DISK, RENDER, &["cannot write 'out.exr'", "File too large"]);
    refused(FULL_DISK, "reference scene.toml --samples 32 -o out.exr", &["out.exr", "File too large"]);
    // Control: without the limit it is written.
    let desk = desk();
    assert!(shell(desk.path(), "", RENDER).output().unwrap().status.success());
    assert_eq!(left(desk.path()), ["out.exr"]);
}

#[test]
fn what_does_not_fit_into_memory_is_said_with_its_size() {
    // 16384 x 16384 pixels: 4 GiB for one image of the device, 14 GiB for the film of the reference.
    let two_gib = "ulimit -v 2097152;";
    refused(
        two_gib,
        "render huge.toml --quality low -o out.exr",
        &["no memory for `radiance_image` (4294967296 bytes)"],
    );
    refused(two_gib, "reference huge.toml --samples 32 -o out.exr", &["no memory for", "268435456 pixels", "--shard"]);
}

fn start(folder: &Path, arguments: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.current_dir(folder).args(arguments.split_whitespace()).env("WELKIN_CACHE", folder.join("cache"));
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

#[test]
fn a_killed_rendering_leaves_the_old_picture_or_the_new_one() {
    let desk = desk();
    let picture = desk.path().join("out.exr");
    let time = std::time::Instant::now();
    assert!(start(desk.path(), RENDER).wait().unwrap().success());
    let (took, whole) = (time.elapsed(), fs::read(&picture).unwrap());
    let mut killed = 0;
    for twentieth in [1, 4, 7, 10, 13, 16, 18, 19] {
        fs::write(&picture, "old").unwrap();
        let mut child = start(desk.path(), RENDER);
        std::thread::sleep(Duration::from_secs_f64(took.as_secs_f64() * f64::from(twentieth) / 20.0));
        child.kill().unwrap();
        killed += usize::from(!child.wait().unwrap().success());
        let found = fs::read(&picture).unwrap();
        assert!(found == b"old" || found == whole, "killed after {twentieth} twentieths: {} bytes", found.len());
    }
    assert!(killed > 2, "only {killed} of 8 were killed while they ran");
    // What a kill leaves is hidden, and the next run, with a cache of pipelines that kills may have met, is whole.
    assert!(left(desk.path()).iter().all(|name| name.starts_with(".welkin-") || name == "cache" || name == "out.exr"));
    assert!(start(desk.path(), RENDER).wait().unwrap().success());
    assert_eq!(fs::read(&picture).unwrap(), whole);
}

#[test]
fn two_programs_that_share_output_and_cache_do_not_disturb_each_other() {
    let desk = desk();
    let mut both = [start(desk.path(), RENDER), start(desk.path(), RENDER)];
    assert!(both.iter_mut().all(|child| child.wait().unwrap().success()));
    let together = fs::read(desk.path().join("out.exr")).unwrap();
    assert!(start(desk.path(), RENDER).wait().unwrap().success());
    assert_eq!(fs::read(desk.path().join("out.exr")).unwrap(), together);
    assert_eq!(left(desk.path()), ["cache", "out.exr"]);
}
