//! Whether settings that are chosen for an error or a time keep their promise, on the random scenes of a study.

use std::fmt::Write as _;

use super::distance;
use super::learn::{self, steps};
use super::results::{SceneResults, Study};
use crate::goal::{
    CALIBRATION_STEPS, Calibration, Choice, MeasuredFront, MeasuredScene, TargetTrial, search, time_ratios,
};
use crate::plan::{LadderStep, Rung};

/// The errors that are asked for.
const TARGETS: [f64; 5] = [0.005, 0.01, 0.02, 0.05, 0.1];
/// What a choice may cost beside the cheapest settings that would have done.
const FRUGAL: f64 = 1.5;
/// How far a predicted time may be off.
const NEAR: f64 = 0.2;

/// What the columns of the table are.
fn headings() -> [String; 9] {
    let frugal = format!("at most {FRUGAL}");
    ["target %", "reachable", "chosen", "met", "as measured", "missed", "price: median", &frugal, "most"]
        .map(str::to_owned)
}

/// How choices fare on the random scenes of a study.
struct Fares {
    scenes: usize,
    /// Found on each scene by its own pictures.
    found: Vec<TargetTrial>,
    /// Predicted from the other random scenes.
    predicted: Vec<TargetTrial>,
    /// Predicted over measured times, in order.
    ratios: Vec<f64>,
}

impl Fares {
    /// None where hardly any random scene was measured.
    fn of(study: &Study) -> Option<Self> {
        let random: Vec<&SceneResults> = study.scenes.iter().filter(|scene| scene.random).collect();
        let scenes: Vec<MeasuredScene> = random.iter().map(|scene| learn::measured(scene)).collect();
        // A single scene has no others whose prices and errors could be learned.
        if scenes.len() < 2 {
            return None;
        }
        let front = &learn::learn(study);
        let calibrations: Vec<Calibration> = random.iter().map(|scene| calibration(scene)).collect();
        let choose = |target: f64| {
            let of = |name: &str| random.iter().find(|scene| scene.scene == name);
            TargetTrial::of_choices(&scenes, target, |scene| found(front, of(&scene.name)?, target))
        };
        Some(Self {
            scenes: scenes.len(),
            found: TARGETS.map(choose).into(),
            predicted: TARGETS.map(|target| TargetTrial::of_predictions(front, &scenes, target)).into(),
            ratios: time_ratios(front, &scenes, &calibrations),
        })
    }

    /// What the table says; the option's name and *words* are marked by the caller.
    fn about(&self, option: &str, [met, measured, missed, price]: [&str; 4]) -> String {
        format!(
            "{option} on {} random scenes, each tried on its own pictures; nothing is learned from the others but the order of \
             prices. {met}: the error of the chosen settings, a standard error of the truth included, is within the target; {measured}: \
             it is without that standard error; {missed}: even a standard error less is beyond it; of the others the truth's noise does not tell. {price}: time over that of \
             the cheapest settings that would have met it.",
            self.scenes
        )
    }

    fn rows(&self) -> impl Iterator<Item = [String; 9]> + '_ {
        self.found.iter().map(|trial| {
            let ratios = &trial.price_ratios;
            [
                (100.0 * trial.target).to_string(),
                trial.reachable.to_string(),
                trial.chosen.to_string(),
                trial.met.to_string(),
                trial.met_as_measured.to_string(),
                trial.missed.to_string(),
                quantile(ratios, 0.5),
                frugal(ratios).to_string(),
                quantile(ratios, 1.0),
            ]
        })
    }

    /// All targets in one sentence.
    fn in_sum(&self) -> String {
        let sum = |trials: &[TargetTrial]| {
            let of = |count: fn(&TargetTrial) -> usize| trials.iter().map(count).sum::<usize>();
            let [chosen, met, missed] = [of(|trial| trial.chosen), of(|trial| trial.met), of(|trial| trial.missed)];
            let measured = of(|trial| trial.met_as_measured);
            let [priced, cheap] = [of(|trial| trial.price_ratios.len()), of(|trial| frugal(&trial.price_ratios))];
            format!(
                "{chosen} choices, of which {met} met their target, {measured} as measured, and {missed} missed it; of {priced} with a price {cheap} cost at \
                 most {FRUGAL} times the cheapest"
            )
        };
        format!(
            "Together: {}. Without a device, predicted from those of the others that are like each: {}.",
            sum(&self.found),
            sum(&self.predicted)
        )
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

fn frugal(ratios: &[f64]) -> usize {
    ratios.iter().filter(|ratio| **ratio <= FRUGAL).count()
}

/// What a search on the scene would find, from the pictures that were measured, in the order of what the other scenes cost.
fn found(front: &MeasuredFront, scene: &SceneResults, target: f64) -> Option<Choice> {
    let mut front = front.clone();
    front.scenes.retain(|other| other.name != scene.scene);
    let picture = |step: LadderStep| scene.pictures.get(&step.to_string());
    let dearest = scene.pictures.keys().filter_map(|name| LadderStep::from_name(name)).map(|step| step.rung).max()?;
    let price = |step| front.milliseconds(scene.traits.kind, step);
    let apart = |step, finest| {
        let (ours, other) = picture(step).zip(picture(finest)).ok_or(())?;
        distance(ours, other, scene.channels, &vec![false; ours.len()]).ok_or(())
    };
    search(target, dearest, price, apart).ok()
}

/// A section of Markdown; nothing where no random scene was measured.
pub fn goal_tables(study: &Study) -> String {
    let Some(fares) = Fares::of(study) else { return String::new() };
    let about = fares.about("`--target-error`", ["*Met*", "*as measured*", "*missed*", "*Price*"]);
    let mut text = format!(
        "\n## Settings for an error\n\n{about}\n\n| {} |\n|---|---|---|---|---|---|---|---|---|\n",
        headings().join(" | ")
    );
    for row in fares.rows() {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    let _ = writeln!(text, "\n{}\n\n{}", fares.in_sum(), fares.about_times());
    text
}

/// The same as HTML.
pub fn goal_section(study: &Study) -> String {
    let Some(fares) = Fares::of(study) else { return String::new() };
    let about = fares.about(
        "<code>--target-error</code>",
        ["<em>Met</em>", "<em>as measured</em>", "<em>missed</em>", "<em>Price</em>"],
    );
    let mut html = format!(
        "<h2>Settings for an error</h2><p>{about}</p>\n<table id=\"goals\"><tr><th>{}</tr>\n",
        headings().join("<th>")
    );
    for row in fares.rows() {
        let _ = writeln!(html, "<tr><td class=\"n\">{}</tr>", row.join("<td class=\"n\">"));
    }
    let _ = writeln!(html, "</table><p>{}</p><p>{}</p>", fares.in_sum(), fares.about_times());
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
