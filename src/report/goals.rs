//! Whether settings that are chosen for an error or a time keep their promise, on the random scenes of a study.

use std::fmt::Write as _;

use super::learn::{self, steps};
use super::results::{SceneResults, Study};
use crate::goal::{CALIBRATION_STEPS, Calibration, MeasuredFront, MeasuredScene, TargetTrial, time_ratios};
use crate::plan::{LadderStep, Rung};

/// The errors that are asked for.
const TARGETS: [f64; 5] = [0.005, 0.01, 0.02, 0.05, 0.1];
/// What a choice may cost beside the cheapest settings that would have done.
const FRUGAL: f64 = 1.5;
/// How far a predicted time may be off.
const NEAR: f64 = 0.2;

/// What the columns of the table are.
fn headings() -> [String; 7] {
    let frugal = format!("at most {FRUGAL}");
    ["target %", "reachable", "chosen", "met", "price: median", &frugal, "most"].map(str::to_owned)
}

/// How choices fare on the random scenes of a study. They are made from what the program was built with; a scene that it
/// knows already is left out of that for its own turn.
struct Fares {
    scenes: usize,
    /// How many of them the program does not know.
    new: usize,
    trials: Vec<TargetTrial>,
    /// Predicted over measured times, in order.
    ratios: Vec<f64>,
}

impl Fares {
    /// None where no random scene was measured.
    fn of(study: &Study) -> Option<Self> {
        let random: Vec<&SceneResults> = study.scenes.iter().filter(|scene| scene.random).collect();
        let scenes: Vec<MeasuredScene> = random.iter().map(|scene| learn::measured(scene)).collect();
        let front = MeasuredFront::built_in();
        if scenes.is_empty() || front.scenes.is_empty() {
            return None;
        }
        let is_new = |scene: &&MeasuredScene| front.scenes.iter().all(|known| known.name != scene.name);
        let calibrations: Vec<Calibration> = random.iter().map(|scene| calibration(scene)).collect();
        Some(Self {
            scenes: scenes.len(),
            new: scenes.iter().filter(is_new).count(),
            trials: TARGETS.map(|target| TargetTrial::new(front, &scenes, target)).into(),
            ratios: time_ratios(front, &scenes, &calibrations),
        })
    }

    /// What the table says; the option's name and *words* are marked by the caller.
    fn about(&self, option: &str, met: &str, price: &str) -> String {
        format!(
            "{option} on {} random scenes, {} of them unknown to the model. {met}: the error of the chosen settings, a \
             standard error of the truth included, is within the target. {price}: time over that of the cheapest settings \
             that would have met it.",
            self.scenes, self.new
        )
    }

    fn rows(&self) -> impl Iterator<Item = [String; 7]> + '_ {
        self.trials.iter().map(|trial| {
            let ratios = &trial.price_ratios;
            let frugal = ratios.iter().filter(|ratio| **ratio <= FRUGAL).count();
            [
                (100.0 * trial.target).to_string(),
                trial.reachable.to_string(),
                trial.chosen.to_string(),
                trial.met.to_string(),
                quantile(ratios, 0.5),
                frugal.to_string(),
                quantile(ratios, 1.0),
            ]
        })
    }

    fn about_times(&self) -> String {
        let ratios = &self.ratios;
        let near = ratios.iter().filter(|ratio| (*ratio - 1.0).abs() <= NEAR).count();
        format!(
            "Times of {} pictures, predicted from what {} others of the same scene took: {near} are within {} %; predicted \
             over measured is {} at the tenth part, {} in the median and {} at the nine tenths.",
            ratios.len(),
            CALIBRATION_STEPS.len(),
            100.0 * NEAR,
            quantile(ratios, 0.1),
            quantile(ratios, 0.5),
            quantile(ratios, 0.9),
        )
    }
}

/// A section of Markdown; nothing where no random scene was measured.
pub fn goal_tables(study: &Study) -> String {
    let Some(fares) = Fares::of(study) else { return String::new() };
    let about = fares.about("`--target-error`", "*Met*", "*Price*");
    let mut text = format!(
        "\n## Settings for an error\n\n{about}\n\n| {} |\n|---|---|---|---|---|---|---|\n",
        headings().join(" | ")
    );
    for row in fares.rows() {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    let _ = writeln!(text, "\n{}", fares.about_times());
    text
}

/// The same as HTML.
pub fn goal_section(study: &Study) -> String {
    let Some(fares) = Fares::of(study) else { return String::new() };
    let about = fares.about("<code>--target-error</code>", "<em>Met</em>", "<em>Price</em>");
    let mut html = format!(
        "<h2>Settings for an error</h2><p>{about}</p>\n<table id=\"goals\"><tr><th>{}</tr>\n",
        headings().join("<th>")
    );
    for row in fares.rows() {
        let _ = writeln!(html, "<tr><td class=\"n\">{}</tr>", row.join("<td class=\"n\">"));
    }
    let _ = writeln!(html, "</table><p>{}</p>", fares.about_times());
    html
}

fn quantile(sorted: &[f64], share: f64) -> String {
    let place = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
    sorted.get(place).map_or("-".to_owned(), |ratio| format!("{ratio:.2}"))
}

/// What a device would be measured by, had it this scene to render.
fn calibration(scene: &SceneResults) -> Calibration {
    let mut calibration = Calibration::default();
    for (quality, treatment) in CALIBRATION_STEPS {
        let step = LadderStep { rung: Rung::of(quality), treatment };
        if let Some(point) = steps(scene).find(|point| point.name == step.to_string()) {
            calibration.add(step, point.passes.iter().map(|(pass, time)| (pass.clone(), time.median)).collect());
        }
    }
    calibration
}
