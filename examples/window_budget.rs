//! Whether the window holds its frame budget while one flies, and how long its panel takes meanwhile.
//!
//! `cargo build --release && cargo run --release --example window_budget`. For several budgets: the median time of a picture
//! in flight, at which share of the window's side, and the median and longest time of laying out and drawing the panel. A
//! picture cannot take less than the tables that every altitude needs anew, nor the smallest share of the side.

#[path = "../tests/desktop/mod.rs"]
mod desktop;

use desktop::Desktop;

const SCENE: &str = "preset = \"earth\"\n[sun]\nelevation_deg = 20\nazimuth_deg = 250\n[camera]\naltitude_m = 500\n\
                     elevation_deg = 10\nazimuth_deg = 240\n[display]\nexposure_ev = 3\n";

/// Of the window, points and pixels: more than a processor computes within the budgets.
const SIZE: [u32; 2] = [1600, 1000];

/// Seconds of flight.
const FLIGHT_S: f64 = 15.0;

fn main() {
    let desktop = Desktop::of_size(SIZE);
    println!("| budget, ms | pictures | median, ms | median share of the side | panel: median, ms | most, ms |");
    println!("|---|---|---|---|---|---|");
    for budget_ms in [50, 100, 200, 400] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
        std::fs::create_dir(folder.path().join("config")).expect("a folder");
        write(
            "config/window.json",
            &format!("{{\"size\": {SIZE:?}, \"quality\": \"medium\", \"budget_ms\": {budget_ms}}}"),
        );
        write("scene.toml", SCENE);
        let program = desktop.open_with(folder.path(), "scene.toml", |command| {
            command.env("WELKIN_CONFIG", folder.path().join("config")).env("WELKIN_LOG", "welkin=debug");
            command.env_remove("WELKIN_VALIDATION");
        });
        program.wait_for("a picture at 1.000", 0);
        // Shaders of small pictures are compiled, and the scale is found.
        program.hold("w", FLIGHT_S / 3.0);
        let from = program.stderr.text().len();
        program.hold("w", FLIGHT_S);
        let said = program.stderr.text()[from..].to_owned();
        program.key("ctrl+q");
        program.exit_code();
        let pictures = numbers(&said, "a picture at ");
        let [mut shares, mut times] = [0, 1].map(|column| pictures.iter().map(|of| of[column]).collect::<Vec<_>>());
        let mut panel: Vec<_> = numbers(&said, "the panel: ").iter().map(|of| of[0]).collect();
        let [share, time, panel_ms] = [&mut shares, &mut times, &mut panel].map(|list| median(list));
        let most_ms = panel.iter().copied().fold(0.0, f64::max);
        println!("| {budget_ms} | {} | {time:.0} | {share:.2} | {panel_ms:.0} | {most_ms:.0} |", pictures.len());
    }
}

/// All numbers after the words in each line that has them.
fn numbers(said: &str, words: &str) -> Vec<Vec<f64>> {
    let lines = said.lines().filter_map(|line| line.split_once(words));
    lines.map(|(_, rest)| rest.split([' ', ':']).filter_map(|word| word.parse().ok()).collect()).collect()
}

fn median(list: &mut [f64]) -> f64 {
    list.sort_by(f64::total_cmp);
    list.get(list.len() / 2).copied().unwrap_or(f64::NAN)
}
