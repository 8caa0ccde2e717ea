//! Exposing a film: rounds of batches on all cores until enough have been gathered or somebody interrupts.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use welkin_lut::Bands;

use super::film::Film;
use crate::output::OutputError;

/// Batches of the first round, from which the error is first estimated.
const FIRST_BATCHES: u64 = 8;

/// Pixels between two moments at which the state is whole and can be saved.
const STRIDE: usize = 4096;

/// What a film is exposed to.
pub trait Subject: Sync {
    /// One pixel's ray, prepared for any number of batches.
    type Ray;

    /// Prepares the ray of a pixel of the picture.
    fn ray(&self, pixel: usize) -> Self::Ray;

    /// Mean radiance over one batch of walks. A pure function of pixel and batch: batches are independent estimates.
    fn batch(&self, ray: &Self::Ray, batch: u64) -> Bands;
}

/// When a film has been exposed enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Most batches of a pixel.
    pub most_batches: u64,
    /// The [`Film::relative_error`] that is good enough.
    pub relative_error: Option<f64>,
}

impl Stop {
    fn is_reached(&self, film: &Film) -> bool {
        film.goal >= self.most_batches
            || self.relative_error.is_some_and(|target| film.goal > 0 && film.relative_error() <= target)
    }

    /// The goal after the present one. Errors fall with the square root of the batches; the tenth on top mostly saves
    /// a further round, and no round more than doubles the work, because the first estimates are rough.
    fn next_goal(&self, film: &Film) -> u64 {
        if film.goal == 0 {
            return FIRST_BATCHES.min(self.most_batches);
        }
        let wanted = self
            .relative_error
            .map_or(f64::INFINITY, |target| 1.1 * film.goal as f64 * (film.relative_error() / target).powi(2));
        (wanted.min(1e18).ceil() as u64).clamp(film.goal + 1, 2 * film.goal).min(self.most_batches)
    }
}

/// Who watches an exposure and may end it.
pub trait Observer: Sync {
    /// Batches were added, from any thread.
    fn advanced(&self, batches: u64);

    /// Nothing is being added at the moment: the film can be saved. `level` at the end of a round.
    ///
    /// # Errors
    /// Whatever goes wrong ends the exposure.
    fn paused(&self, film: &Film, level: bool) -> Result<(), OutputError>;

    /// Set to end the exposure early.
    fn interrupted(&self) -> &AtomicBool;
}

/// How an exposure ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The film has been exposed enough.
    Done,
    /// It was interrupted; another exposure goes on where this one ended, to the same result.
    Interrupted,
}

/// Exposes a film until `stop`. Decisions are taken only where all pixels have the same number of batches, so they
/// depend neither on threads nor on interruptions.
///
/// # Errors
/// Those of [`Observer::paused`].
pub fn expose<S: Subject>(
    subject: &S,
    film: &mut Film,
    stop: &Stop,
    observer: &impl Observer,
) -> Result<Outcome, OutputError> {
    loop {
        if film.is_level() {
            observer.paused(film, true)?;
            if stop.is_reached(film) {
                return Ok(Outcome::Done);
            }
            film.goal = stop.next_goal(film);
        }
        for start in (0..film.pixels.len()).step_by(STRIDE) {
            round(subject, film, start, observer);
            observer.paused(film, false)?;
            if observer.interrupted().load(Ordering::Relaxed) {
                return Ok(Outcome::Interrupted);
            }
        }
    }
}

