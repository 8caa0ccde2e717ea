//! How long one submission may keep the queue from others that share it.

use std::collections::{BTreeSet, HashMap};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use super::context::lock;
use super::timer::DispatchTime;

/// Share of a dispatch's workgroups that are run first where nobody knows how long they take.
const FIRST_SHARE: u32 = 64;

/// Most pieces of a dispatch: where each submission waits for a busy machine, more would only add to it.
const MOST_PIECES: u32 = 48;

/// How far one measurement may move an estimate, as a factor: others' work in between disturbs the clock.
const LARGEST_CORRECTION: f64 = 4.0;

/// Cuts recordings into submissions of a certain time, so that a queue which draws a user interface as well never makes it
/// wait for longer. A dispatch that takes longer is run in pieces of its workgroups; short ones share a submission. It
/// learns from what it runs. Clones are the same pace.
#[derive(Clone)]
pub struct Pace(Arc<Inner>);

struct Inner {
    piece_ms: f64,
    /// Milliseconds of a workgroup, by the dispatch's label.
    workgroup_ms: Mutex<HashMap<String, f64>>,
    stopped: AtomicBool,
}

impl Pace {
    /// Submissions of about that time.
    pub fn new(piece: Duration) -> Self {
        let piece_ms = piece.as_secs_f64() * 1e3;
        Self(Arc::new(Inner { piece_ms, workgroup_ms: Mutex::default(), stopped: AtomicBool::new(false) }))
    }

    /// Ends the recording that is being run, and all later ones, after the piece at hand with
    /// [`super::GpuError::Stopped`].
    pub fn stop(&self) {
        self.0.stopped.store(true, Ordering::Release);
    }

    /// Lets later recordings run again.
    pub fn resume(&self) {
        self.0.stopped.store(false, Ordering::Release);
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.0.stopped.load(Ordering::Acquire)
    }

    /// How much of what is left of a dispatch fits a piece: `rows` of `all`.
    pub(crate) fn portion(&self, label: &str, piece: &Piece, [rows, all]: [u32; 2], row_workgroups: u64) -> Portion {
        let Some(&workgroup_ms) = lock(&self.0.workgroup_ms).get(label) else {
            return Portion { rows: all.div_ceil(FIRST_SHARE).min(rows), milliseconds: 0.0, ends_piece: true };
        };
        let row_ms = workgroup_ms * row_workgroups as f64;
        let room = ((self.0.piece_ms - piece.milliseconds) / row_ms).floor();
        let least = all.div_ceil(MOST_PIECES).min(rows);
        let room = room.clamp(f64::from(least), f64::from(rows)) as u32;
        let milliseconds = row_ms * f64::from(room);
        Portion { rows: room, milliseconds, ends_piece: piece.milliseconds + milliseconds >= 0.9 * self.0.piece_ms }
    }

    /// Learns how long a piece has taken.
    pub(crate) fn learn(&self, piece: &Piece, took: Duration) {
        let milliseconds = took.as_secs_f64() * 1e3;
        let mut known = lock(&self.0.workgroup_ms);
        let unknown: u64 =
            piece.parts.iter().filter(|part| !known.contains_key(&part.label)).map(|part| part.workgroups).sum();
        if unknown > 0 {
            let left_ms = (milliseconds - piece.milliseconds).max(0.1 * milliseconds);
            for part in &piece.parts {
                known.entry(part.label.clone()).or_insert(left_ms / unknown as f64);
            }
            return;
        }
        let correction = (milliseconds / piece.milliseconds).clamp(1.0 / LARGEST_CORRECTION, LARGEST_CORRECTION);
        // What took longer is cut shorter at once; what took less is believed by half.
        let correction = if correction < 1.0 { correction.sqrt() } else { correction };
        let labels: BTreeSet<_> = piece.parts.iter().map(|part| &part.label).collect();
        for label in labels {
            known.entry(label.clone()).and_modify(|workgroup_ms| *workgroup_ms *= correction);
        }
    }
}

