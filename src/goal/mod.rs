//! Settings for a goal: a user names an error or a time, and what was measured says which settings come there.
//!
//! Errors are found by trying settings on the scene at hand ([`search`]); where there is no device, or no time for it, they are
//! predicted from scenes that are like it ([`predicted_error`]). Times follow from a short measurement of the scene on its device
//! ([`Calibration`]). All know the steps of [`LadderStep`]; the numbers that predictions start from are made by `welkin report
//! --learn` and lie beside this file.

mod error_model;
mod measured;
mod search;
mod time_model;
mod trial;

use std::fmt;

use crate::plan::{LadderStep, SceneKind, SceneTraits, Treatment};

pub use error_model::predicted_error;
pub use measured::{MeasuredFront, MeasuredScene};
pub use search::{SearchError, search};
pub use time_model::{CALIBRATION_STEPS, Calibration, PassTimes, total_ms};
pub use trial::{TargetTrial, time_ratios};

/// What a user asks for instead of a quality.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// Root mean square of the relative error of radiance over the picture, above 0.
    TargetError(f64),
    /// Time of a first picture with all of its tables on the device, ms, above 0.
    BudgetMs(f64),
}

/// As in `an error of 2 %` or `4 ms`.
impl fmt::Display for Goal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TargetError(error) => write!(formatter, "an error of {} %", rounded(100.0 * error)),
            Self::BudgetMs(milliseconds) => write!(formatter, "{milliseconds} ms"),
        }
    }
}

/// The settings for a goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The settings.
    pub step: LadderStep,
    /// What their error on this scene is predicted not to exceed; none where no scene like it was measured.
    pub error: Option<f64>,
    /// What they are predicted to take, ms, where the device was measured.
    pub milliseconds: Option<f64>,
}

impl fmt::Display for Choice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.step)?;
        if let Some(error) = self.error {
            write!(formatter, ", predicted error at most {} %", rounded(100.0 * error))?;
        }
        match self.milliseconds {
            Some(milliseconds) => write!(formatter, ", predicted time {} ms", rounded(milliseconds)),
            None => Ok(()),
        }
    }
}

/// Why there are no settings for a goal.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GoalError {
    /// No scene of the kind was measured.
    #[error("errors in scenes with {} have not been measured; ask for --quality or --budget-ms", kind.name())]
    NotMeasured {
        /// The kind.
        kind: SceneKind,
    },
    /// Nothing that was measured is predicted to come so close.
    #[error("no settings are predicted to come within {} % of the truth in this scene; the closest are {closest}", rounded(100.0 * .target))]
    TooClose {
        /// The error that was asked for.
        target: f64,
        /// The settings with the smallest predicted error.
        closest: Choice,
    },
    /// The cheapest settings take longer.
    #[error("the cheapest settings take {} ms for this scene on this device: {cheapest}", rounded(.cheapest.milliseconds.unwrap_or(f64::NAN)))]
    TooShort {
        /// The settings that take least.
        cheapest: Choice,
    },
}

/// The cheapest settings whose predicted error is within a target. Without a calibration prices are those of the device on
/// which the front was measured.
///
/// # Errors
/// [`GoalError::NotMeasured`], [`GoalError::TooClose`].
pub fn within_error(
    front: &MeasuredFront,
    scene: &SceneTraits,
    target: f64,
    calibration: Option<&Calibration>,
) -> Result<Choice, GoalError> {
    let choices: Vec<Choice> = choices(front, scene, calibration).filter(|choice| choice.error.is_some()).collect();
    let error = |choice: &Choice| choice.error.unwrap_or(f64::INFINITY);
    let price = |choice: &Choice| choice.milliseconds.unwrap_or_else(|| front.milliseconds(scene.kind, choice.step));
    let fitting = choices.iter().filter(|choice| error(choice) <= target);
    let closest = choices.iter().min_by(|a, b| error(a).total_cmp(&error(b)));
    match (fitting.min_by(|a, b| price(a).total_cmp(&price(b))), closest) {
        (Some(choice), _) => Ok(*choice),
        (None, Some(closest)) => Err(GoalError::TooClose { target, closest: *closest }),
        (None, None) => Err(GoalError::NotMeasured { kind: scene.kind }),
    }
}

/// The most accurate settings that take no longer than a budget: those with the smallest predicted error, or the dearest
/// where no scene like this one was measured.
///
/// # Errors
/// [`GoalError::TooShort`].
pub fn within_time(
    front: &MeasuredFront,
    scene: &SceneTraits,
    budget_ms: f64,
    calibration: &Calibration,
) -> Result<Choice, GoalError> {
    let choices: Vec<Choice> = choices(front, scene, Some(calibration)).collect();
    let price = |choice: &Choice| choice.milliseconds.unwrap_or(f64::INFINITY);
    // The dearer of two with no prediction, or the same, is the more accurate.
    let merit = |choice: &Choice| (-choice.error.unwrap_or(f64::INFINITY), price(choice));
    let better = |a: &&Choice, b: &&Choice| {
        let (a, b) = (merit(a), merit(b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    };
    let cheapest = choices.iter().min_by(|a, b| price(a).total_cmp(&price(b)));
    match (choices.iter().filter(|choice| price(choice) <= budget_ms).max_by(better), cheapest) {
        (Some(choice), _) => Ok(*choice),
        (None, Some(cheapest)) => Err(GoalError::TooShort { cheapest: *cheapest }),
        // The front lists the steps of the ladder, so there always is a cheapest.
        (None, None) => Err(GoalError::NotMeasured { kind: scene.kind }),
    }
}

/// Every step that is worth choosing, with what is predicted of it. The isotropic series is not: at the price of harmonics
/// it has ten times their error.
fn choices<'a>(
    front: &'a MeasuredFront,
    scene: &'a SceneTraits,
    calibration: Option<&'a Calibration>,
) -> impl Iterator<Item = Choice> + 'a {
    front.steps().into_iter().filter(|step| step.treatment != Treatment::IsotropicSeries).map(move |step| Choice {
        step,
        error: predicted_error(front, scene, step),
        milliseconds: calibration.and_then(|calibration| calibration.predicted_ms(front, step)),
    })
}

/// Two significant digits.
fn rounded(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let scale = 10_f64.powi(1 - value.abs().log10().floor() as i32);
    (value * scale).round() / scale
}

#[cfg(test)]
mod tests;
