//! Solver (c): the unbiased path tracer. What one ray sees, by orders of scattering, with standard errors.
//!
//! In stratified air the first event of every walk is forced: its distance along the view ray is drawn from a
//! density close to (scattering × transmittance), so that every walk contributes and the rays' own optical depth
//! carries no noise. Where there are bodies the walks start with delta tracking at the camera.

use glam::DVec3;
use rayon::prelude::*;
use welkin_lut::{BAND_COUNT, Bands};

use super::field::USUAL_STEP;
use super::first_event::FirstEvent;
use super::random::Draw;
use super::sight_line::depth_between;
use super::single::{self, FirstOrder};
use super::spectrum;
use super::tally::{ORDER_BINS, Tally};
use super::walk::{State, Walker};
use super::world::World;

/// How the light of the first order is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FirstOrderBy {
    /// Solver (a) for beams and point lights in stratified air, walks for the rest.
    #[default]
    Quadrature,
    /// Walks alone.
    Walks,
}

/// How many walks, and which.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// Independent batches, from which standard errors are estimated; at least 2.
    pub batches: u64,
    /// Walks in each batch.
    pub walks_per_batch: u64,
    /// Selects the random numbers, with the stream.
    pub seed: u64,
    /// Number of the ray (or pixel), so that rays are independent.
    pub stream: u64,
    /// First batch: batches of the same seed and stream with other numbers are independent.
    pub first_batch: u64,
}

/// What a ray sees and how well it is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Mean, by orders.
    pub mean: Tally,
    /// One standard error of the sum of all orders.
    pub total_error: Bands,
    /// One standard error of light scattered exactly once in the medium.
    pub single_error: Bands,
    /// Walks behind the mean.
    pub walks: u64,
}

/// A ray prepared for any number of walks.
#[derive(Debug)]
pub struct View<'a> {
    world: &'a World,
    position: DVec3,
    direction: DVec3,
    first: FirstOrder,
    first_by: FirstOrderBy,
    event: Option<FirstEvent>,
    reach_m: f64,
}

impl<'a> View<'a> {
    /// The ray from `position` along the unit vector `direction`.
    pub fn new(world: &'a World, position: DVec3, direction: DVec3, first_by: FirstOrderBy) -> Self {
        Self::within(world, position, direction, first_by, f64::INFINITY)
    }

    /// The same ray up to a black surface at the distance `reach_m`: the light that the matter before it sends. The
    /// surface stands on this ray alone; all other light goes its way as if it were not there.
    pub fn within(world: &'a World, position: DVec3, direction: DVec3, first_by: FirstOrderBy, reach_m: f64) -> Self {
        let forced = world.bodies.is_empty() && world.relief.is_none();
        let first = match first_by {
            FirstOrderBy::Quadrature if forced => single::first_order_within(world, position, direction, reach_m, 1e-6),
            _ => FirstOrder::default(),
        };
        let first_by = if forced { first_by } else { FirstOrderBy::Walks };
        let event = if forced { FirstEvent::new(world, position, direction, reach_m) } else { None };
        Self { world, position, direction, first, first_by, event, reach_m }
    }

    /// What quadrature found, or zeros where it was not asked.
    pub fn first_order(&self) -> &FirstOrder {
        &self.first
    }

    /// Runs the budget on all cores. The result does not depend on their number.
    pub fn estimate(&self, budget: &Budget) -> Estimate {
        let batches: Vec<Tally> =
            (0..budget.batches).into_par_iter().map(|batch| self.batch(budget, batch + budget.first_batch)).collect();
        Estimate::from_batches(&batches, budget.walks_per_batch)
    }

    /// The mean over one batch of walks, with the orders that quadrature covers.
    pub fn batch(&self, budget: &Budget, batch: u64) -> Tally {
        let mut walker = Walker::new(self.world, Draw::new(budget.seed, budget.stream, batch));
        let mut sum = Tally::default();
        for index in 0..budget.walks_per_batch {
            walker.draw.start(index);
            self.walk(&mut walker, &mut sum);
        }
        let mut mean = Tally::default();
        mean.add_scaled(&sum, 1.0 / budget.walks_per_batch as f64);
        if self.first_by == FirstOrderBy::Quadrature {
            mean.add(0, false, self.first.unscattered);
            mean.add(1, false, self.first.single.value);
            mean.add(1, true, self.first.ground);
        }
        mean
    }

    fn walk(&self, walker: &mut Walker, tally: &mut Tally) {
        let by_quadrature = self.first_by == FirstOrderBy::Quadrature;
        let mut state = State {
            position: self.position,
            direction: self.direction,
            weight: spectrum::ONE,
            order: 0,
            ground: false,
            pdf_per_sr: None,
            reach_m: self.reach_m,
            reference: BAND_COUNT as f64,
        };
        let Some(event) = self.event.as_ref().filter(|_| by_quadrature) else {
            walker.follow(state, tally);
            return;
        };
        let sample = event.sample(walker.draw.uniform());
        let at = self.position + self.direction * sample.t_m;
        let depth = depth_between(self.world, self.position, self.direction, (event.start_m(), sample.t_m), USUAL_STEP);
        state.weight = spectrum::attenuation(depth);
        let sampled = |light: &_| !single::is_covered(light);
        if sample.on_ground {
            state.weight = state.weight.map(|w| w / sample.probability);
            walker.start_on_ground(state, at, sampled, tally);
        } else {
            walker.start_in_medium(state, at, sample.probability, sampled, tally);
        }
    }
}

impl Estimate {
    /// Mean and standard errors from batch means of equal weight.
    pub fn from_batches(batches: &[Tally], walks_per_batch: u64) -> Self {
        let count = batches.len() as f64;
        let mut mean = Tally::default();
        for batch in batches {
            mean.add_scaled(batch, 1.0 / count);
        }
        let error = |of: &dyn Fn(&Tally) -> Bands| -> Bands {
            let centre = of(&mean);
            let mut squares = [0.0; BAND_COUNT];
            for batch in batches {
                let value = of(batch);
                for j in 0..BAND_COUNT {
                    squares[j] += (value[j] - centre[j]).powi(2);
                }
            }
            squares.map(|s| (s / (count * (count - 1.0))).sqrt())
        };
        let (total_error, single_error) = (error(&Tally::total), error(&|t| t.single));
        Self { mean, total_error, single_error, walks: walks_per_batch * batches.len() as u64 }
    }

    /// The histogram of radiance by order, the last bin for all higher ones.
    pub fn orders(&self) -> &[Bands; ORDER_BINS] {
        &self.mean.orders
    }
}