/// Brings [`STRIDE`] pixels from `start` on to the goal.
fn round<S: Subject>(subject: &S, film: &mut Film, start: usize, observer: &impl Observer) {
    let (goal, shard) = (film.goal, film.shard);
    let end = film.pixels.len().min(start + STRIDE);
    film.pixels[start..end].par_iter_mut().enumerate().for_each(|(i, mean)| {
        let interrupted = || observer.interrupted().load(Ordering::Relaxed);
        if mean.batches >= goal || interrupted() {
            return;
        }
        let ray = subject.ray(shard.pixel(start + i));
        let before = mean.batches;
        while mean.batches < goal && !interrupted() {
            mean.add(subject.batch(&ray, mean.batches));
        }
        observer.advanced(mean.batches - before);
    });
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU64;

    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use welkin_lut::BAND_COUNT;

    use super::super::film::Shard;
    use super::*;

    /// Pixel p has mean p + 1 and batches uniform within 50 % of it.
    struct Noise;

    impl Subject for Noise {
        type Ray = usize;

        fn ray(&self, pixel: usize) -> usize {
            pixel
        }

        fn batch(&self, &pixel: &usize, batch: u64) -> Bands {
            let mut random = Pcg64Mcg::seed_from_u64(pixel as u64 * 1_000_003 + batch);
            std::array::from_fn(|_| (pixel as f64 + 1.0) * (0.5 + random.next_u32() as f64 * 0.5_f64.powi(32)))
        }
    }

    /// Interrupts after so many batches.
    struct Patience {
        left: AtomicU64,
        over: AtomicBool,
    }

    impl Patience {
        fn of(batches: u64) -> Self {
            Self { left: AtomicU64::new(batches), over: AtomicBool::new(false) }
        }
    }

    impl Observer for Patience {
        fn advanced(&self, batches: u64) {
            if self.left.fetch_sub(batches, Ordering::Relaxed) <= batches {
                self.over.store(true, Ordering::Relaxed);
            }
        }

        fn paused(&self, _: &Film, _: bool) -> Result<(), OutputError> {
            Ok(())
        }

        fn interrupted(&self) -> &AtomicBool {
            &self.over
        }
    }

    const STOP: Stop = Stop { most_batches: 40, relative_error: None };

    fn straight(stop: &Stop) -> Film {
        let mut film = Film::new(Shard::WHOLE, 200);
        assert_eq!(expose(&Noise, &mut film, stop, &Patience::of(u64::MAX)).unwrap(), Outcome::Done);
        film
    }

    #[test]
    fn an_interrupted_exposure_goes_on_to_the_same_film() {
        let mut film = Film::new(Shard::WHOLE, 200);
        let mut interruptions = 0;
        while expose(&Noise, &mut film, &STOP, &Patience::of(700)).unwrap() == Outcome::Interrupted {
            interruptions += 1;
            assert!(interruptions < 100, "it makes no progress");
        }
        assert!(interruptions > 3, "it was hardly interrupted");
        assert_eq!(film, straight(&STOP));
    }

    #[test]
    fn one_thread_and_three_expose_the_same_film() {
        let with_threads = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| straight(&STOP))
        };
        assert_eq!(with_threads(1), with_threads(3));
    }

    #[test]
    fn it_stops_at_the_error_asked_for_and_the_error_is_true() {
        let target = 0.02;
        let film = straight(&Stop { most_batches: 1 << 20, relative_error: Some(target) });
        assert!(film.relative_error() <= target && film.goal < 1000, "{} after {}", film.relative_error(), film.goal);
        // The batches' standard deviation is 1/√12, so the batches that reach the target are known: 208.
        assert!((150..420).contains(&film.goal), "{} batches", film.goal);
        // 600 deviates from the true mean in units of the standard error: their mean square is 1 ± √(2/600).
        let deviates = film.pixels.iter().enumerate().flat_map(|(i, pixel)| {
            let (error, level) = (pixel.standard_error(), i as f64 + 1.0);
            (0..BAND_COUNT).map(move |j| ((pixel.mean[j] - level) / error[j]).powi(2)).collect::<Vec<_>>()
        });
        let mean_square = deviates.sum::<f64>() / 600.0;
        assert!((mean_square - 1.0).abs() < 4.0 * (2.0_f64 / 600.0).sqrt(), "{mean_square}");
    }

    #[test]
    fn shards_expose_the_pixels_of_the_whole() {
        let whole = straight(&STOP);
        for index in 0..3 {
            let shard = Shard { index, count: 3 };
            let mut film = Film::new(shard, 200);
            expose(&Noise, &mut film, &STOP, &Patience::of(u64::MAX)).unwrap();
            for (number, pixel) in film.pixels.iter().enumerate() {
                assert_eq!(*pixel, whole.pixels[shard.pixel(number)]);
            }
        }
    }
}
