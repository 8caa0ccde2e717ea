//! Settings for an error, tried on the scene itself.
//!
//! An a posteriori estimate: pictures of one scene differ from each other by their errors alone. How far a picture is from that of
//! much finer settings is its error, up to that of the finer one; and that is about what the last refinement has changed. The two
//! have little in common, so that their squares add up.

use super::{Choice, GoalError};
use crate::plan::{LadderStep, Quality, Rung, Treatment};

/// What the finest picture's own error may be of the target, where there is a finer one.
const FINEST_SHARE: f64 = 0.5;

/// By how much errors are taken to be larger than they are found: the estimate is off by about as much, both ways.
const MARGIN: f64 = 1.1;

/// How many times its target the error of a picture is where that of the next finer one is not worth finding out: a quality up has
/// at most quartered errors in the scenes that were measured.
const HOPELESS: f64 = 30.0;

/// Qualities whose source function pictures are held against, and those whose distance from them shows their own error.
const FINEST: [(Quality, Quality); 2] = [(Quality::High, Quality::Medium), (Quality::Ultra, Quality::High)];

/// Why a search has found no settings.
#[derive(Debug, Clone, PartialEq)]
pub enum SearchError<E> {
    /// None were found to come so close.
    Goal(GoalError),
    /// A picture could not be made.
    Picture(E),
}

/// The cheapest settings up to `dearest` whose error on a scene is found to be within a target.
///
/// `price` orders the steps; infinite where it is not known. `distance` renders the scene at two steps, and tells how far the first
/// picture is from the second: root of the mean squared relative difference of radiance.
///
/// # Errors
/// [`GoalError::TooClose`]; those of the pictures.
pub fn search<E>(
    target: f64,
    dearest: Rung,
    price: impl Fn(LadderStep) -> f64,
    mut distance: impl FnMut(LadderStep, LadderStep) -> Result<f64, E>,
) -> Result<Choice, SearchError<E>> {
    let (finest, own) = finest(target, dearest, &mut distance).map_err(SearchError::Picture)?;
    let own = MARGIN * own;
    let choice = |step, error| Choice { step, error: Some(error), milliseconds: None };
    // Nothing that is held against a picture is known better than that.
    if own > target {
        return Err(SearchError::Goal(GoalError::TooClose { target, closest: choice(finest, own) }));
    }
    for step in by_price(dearest, price).into_iter().take_while(|step| *step != finest) {
        let error = own.hypot(MARGIN * distance(step, finest).map_err(SearchError::Picture)?);
        if error <= target {
            return Ok(choice(step, error));
        }
    }
    Ok(choice(finest, own))
}

/// The steps worth trying, from the cheapest. Harmonics are not on the dear rungs: the source function's cheapest costs less than
/// they do there, and is closer.
fn by_price(dearest: Rung, price: impl Fn(LadderStep) -> f64) -> Vec<LadderStep> {
    let dearest_of = |treatment| match treatment {
        Treatment::IsotropicSeries => None,
        Treatment::Harmonics => Some(dearest.min(Rung::of(Quality::High))),
        Treatment::SourceFunction => Some(dearest),
    };
    let mut steps = LadderStep::all();
    steps.retain(|step| dearest_of(step.treatment).is_some_and(|dearest| step.rung <= dearest));
    steps.sort_by(|a, b| price(*a).total_cmp(&price(*b)));
    steps
}

/// The picture that others are held against, and its own error.
fn finest<E>(
    target: f64,
    dearest: Rung,
    distance: &mut impl FnMut(LadderStep, LadderStep) -> Result<f64, E>,
) -> Result<(LadderStep, f64), E> {
    let step = |quality| LadderStep { rung: Rung::of(quality), treatment: Treatment::SourceFunction };
    let mut found = (step(FINEST[0].0), f64::INFINITY);
    for (quality, below) in FINEST.into_iter().filter(|(quality, _)| Rung::of(*quality) <= dearest) {
        found = (step(quality), distance(step(below), step(quality))?);
        if found.1 <= FINEST_SHARE * target || found.1 > HOPELESS * target {
            break;
        }
    }
    Ok(found)
}