/// What of a dispatch is run next, in rows of workgroups along its longest axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Portion {
    pub(crate) rows: u32,
    /// What they are expected to take; 0 where nobody knows.
    pub(crate) milliseconds: f64,
    /// Whether nothing more should be put into the piece.
    pub(crate) ends_piece: bool,
}

/// Workgroups of one label, and what they are expected to take.
struct Part {
    label: String,
    workgroups: u64,
    milliseconds: f64,
}

/// What has been recorded since the last submission.
#[derive(Default)]
pub(crate) struct Piece {
    parts: Vec<Part>,
    /// What all of it is expected to take.
    milliseconds: f64,
}

impl Piece {
    pub(crate) fn add(&mut self, label: &str, workgroups: u64, milliseconds: f64) {
        match self.parts.last_mut().filter(|part| part.label == label) {
            Some(part) => {
                (part.workgroups, part.milliseconds) = (part.workgroups + workgroups, part.milliseconds + milliseconds)
            }
            None => self.parts.push(Part { label: label.to_owned(), workgroups, milliseconds }),
        }
        self.milliseconds += milliseconds;
    }

    /// What each part has taken of the time of all, as far as can be told: in the ratio of what was expected, and what
    /// nobody knew before has the rest.
    pub(crate) fn times(&self, took: Duration) -> impl Iterator<Item = DispatchTime> + '_ {
        let took_ms = took.as_secs_f64() * 1e3;
        let unknown = self.parts.iter().any(|part| part.milliseconds == 0.0);
        let rest_ms = (took_ms - self.milliseconds).max(0.0);
        self.parts.iter().map(move |part| {
            let milliseconds = match unknown {
                true if part.milliseconds == 0.0 => rest_ms,
                true => part.milliseconds.min(took_ms),
                false => took_ms * part.milliseconds / self.milliseconds,
            };
            DispatchTime { label: part.label.clone(), milliseconds }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs a dispatch of rows that take so many milliseconds each, and says what each piece took.
    fn pieces(pace: &Pace, all: u32, row_ms: f64) -> Vec<f64> {
        let mut rows = all;
        let mut taken = Vec::new();
        let mut piece = Piece::default();
        let mut in_piece = 0;
        while rows > 0 {
            let portion = pace.portion("pass", &piece, [rows, all], 10);
            piece.add("pass", 10 * u64::from(portion.rows), portion.milliseconds);
            (rows, in_piece) = (rows - portion.rows, in_piece + portion.rows);
            if portion.ends_piece || rows == 0 {
                let took = row_ms * f64::from(in_piece);
                pace.learn(&std::mem::take(&mut piece), Duration::from_secs_f64(took * 1e-3));
                taken.push(took);
                in_piece = 0;
            }
        }
        taken
    }

    #[test]
    fn long_work_comes_in_pieces_of_the_time_asked_for() {
        let pace = Pace::new(Duration::from_millis(8));
        let taken = pieces(&pace, 300, 1.0);
        // The first portion, of which nothing is known, is a sixty-fourth.
        assert_eq!(taken[0], 5.0);
        assert!(taken[1..].iter().all(|&ms| ms <= 8.0) && taken.len() < 48, "{taken:?}");
    }

    #[test]
    fn work_that_has_become_longer_is_cut_shorter() {
        let pace = Pace::new(Duration::from_millis(8));
        pieces(&pace, 300, 0.1);
        let taken = pieces(&pace, 300, 1.0);
        assert!(taken.last().unwrap() <= &10.0 && taken[taken.len() - 2] <= 10.0, "{taken:?}");
        assert!(taken[0] > 20.0, "the control: at first it believed in the old time");
    }

    #[test]
    fn very_long_work_comes_in_not_too_many_pieces() {
        let pace = Pace::new(Duration::from_millis(8));
        pieces(&pace, 960, 10.0);
        assert_eq!(pieces(&pace, 960, 10.0), [200.0; 48]);
    }

    #[test]
    fn short_work_shares_a_submission_once_it_is_known() {
        let pace = Pace::new(Duration::from_millis(8));
        pieces(&pace, 100, 0.01);
        assert_eq!(pieces(&pace, 100, 0.01).len(), 1);
    }
}
