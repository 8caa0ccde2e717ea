//! `welkin reference` and `welkin merge` as a user sees them: pictures on one machine or many, interrupted or not.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use welkin::frame::Frame;
use welkin::output::{AtomicFile, read_exr, read_exr_with_header, write_exr_with_header};

const SCENE: &str = r#"
preset = "earth"
[sun]
elevation_deg = 30
azimuth_deg = 90
[camera]
altitude_m = 2
elevation_deg = 5
azimuth_deg = 70
width = 16
height = 9
"#;

/// A folder with a scene in it.
struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let desk = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::write(desk.path("scene.toml"), SCENE).unwrap();
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
        command.current_dir(self.folder.path()).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs what must succeed.
    fn done(&self, arguments: &[&str]) {
        let output = self.run(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", message(&output));
    }

    /// Runs what must be refused as bad input, and returns the message.
    fn refused(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", message(&output));
        message(&output)
    }

    fn trace(&self, output: &str, more: &[&str]) {
        self.done(&[&["reference", "scene.toml", "-o", output], more].concat());
    }

    fn frame(&self, name: &str) -> Frame {
        read_exr(&self.path(name)).unwrap()
    }

    /// Names of all files but the scene.
    fn files(&self) -> Vec<String> {
        let entries = self.folder.path().read_dir().unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.retain(|name| name != "scene.toml");
        names.sort();
        names
    }
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_picture_comes_with_its_standard_error_and_nothing_else_is_left() {
    let desk = Desk::new();
    desk.trace("out.exr", &["--samples", "64"]);
    assert_eq!(desk.files(), ["out.exr"]);
    let frame = desk.frame("out.exr");
    assert_eq!((frame.width, frame.height), (16, 9));
    let errors = frame.standard_error.unwrap();
    for (radiance, error) in frame.radiance.iter().flatten().zip(errors.iter().flatten()) {
        assert!(*radiance > 0.0 && *error > 0.0 && error < radiance, "{radiance} ± {error}");
    }
    // The horizon lies in the picture: sky above, ground below.
    assert!(frame.distance_m[0].is_infinite() && frame.distance_m[16 * 8] < 1000.0);
}

#[test]
fn the_stated_standard_error_is_the_spread_between_seeds() {
    let desk = Desk::new();
    let seeds = ["0", "1", "2", "3"];
    let frames: Vec<Frame> = seeds
        .iter()
        .map(|seed| {
            desk.trace("out.exr", &["--samples", "256", "--seed", seed]);
            desk.frame("out.exr")
        })
        .collect();
    let mut sum = 0.0;
    for pixel in 0..frames[0].radiance.len() {
        for band in 0..3 {
            let value = |frame: &Frame| f64::from(frame.radiance[pixel][band]);
            let error = |frame: &Frame| f64::from(frame.standard_error.as_ref().unwrap()[pixel][band]);
            let mean = frames.iter().map(value).sum::<f64>() / 4.0;
            let spread = frames.iter().map(|frame| (value(frame) - mean).powi(2)).sum::<f64>() / 3.0;
            sum += spread / (frames.iter().map(|frame| error(frame).powi(2)).sum::<f64>() / 4.0);
        }
    }
    // 144 pixels, whose bands share their walks: a mean of 144 χ²(3)/3 or more is 1 ± √(2/3/144); errors that are
    // estimated from 16 batches each, four times, add a bias of about 2/60 and some width.
    let ratio = sum / (3.0 * frames[0].radiance.len() as f64);
    assert!((ratio - 1.0).abs() < 4.0 * (2.0_f64 / 3.0 / 144.0).sqrt() + 0.04, "spread over stated: {ratio}");
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let desk = Desk::new();
    for threads in ["1", "2"] {
        let arguments = ["reference", "scene.toml", "-o", &format!("{threads}.exr"), "--samples", "40"];
        let output = desk.command(&arguments).env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert!(output.status.success(), "{}", message(&output));
    }
    assert_eq!(std::fs::read(desk.path("1.exr")).unwrap(), std::fs::read(desk.path("2.exr")).unwrap());
    desk.trace("other.exr", &["--samples", "40", "--seed", "1"]);
    assert_ne!(desk.frame("1.exr"), desk.frame("other.exr"));
}

#[test]
fn merged_parts_are_the_picture_of_one_run_in_any_order() {
    let desk = Desk::new();
    desk.trace("whole.exr", &["--samples", "40"]);
    for part in ["1", "2", "3"] {
        desk.trace(&format!("part{part}.exr"), &["--samples", "40", "--shard", &format!("{part}/3")]);
    }
    for order in [["1", "2", "3"], ["3", "1", "2"]] {
        let parts = order.map(|part| format!("part{part}.exr"));
        desk.done(&["merge", &parts[0], &parts[1], &parts[2], "-o", "merged.exr"]);
        assert_eq!(std::fs::read(desk.path("merged.exr")).unwrap(), std::fs::read(desk.path("whole.exr")).unwrap());
    }
}

#[test]
fn parts_that_do_not_belong_together_are_refused_and_nothing_is_written() {
    let desk = Desk::new();
    let part = |output: &str, shard: &str, samples: &str, seed: &str| {
        desk.trace(output, &["--samples", samples, "--shard", shard, "--seed", seed]);
    };
    part("one.exr", "1/2", "4", "0");
    part("two.exr", "2/2", "4", "0");
    part("seed.exr", "2/2", "4", "9");
    part("third.exr", "2/3", "4", "0");
    part("more.exr", "2/2", "5", "0");
    part("batches.exr", "2/2", "64", "0");
    std::fs::write(desk.path("scene.toml"), SCENE.replace("elevation_deg = 30", "elevation_deg = 31")).unwrap();
    part("sun.exr", "2/2", "4", "0");
    let merge = |parts: &[&str]| desk.refused(&[&["merge"], parts, &["-o", "out.exr"]].concat());
    let cases: [(&[&str], &str); 8] = [
        (&["one.exr", "sun.exr"], "'sun.exr' does not belong to 'one.exr': it is of scene 'scene'"),
        (&["one.exr", "seed.exr"], "seed 9, not seed 0"),
        (&["one.exr", "third.exr"], "3 parts, not 2 parts"),
        (&["one.exr", "more.exr"], "5 walks a pixel, not 4 walks a pixel"),
        (&["one.exr", "batches.exr"], "4 walks in a batch, not 1 walks in a batch"),
        (&["one.exr", "one.exr"], "are both part 1 of 2"),
        (&["two.exr"], "of 2 parts one is missing: 1"),
        (&["one.exr", "nothing.exr"], "nothing.exr"),
    ];
    for (parts, text) in cases {
        let message = merge(parts);
        assert!(message.contains(text), "{parts:?}: {message}");
    }
    assert!(!desk.path("out.exr").exists());
    desk.done(&["merge", "two.exr", "one.exr", "-o", "out.exr"]);
}

#[test]
fn a_damaged_part_is_refused() {
    let desk = Desk::new();
    desk.trace("one.exr", &["--samples", "4"]);
    let good = std::fs::read(desk.path("one.exr")).unwrap();
    for position in [good.len() - 2, good.len() / 2, 300] {
        let mut bad = good.clone();
        bad[position] ^= 0x55;
        std::fs::write(desk.path("bad.exr"), &bad).unwrap();
        assert!(desk.refused(&["merge", "bad.exr", "-o", "out.exr"]).contains("bad.exr"), "byte {position}");
    }
    std::fs::write(desk.path("bad.exr"), &good[..good.len() - 100]).unwrap();
    assert!(desk.refused(&["merge", "bad.exr", "-o", "out.exr"]).contains("bad.exr"));
    // A picture of the right shape whose pixels were changed, but not its checksum.
    let (mut frame, header) = read_exr_with_header(&desk.path("one.exr")).unwrap();
    frame.radiance[5][1] *= 1.0001;
    write_exr_with_header(AtomicFile::create(&desk.path("bad.exr")).unwrap(), &frame, &header).unwrap();
    assert!(desk.refused(&["merge", "bad.exr", "-o", "out.exr"]).contains("its checksum does not fit"));
}

#[test]
fn an_error_asked_for_is_reached_or_the_command_fails() {
    let desk = Desk::new();
    let relative_error = |output: &Output| -> f64 {
        let text = message(output);
        text.rsplit("relative error ").next().unwrap().trim().parse().unwrap()
    };
    let output = desk.run(&["reference", "scene.toml", "-o", "out.exr", "--max-error", "0.05"]);
    assert!(output.status.success() && relative_error(&output) <= 0.05, "{}", message(&output));
    let arguments = ["reference", "scene.toml", "-o", "few.exr", "--max-error", "0.001", "--samples", "32"];
    let output = desk.run(&arguments);
    assert_eq!(output.status.code(), Some(1), "{}", message(&output));
    assert!(message(&output).contains("above the 1.000e-3 asked for") && desk.path("few.exr").exists());
}

/// Walks that take a few seconds, so that there is something to interrupt.
const MANY: [&str; 2] = ["--samples", "6000"];

#[cfg(unix)]
fn signal(child: &std::process::Child, name: &str) {
    let status = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_resumes_to_the_same_file() {
    let desk = Desk::new();
    desk.trace("straight.exr", &MANY);
    let arguments = [&["reference", "scene.toml", "-o", "out.exr", "--resume"], &MANY[..]].concat();
    let mut interruptions = 0;
    loop {
        let started = Instant::now();
        let child = desk.command(&arguments).spawn().unwrap();
        // Later each time, so that the run ends on a machine of any speed.
        std::thread::sleep(Duration::from_millis(150 << interruptions));
        signal(&child, if interruptions % 2 == 0 { "INT" } else { "TERM" });
        let output = child.wait_with_output().unwrap();
        if output.status.success() {
            break;
        }
        assert_eq!(output.status.code(), Some(130), "{}", message(&output));
        assert_eq!(desk.files(), ["out.exr.checkpoint", "straight.exr"]);
        assert!(message(&output).contains("--resume goes on from 'out.exr.checkpoint'"));
        interruptions += 1;
        assert!(interruptions < 12, "no end after {:?}", started.elapsed());
    }
    assert!(interruptions > 0, "the run ended before it could be interrupted");
    assert_eq!(desk.files(), ["out.exr", "straight.exr"]);
    assert_eq!(std::fs::read(desk.path("out.exr")).unwrap(), std::fs::read(desk.path("straight.exr")).unwrap());
}

#[cfg(unix)]
#[test]
fn a_checkpoint_of_another_scene_or_a_damaged_one_is_refused() {
    let desk = Desk::new();
    let arguments = [&["reference", "scene.toml", "-o", "out.exr", "--resume"], &MANY[..]].concat();
    let child = desk.command(&arguments).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(150));
    signal(&child, "INT");
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    assert!(desk.refused(&[&arguments[..], &["--seed", "5"]].concat()).contains("seed 0, not seed 5"));
    std::fs::write(desk.path("scene.toml"), SCENE.replace("altitude_m = 2", "altitude_m = 3")).unwrap();
    assert!(desk.refused(&arguments).contains("is of scene 'scene'"));
    let mut checkpoint = std::fs::read(desk.path("out.exr.checkpoint")).unwrap();
    let middle = checkpoint.len() / 2;
    checkpoint[middle] ^= 1;
    std::fs::write(desk.path("out.exr.checkpoint"), checkpoint).unwrap();
    assert!(desk.refused(&arguments).contains("is damaged"));
    assert_eq!(desk.files(), ["out.exr.checkpoint"]);
}

#[cfg(unix)]
#[test]
fn a_killed_run_leaves_the_old_picture_or_the_new_one_but_nothing_between() {
    let desk = Desk::new();
    desk.trace("straight.exr", &["--samples", "32"]);
    let whole = std::fs::read(desk.path("straight.exr")).unwrap();
    for milliseconds in [1, 5, 10, 20, 30, 40, 60, 90, 130, 180] {
        let mut child = desk.command(&["reference", "scene.toml", "-o", "out.exr", "--samples", "32"]).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
        if let Ok(bytes) = std::fs::read(desk.path("out.exr")) {
            assert_eq!(bytes, whole, "killed after {milliseconds} ms");
        }
        let _ = std::fs::remove_file(desk.path("out.exr"));
    }
}

#[test]
fn bad_arguments_are_refused_with_what_is_allowed() {
    let desk = Desk::new();
    let refused = |more: &[&str]| desk.refused(&[&["reference", "scene.toml", "-o", "out.exr"], more].concat());
    assert!(refused(&["--shard", "3/2"]).contains("is not I/N with 1 ≤ I ≤ N"));
    assert!(refused(&["--shard", "0/2"]).contains("is not I/N"));
    assert!(refused(&["--samples", "1"]).contains("2.."));
    assert!(refused(&["--max-error", "0"]).contains("does not lie in ]0, 1["));
    assert!(desk.refused(&["reference", "scene.toml", "-o", "out.png"]).contains("does not end in .exr"));
    assert!(desk.refused(&["reference", "none.toml", "-o", "out.exr"]).contains("none.toml"));
    assert!(desk.refused(&["reference", "scene.toml", "-o", "no/out.exr"]).contains("no/out.exr"));
    assert!(desk.files().is_empty());
    assert!(!Path::new("out.exr").exists());
}
