//! An error or a time instead of a quality, and the settings that come there.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::Args;
use serde::Serialize;
use welkin::goal::{CALIBRATION_STEPS, Calibration, Choice, Goal, GoalError, MeasuredFront, within_error, within_time};
use welkin::output::AtomicFile;
use welkin::plan::{LadderStep, Outputs, Rung, SceneKind, SceneTraits, Settings};
use welkin::reference::picture::Fingerprint;
use welkin::renderer::Renderer;
use welkin::scene::Scene;

use super::Failure;
use super::accuracy::Accuracy;
use super::backend::{cache_folder, failure};
use super::limit::positive;

/// A goal.
#[derive(Debug, Args)]
pub struct GoalArguments {
    /// The cheapest settings whose error is predicted to be at most this, as in 0.02: root mean square of the relative error
    /// of radiance over the picture
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
            return Ok(Chosen {
                settings: accuracy.settings(),
                name: accuracy.quality().name().to_owned(),
                goal: None,
            });
        };
        let (front, traits) = (MeasuredFront::built_in(), SceneTraits::of(scene));
        let choice = match (goal, renderer) {
            (Goal::TargetError(target), _) => within_error(front, &traits, target, None),
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

/// Times of a few settings for a scene on a device, from the cache or measured now.
fn calibration(renderer: &mut Renderer, scene: &Scene, outputs: Outputs) -> Result<Calibration, Failure> {
    let path = calibration_file(renderer, scene, outputs);
    let kept = path.as_ref().and_then(|path| std::fs::read_to_string(path).ok());
    // One that cannot be read is made again.
    if let Some(calibration) = kept.and_then(|text| serde_json::from_str(&text).ok()) {
        return Ok(calibration);
    }
    eprintln!("measuring the device with {} settings", CALIBRATION_STEPS.len());
    let mut calibration = Calibration::default();
    for (quality, treatment) in CALIBRATION_STEPS {
        let step = LadderStep { rung: Rung::of(quality), treatment };
        calibration.add(step, renderer.step_times(scene, step, outputs).map_err(failure)?);
    }
    if let Some(path) = path {
        keep(&path, &calibration).unwrap_or_else(|error| tracing::warn!("the measurement is not kept: {error:#}"));
    }
    Ok(calibration)
}

fn keep(path: &Path, calibration: &Calibration) -> anyhow::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder '{}'", folder.display()))?;
    }
    Ok(AtomicFile::create(path)?.write_all(serde_json::to_string(calibration)?.as_bytes())?)
}

/// One file for each device, driver, program, and all of a scene that its time depends on.
fn calibration_file(renderer: &Renderer, scene: &Scene, outputs: Outputs) -> Option<PathBuf> {
    let (info, camera) = (renderer.gpu().info(), &scene.camera);
    let device = (&info.name, &info.driver, &info.driver_version, env!("CARGO_PKG_VERSION"));
    let sky = (scene.medium.constituents.len(), scene.lights.len(), scene.spectrum.group_count());
    // What stands in clear air costs as much wherever one looks; clouds and mountains do not.
    let seen = match SceneTraits::of(scene).kind {
        SceneKind::Clear => String::new(),
        SceneKind::Terrain | SceneKind::Clouds | SceneKind::Fog => format!("{scene:?}"),
    };
    let key = Fingerprint::of(&format!("{:?}", (device, sky, (camera.width, camera.height), outputs, seen)));
    Some(cache_folder()?.join(format!("calibration-{key}.json")))
}
