//! What decides about the settings of pictures: a quality that the user names, an error, or a time.
//!
//! For an error and a time the settings are chosen by what was measured ([`crate::goal`]), as `welkin render` chooses them. They are
//! chosen when nothing moves and stay while anything does: a flight through changing air would else compile shaders all the
//! way. A time has to be measured on the device first, for a window of this size.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::goal::{
    CALIBRATION_STEPS, Calibration, Choice, Goal, GoalError, MeasuredFront, PassTimes, within_error, within_time,
};
use crate::plan::{LadderStep, Rung, SceneKind, SceneTraits};
use crate::scene::Scene;

/// What decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Aim {
    /// The quality.
    #[default]
    Quality,
    /// The target error.
    Error,
    /// The time of a picture.
    Time,
}

impl Aim {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Quality, Self::Error, Self::Time];

    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quality => "quality",
            Self::Error => "error",
            Self::Time => "time",
        }
    }
}

/// What of a view its times depend on most. Times of another view of the kind are taken for this one's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    kind: SceneKind,
    constituents: usize,
    lights: usize,
    clouds: usize,
    groups: usize,
    size: [u32; 2],
}

impl Load {
    /// Of a scene in a window of so many pixels.
    pub fn of(scene: &Scene, size: [u32; 2]) -> Self {
        Self {
            kind: SceneTraits::of(scene).kind,
            constituents: scene.medium.constituents.len(),
            lights: scene.lights.len(),
            clouds: scene.clouds.len(),
            groups: scene.spectrum.group_count(),
            size,
        }
    }
}

/// Settings for a goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// The settings; none where nothing that was measured is like the scene.
    pub step: Option<LadderStep>,
    /// What is predicted of them, or why the goal is not met.
    pub words: String,
    /// Whether they are predicted to meet the goal.
    pub is_met: bool,
}

impl Chosen {
    /// Where nothing is known of the device.
    fn unknown() -> Self {
        Self { step: None, words: "the device could not be measured for this view".to_owned(), is_met: false }
    }
}

impl From<Result<Choice, GoalError>> for Chosen {
    fn from(result: Result<Choice, GoalError>) -> Self {
        let words = match &result {
            Ok(choice) => choice.to_string(),
            Err(error) => error.to_string(),
        };
        let is_met = result.is_ok();
        let step = match result {
            Ok(choice) => Some(choice.step),
            // As near as one comes.
            Err(GoalError::TooClose { closest, .. }) => Some(closest.step),
            Err(GoalError::TooShort { cheapest }) => Some(cheapest.step),
            Err(GoalError::NotMeasured { .. }) => None,
        };
        Self { step, words, is_met }
    }
}

/// Times of the steps that are measured, for a load.
#[derive(Debug, Default)]
enum Measurement {
    #[default]
    None,
    UnderWay(Load, Calibration),
    Done(Load, Calibration),
    Failed(Load),
}

/// Chooses, and remembers for what.
#[derive(Debug, Default)]
pub struct Chooser {
    chosen: Option<(Goal, Arc<Scene>, [u32; 2], Chosen)>,
    measurement: Measurement,
}

impl Chooser {
    /// The last choice for a goal.
    pub fn chosen(&self, goal: Goal) -> Option<&Chosen> {
        self.chosen.as_ref().filter(|(for_goal, ..)| *for_goal == goal).map(|(.., chosen)| chosen)
    }

    /// The settings to show pictures with: those of the last choice for a goal of the kind, however far it was, until there is
    /// another.
    pub fn step(&self, goal: Goal) -> Option<LadderStep> {
        let same_kind = |other: &Goal| std::mem::discriminant(other) == std::mem::discriminant(&goal);
        self.chosen.as_ref().filter(|(other, ..)| same_kind(other)).and_then(|(.., chosen)| chosen.step)
    }

    /// Chooses for a scene that has come to rest in a window of so many pixels. Where the device must be measured first, says
    /// for what, once.
    pub fn choose(&mut self, goal: Goal, scene: &Arc<Scene>, size: [u32; 2]) -> Option<Load> {
        let same = |(of_goal, of_scene, of_size, _): &(Goal, Arc<Scene>, [u32; 2], Chosen)| {
            (*of_goal, of_scene, *of_size) == (goal, scene, size)
        };
        if self.chosen.as_ref().is_some_and(same) {
            return None;
        }
        let (front, traits) = (MeasuredFront::built_in(), SceneTraits::of(scene));
        let chosen: Chosen = match goal {
            Goal::TargetError(target) => within_error(front, &traits, target, None).into(),
            Goal::BudgetMs(budget_ms) => {
                let wanted = Load::of(scene, size);
                match &self.measurement {
                    Measurement::Done(load, times) if *load == wanted => {
                        within_time(front, &traits, budget_ms, times).into()
                    }
                    Measurement::Failed(load) if *load == wanted => Chosen::unknown(),
                    Measurement::UnderWay(load, _) if *load == wanted => return None,
                    _ => {
                        self.measurement = Measurement::UnderWay(wanted, Calibration::default());
                        return Some(wanted);
                    }
                }
            }
        };
        self.chosen = Some((goal, scene.clone(), size, chosen));
        None
    }

