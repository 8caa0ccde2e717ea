//! Whether what the plan leaves out shows, over hundreds of random scenes for each rule; and whether a wrong rule is noticed.
//! Prints the table of docs/effects.md.
//!
//! `cargo run --release --example skipping_sweep [-- SCENES [ROW...]]`, rows being lights, air, mountains, clouds, thin, lag;
//! fails where a rule shows, or a wrong one does not: each of these is tried on the same scenes until one notices it. The rule
//! for lights that stand too low needs no pictures: `tests/skipping.rs` asks the reference whether they light any air.

#[path = "../tests/skipping_trials/mod.rs"]
mod skipping_trials;

use std::process::ExitCode;

use skipping_trials::{
    BOUND, LIGHTS_BOUND, Sample, Tally, WRONG_ABOUT_LIGHTS, difference, difference_in_thin_air, difference_in_views,
    difference_of_lag, renderers, wrong_about_views,
};
use welkin::plan::Skipping;
use welkin::renderer::Renderer;
use welkin::scene::Effect;

/// Other scenes than those of the quick test.
const SEED: u64 = 2024;

type Trial = fn(&mut [Renderer; 2], Skipping, Sample) -> Tally;

/// A row of the table: rules that are tried together.
struct Row {
    name: &'static str,
    rules: &'static str,
    trial: Trial,
    usual: Skipping,
    bound: f64,
    wrong: Vec<Skipping>,
}

fn rows() -> Vec<Row> {
    let in_views = |name, rules, trial, effect| Row {
        name,
        rules,
        trial,
        usual: Skipping::USUAL,
        bound: BOUND,
        wrong: wrong_about_views(effect),
    };
    vec![
        Row {
            name: "lights",
            rules: "faint lights, narrow and high discs",
            trial: |both, rules, sample| difference(&mut both[0], rules, sample),
            usual: Skipping::USUAL,
            bound: LIGHTS_BOUND,
            wrong: WRONG_ABOUT_LIGHTS.into(),
        },
        in_views(
            "air",
            "air out of the picture",
            |both, rules, sample| difference_in_views(both, None, rules, sample),
            None,
        ),
        in_views(
            "mountains",
            "mountains out of the picture or hidden by air",
            |both, rules, sample| difference_in_views(both, Some(Effect::Mountains), rules, sample),
            Some(Effect::Mountains),
        ),
        in_views(
            "clouds",
            "clouds out of the picture",
            |both, rules, sample| difference_in_views(both, Some(Effect::Clouds), rules, sample),
            Some(Effect::Clouds),
        ),
        Row {
            name: "thin",
            rules: "light scattered more than once in thin air",
            trial: difference_in_thin_air,
            usual: Skipping::USUAL,
            bound: BOUND,
            wrong: vec![Skipping { thin_share: 1.0, ..Skipping::USUAL }],
        },
        Row {
            name: "lag",
            rules: "tables that lag behind the sun",
            trial: difference_of_lag,
            usual: Skipping::IN_SEQUENCE,
            bound: BOUND,
            wrong: vec![Skipping { lag_share: 20.0 * BOUND, ..Skipping::IN_SEQUENCE }],
        },
    ]
}

impl Row {
    /// Prints it; whether the rules are held and the wrong ones noticed.
    fn run(&self, both: &mut [Renderer; 2], scenes: usize) -> bool {
        let mut try_rules = |rules, enough| (self.trial)(both, rules, Sample { scenes, seed: SEED, enough });
        let usual = try_rules(self.usual, f64::INFINITY);
        let wrong: Vec<_> = self.wrong.iter().map(|rules| try_rules(*rules, self.bound)).collect();
        let noticed: Vec<_> =
            wrong.iter().map(|tally| format!("{:.3} % in scene {}", 100.0 * tally.worst, tally.worst_scene)).collect();
        println!(
            "| {} | {scenes} | {} | {:.3} % in scene {} | {:.2} % | {} |",
            self.rules,
            usual.changed,
            100.0 * usual.worst,
            usual.worst_scene,
            100.0 * self.bound,
            noticed.join("; ")
        );
        usual.worst < self.bound && usual.changed > 0 && wrong.iter().all(|tally| tally.worst > self.bound)
    }
}

fn main() -> ExitCode {
    let words: Vec<_> = std::env::args().skip(1).collect();
    let scenes = words.first().map_or(300, |word| word.parse().expect("how many scenes"));
    let chosen = words.get(1..).unwrap_or_default();
    let mut both = renderers();
    println!(
        "| rules | scenes | changed | largest difference of a pixel | bound | each rule set wrong, until noticed |"
    );
    println!("|---|---|---|---|---|---|");
    let mut is_held = true;
    for row in rows().iter().filter(|row| chosen.is_empty() || chosen.iter().any(|name| name == row.name)) {
        is_held &= row.run(&mut both, scenes);
    }
    if is_held { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
