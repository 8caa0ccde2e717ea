//! Uses the window for ten minutes, as a script would, and says how its memory grows.
//!
//! `cargo build --release && cargo run --release --example window_soak -- [MINUTES] [--without-validation]`; fails when the second half
//! of the time has grown by more than 2 % over the first.

#[path = "../tests/desktop/mod.rs"]
mod desktop;

use std::process::ExitCode;
use std::time::{Duration, Instant};

use desktop::Desktop;

/// Growth of the median of the second half over that of the first that counts as none.
const ALLOWED: f64 = 0.02;

const SCENE: &str = "preset = \"earth\"\n[sun]\nelevation_deg = 20\nazimuth_deg = 250\n[camera]\naltitude_m = 500\n\
                     elevation_deg = 10\nazimuth_deg = 240\n[display]\nexposure_ev = 3\n";

/// One round of use: flight, time, sizes, edits and their undoing, qualities, the help, the truth, hiding.
const ROUND: [&str; 22] = [
    "keydown w sleep 2 keyup w",
    "key p sleep 2 key p",
    "keydown Right sleep 1 keyup Right",
    "windowsize WINDOW 700 420 sleep 1",
    "key F1 sleep 0.5 key F1",
    "key 1 sleep 1",
    "mousemove 600 200 mousedown 1 mousemove 500 220 mousemove 450 180 mouseup 1 sleep 1",
    "key bracketright bracketright minus equal sleep 1",
    "key h sleep 0.5 key h",
    "windowunmap WINDOW sleep 1 windowmap WINDOW sleep 0.5 windowfocus WINDOW",
    "key t sleep 3 key y key y key t",
    "key ctrl+c",
    "key 2 sleep 1",
    "windowsize WINDOW 640 400 sleep 1",
    "keydown s sleep 2 keyup s",
    "key ctrl+z ctrl+z ctrl+y sleep 0.5",
    "mousemove 110 110 click 1 sleep 0.5",
    "key Escape",
    "keydown q sleep 2 keyup q",
    "key bracketleft bracketleft sleep 1",
    "key F5 sleep 1",
    "key Escape",
];

fn main() -> ExitCode {
    let minutes: f64 = std::env::args().skip(1).find_map(|text| text.parse().ok()).unwrap_or(10.0);
    let is_validated = std::env::args().all(|text| text != "--without-validation");
    let (desktop, folder) = (Desktop::start(), tempfile::tempdir().expect("a temporary folder"));
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    std::fs::create_dir(folder.path().join("config")).expect("a folder");
    write("config/window.json", "{\"size\": [640, 400], \"quality\": \"low\", \"truth_scale\": 0.05}");
    write("scene.toml", SCENE);
    let program = desktop.open_with(folder.path(), "scene.toml", |command| {
        command.env("WELKIN_CONFIG", folder.path().join("config")).env("WELKIN_LOG", "welkin::window::sky=debug");
        if !is_validated {
            command.env_remove("WELKIN_VALIDATION");
        }
    });
    let started = Instant::now();
    let mut samples = Vec::new();
    let mut rounds = 0;
    while started.elapsed() < Duration::from_secs_f64(60.0 * minutes) {
        for step in ROUND {
            let (command, arguments) = step.split_once(' ').unwrap_or((step, ""));
            match arguments.contains("WINDOW") {
                true => program.act_on_window(step),
                false => drop(desktop.xdotool(&format!("{command} {arguments}"))),
            }
        }
        rounds += 1;
        samples.push(program.memory_kib());
        assert_ne!(samples.last(), Some(&0), "the program has ended: {}", program.stderr.text());
        let said = program.stderr.text();
        let device = said.lines().rev().find_map(|line| line.split_once("DEBUG ")).map_or("", |(_, said)| said);
        println!(
            "{:7.1} s, round {rounds}: {} MiB; {device}",
            started.elapsed().as_secs_f64(),
            program.memory_kib() / 1024
        );
    }
    program.key("ctrl+q");
    let code = program.exit_code();
    // The first round fills caches of pipelines and tables.
    let steady = samples.get(1..).unwrap_or_default();
    let (first, second) = steady.split_at(steady.len() / 2);
    let median = |list: &[u64]| {
        let mut sorted = list.to_vec();
        sorted.sort();
        sorted.get(sorted.len() / 2).copied().unwrap_or(0) as f64
    };
    let growth = median(second) / median(first).max(1.0) - 1.0;
    println!("{rounds} rounds; exit code {code}; the second half holds {:+.2} % of the first", 100.0 * growth);
    if code == 0 && growth <= ALLOWED && first.len() > 1 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
