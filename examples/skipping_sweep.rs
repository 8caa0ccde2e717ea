//! Whether what the plan leaves out shows, over hundreds of random scenes for each rule; and whether a wrong rule is noticed.
//! Prints the table of docs/effects.md.
//!
//! `cargo run --release --example skipping_sweep [-- SCENES]`; fails where a rule shows, or a wrong one does not. The rule for
//! lights that stand too low needs no pictures: `tests/skipping.rs` asks the reference whether they light any air.

#[path = "../tests/skipping_trials/mod.rs"]
mod skipping_trials;

use std::process::ExitCode;

use skipping_trials::{
    BOUND, LIGHTS_BOUND, WRONG_ABOUT_LIGHTS, difference, difference_in_thin_air, difference_in_views,
    difference_of_lag, renderers, wrong_about_views,
};
use welkin::plan::Skipping;
use welkin::scene::Effect;

/// Other scenes than those of the quick test.
const SEED: u64 = 2024;

fn main() -> ExitCode {
    let scenes: usize = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(300);
    let mut both = renderers();
    let mut is_held = true;
    println!("| rules | scenes | changed | largest difference of a pixel | bound | each rule set wrong |");
    println!("|---|---|---|---|---|---|");
    let mut row = |rules: &str, (worst, changed): (f64, usize), bound: f64, wrong: &[f64]| {
        is_held &= worst < bound && changed > 0 && wrong.iter().all(|worst| *worst > bound);
        let wrong: Vec<_> = wrong.iter().map(|worst| format!("{:.2} %", 100.0 * worst)).collect();
        let (worst, bound) = (100.0 * worst, 100.0 * bound);
        println!("| {rules} | {scenes} | {changed} | {worst:.3} % | {bound:.2} % | {} |", wrong.join(", "));
    };

    let lights = difference(&mut both[0], Skipping::USUAL, scenes, SEED);
    let wrong = WRONG_ABOUT_LIGHTS.map(|rules| difference(&mut both[0], rules, scenes, SEED).0);
    row("faint lights, narrow and high discs", lights, LIGHTS_BOUND, &wrong);
    for (effect, name) in [
        (None, "air out of the picture"),
        (Some(Effect::Mountains), "mountains out of the picture or hidden by air"),
        (Some(Effect::Clouds), "clouds out of the picture"),
    ] {
        let views = difference_in_views(&mut both, effect, Skipping::USUAL, scenes, SEED);
        let wrong = wrong_about_views(effect).into_iter();
        let wrong: Vec<_> = wrong.map(|rules| difference_in_views(&mut both, effect, rules, scenes, SEED).0).collect();
        row(name, views, BOUND, &wrong);
    }
    let thin = difference_in_thin_air(&mut both, Skipping::USUAL, scenes, SEED);
    let careless = Skipping { thin_share: 1.0, ..Skipping::USUAL };
    let wrong = difference_in_thin_air(&mut both, careless, scenes, SEED).0;
    row("light scattered more than once in thin air", thin, BOUND, &[wrong]);
    let lag = difference_of_lag(&mut both, Skipping::IN_SEQUENCE, scenes, SEED);
    let careless = Skipping { lag_share: 20.0 * BOUND, ..Skipping::IN_SEQUENCE };
    let wrong = difference_of_lag(&mut both, careless, scenes, SEED).0;
    row("tables that lag behind the sun", lag, BOUND, &[wrong]);
    if is_held { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
