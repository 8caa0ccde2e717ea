//! From what a user asks for to batches of walks.

use super::exposure::Stop;
use super::film::Film;

/// Walks in a batch where there are enough of them. The first random numbers of a batch share a lattice, which wants
/// many; the standard error wants many batches.
const WALKS_PER_BATCH: u64 = 16;
/// Walks for each pixel where nothing is said.
const DEFAULT_WALKS: u64 = 256;
/// Most walks for each pixel where only an error is asked for.
const MOST_WALKS: u64 = 1 << 20;

/// How many walks a pixel gets, and in which portions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Walks in each batch.
    pub walks_per_batch: u64,
    most_batches: u64,
    relative_error: Option<f64>,
}

impl Sampling {
    /// So many walks for each pixel (at least 2), fewer where the relative error asked for is reached before. A number
    /// that batches of 16 do not divide is rounded up.
    pub fn new(walks: Option<u64>, relative_error: Option<f64>) -> Self {
        let walks = walks.unwrap_or(if relative_error.is_some() { MOST_WALKS } else { DEFAULT_WALKS }).max(2);
        let walks_per_batch = (walks / WALKS_PER_BATCH).clamp(1, WALKS_PER_BATCH);
        Self { walks_per_batch, most_batches: walks.div_ceil(walks_per_batch), relative_error }
    }

    /// When to stop.
    pub fn stop(&self) -> Stop {
        Stop { most_batches: self.most_batches, relative_error: self.relative_error }
    }

    /// Most walks for each pixel.
    pub fn most_walks(&self) -> u64 {
        self.most_batches * self.walks_per_batch
    }

    /// For a solver that draws nothing at random: two batches, whose agreement says so.
    pub fn without_noise() -> Self {
        Self { walks_per_batch: 1, most_batches: 2, relative_error: None }
    }

    /// How many batches each pixel will have had in the end, as far as can be told.
    pub fn expected_batches(&self, film: &Film) -> u64 {
        let wanted = match self.relative_error {
            Some(target) if film.goal > 0 => film.goal as f64 * (film.relative_error() / target).powi(2),
            _ => self.most_batches as f64,
        };
        (wanted.ceil() as u64).clamp(film.goal, self.most_batches.max(film.goal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_walks_gives_at_least_two_batches_and_no_fewer_walks() {
        for walks in 2..2000 {
            let sampling = Sampling::new(Some(walks), None);
            let given = sampling.most_walks();
            assert!(sampling.most_batches >= 2 && given >= walks && given < walks + WALKS_PER_BATCH, "{walks}");
        }
    }
}
