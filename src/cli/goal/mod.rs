//! An error or a time instead of a quality, and the settings that come there.

mod calibration;
mod kept;
mod trial;

use clap::Args;
use serde::Serialize;
use welkin::goal::{Choice, Goal, GoalError, MeasuredFront, within_error, within_time};
use welkin::plan::{Outputs, SceneTraits, Settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

use super::Failure;
use super::accuracy::Accuracy;
use super::limit::positive;
use calibration::calibration;
use trial::found_on_scene;

/// A goal.
#[derive(Debug, Args)]
pub struct GoalArguments {
    /// The cheapest settings whose error is at most this, as in 0.02: root mean square of the relative error of radiance over the
    /// picture. They are tried on the scene, once; without a device the error is predicted from scenes like it
    #[arg(long, value_name = "E", value_parser = positive, conflicts_with_all = ["quality", "multiple_scattering", "budget_ms"])]
    target_error: Option<f64>,
    /// The most accurate settings whose first picture, all tables included, is predicted to take at most so many milliseconds
    /// on the device; measures it shortly where that has not been done before
    #[arg(long, value_name = "MS", value_parser = positive, conflicts_with_all = ["quality", "multiple_scattering"])]
    budget_ms: Option<f64>,
}

/// Settings with the name that they go by.
#[derive(Debug, Clone)]
pub struct Chosen {
    /// In numbers.
    pub settings: Settings,
    /// A quality, or a step of the ladder.
    pub name: String,
    /// Where a goal was asked for.
    pub goal: Option<ChosenFor>,
}

/// How a goal was met, for programs.
#[derive(Debug, Clone, Serialize)]
pub struct ChosenFor {
    /// What was asked for, in words.
    asked: String,
    /// What the error of the settings is predicted not to exceed; null where no scene like it was measured.
    predicted_error: Option<f64>,
    /// What they are predicted to take; null where the device was not measured.
    predicted_milliseconds: Option<f64>,
    /// Where errors were measured.
    measured: String,
}

impl GoalArguments {
    /// Whether each option was given, for backends that heed none.
    pub fn given(&self) -> [(&'static str, bool); 2] {
        [("--target-error", self.target_error.is_some()), ("--budget-ms", self.budget_ms.is_some())]
    }

    fn goal(&self) -> Option<Goal> {
        self.target_error.map(Goal::TargetError).or(self.budget_ms.map(Goal::BudgetMs))
    }

    /// The settings that are asked for, by a goal or by a quality. A budget needs a device to be measured on.
    ///
    /// # Errors
    /// [`Failure::Input`] where nothing that was measured meets the goal; those of the renderer.
    pub fn settings(
        &self,
        accuracy: &Accuracy,
        scene: &Scene,
        outputs: Outputs,
        renderer: Option<&mut Renderer>,
    ) -> Result<Chosen, Failure> {
        let Some(goal) = self.goal() else {
            return Ok(Chosen { settings: accuracy.settings(), name: accuracy.quality().name(), goal: None });
        };
        let (front, traits) = (MeasuredFront::built_in(), SceneTraits::of(scene));
        let choice = match (goal, renderer) {
            (Goal::TargetError(target), Some(renderer)) => found_on_scene(front, renderer, scene, target)?,
            (Goal::TargetError(target), None) => within_error(front, &traits, target, None),
            (Goal::BudgetMs(budget), Some(renderer)) => {
                within_time(front, &traits, budget, &calibration(renderer, scene, outputs)?)
            }
            (Goal::BudgetMs(_), None) => {
                let message =
                    anyhow::anyhow!("a budget is kept on a device, and there is none; ask for --target-error");
                return Err(Failure::NoDevice(message));
            }
        };
        let choice = choice.map_err(|error: GoalError| Failure::Input(error.into()))?;
        eprintln!("settings for {goal}: {choice}");
        Ok(Chosen::new(goal, &choice, front))
    }
}

impl Chosen {
    fn new(goal: Goal, choice: &Choice, front: &MeasuredFront) -> Self {
        let goal = ChosenFor {
            asked: goal.to_string(),
            predicted_error: choice.error,
            predicted_milliseconds: choice.milliseconds,
            measured: front.provenance.clone(),
        };
        Self { settings: choice.step.settings(), name: choice.step.to_string(), goal: Some(goal) }
    }
}