    /// The steps that are measured.
    pub fn steps() -> impl Iterator<Item = LadderStep> {
        CALIBRATION_STEPS.into_iter().map(|(quality, treatment)| LadderStep { rung: Rung::of(quality), treatment })
    }

    /// How many steps of how many have been measured; none where no measurement is under way.
    pub fn progress(&self) -> Option<[usize; 2]> {
        match &self.measurement {
            Measurement::UnderWay(_, times) => Some([times.passes.len(), CALIBRATION_STEPS.len()]),
            _ => None,
        }
    }

    /// Takes in what a step took for a load; none where it could not be measured. A measurement of another load is over.
    pub fn learn(&mut self, load: Load, step: LadderStep, times: Option<PassTimes>) {
        let Measurement::UnderWay(wanted, calibration) = &mut self.measurement else { return };
        if *wanted != load {
            return;
        }
        let Some(times) = times else {
            self.measurement = Measurement::Failed(load);
            return;
        };
        calibration.add(step, times);
        if calibration.passes.len() == CALIBRATION_STEPS.len() {
            self.measurement = Measurement::Done(load, std::mem::take(calibration));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn noon() -> Arc<Scene> {
        Arc::new(Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/noon.toml")).unwrap())
    }

    const SIZE: [u32; 2] = [640, 400];

    /// Gives a chooser the times of a device on which `medium` takes four times as long as `low`.
    fn measure(chooser: &mut Chooser, load: Load) {
        for (index, step) in Chooser::steps().enumerate() {
            assert_eq!(chooser.progress(), Some([index, 4]));
            let milliseconds = if step.rung == Rung::of(crate::plan::Quality::Low) { 10.0 } else { 40.0 };
            chooser.learn(load, step, Some(PassTimes::from([("sky_view".to_owned(), milliseconds)])));
        }
        assert_eq!(chooser.progress(), None);
    }

    #[test]
    fn a_smaller_error_takes_dearer_settings_and_one_that_nothing_reaches_the_closest() {
        let (mut chooser, noon) = (Chooser::default(), noon());
        let mut step = |error: f64| {
            let goal = Goal::TargetError(error);
            assert_eq!(chooser.choose(goal, &noon, SIZE), None, "an error needs no measurement");
            chooser.chosen(goal).unwrap().clone()
        };
        let (front, traits) = (MeasuredFront::built_in(), SceneTraits::of(&noon));
        let Err(GoalError::TooClose { closest, .. }) = within_error(front, &traits, 1e-6, None) else {
            panic!("reached")
        };
        let [coarse, fine, never] = [0.2, closest.error.unwrap(), 1e-6].map(&mut step);
        assert!(coarse.is_met && fine.is_met && coarse.step != fine.step, "{coarse:?} {fine:?}");
        assert!(!never.is_met && never.step == Some(closest.step) && never.words.contains("no settings"), "{never:?}");
        // They are those of `welkin render`.
        let choice = within_error(front, &traits, 0.2, None).unwrap();
        assert_eq!((coarse.step, coarse.words), (Some(choice.step), choice.to_string()));
        assert_eq!(chooser.chosen(Goal::TargetError(0.3)), None, "no choice for another goal");
        assert_eq!(chooser.step(Goal::TargetError(0.3)), never.step, "but its settings stay until there is one");
        assert_eq!(chooser.step(Goal::BudgetMs(10.0)), None);
    }

    #[test]
    fn a_time_is_measured_once_for_a_window_and_then_buys_what_fits() {
        let (mut chooser, noon) = (Chooser::default(), noon());
        let load = chooser.choose(Goal::BudgetMs(1e5), &noon, SIZE).unwrap();
        assert_eq!(chooser.choose(Goal::BudgetMs(1e5), &noon, SIZE), None, "it is under way");
        measure(&mut chooser, load);
        let mut step = |budget_ms: f64| {
            let goal = Goal::BudgetMs(budget_ms);
            assert_eq!(chooser.choose(goal, &noon, SIZE), None);
            chooser.chosen(goal).unwrap().clone()
        };
        let [rich, poor, none] = [1e5, 45.0, 1.0].map(&mut step);
        assert!(rich.is_met && poor.is_met && poor.step.unwrap().rung < rich.step.unwrap().rung);
        assert!(!none.is_met && none.words.contains("cheapest"), "{none:?}");
        // Another size is another measurement, and times of the old one are not taken for it.
        let other = chooser.choose(Goal::BudgetMs(45.0), &noon, [320, 200]).unwrap();
        chooser.learn(load, Chooser::steps().next().unwrap(), Some(PassTimes::new()));
        assert_eq!(chooser.progress(), Some([0, 4]));
        // One that fails is not tried again and again.
        chooser.learn(other, Chooser::steps().next().unwrap(), None);
        assert_eq!(chooser.choose(Goal::BudgetMs(45.0), &noon, [320, 200]), None);
        assert_eq!(chooser.progress(), None);
        assert_eq!(chooser.chosen(Goal::BudgetMs(45.0)), Some(&Chosen::unknown()));
    }
}
