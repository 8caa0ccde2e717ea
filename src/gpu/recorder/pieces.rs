//! Recordings in pieces, so that others who use the queue need not wait for the whole.

use std::time::Instant;

use super::{Commands, Portion};
use crate::gpu::descriptors::Descriptors;
use crate::gpu::error::GpuError;
use crate::gpu::pace::Pace;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::timer::Clock;

impl Commands {
    /// Records a dispatch, and submits whenever a piece is full.
    pub(super) fn record_in_pieces(
        &mut self,
        pace: &Pace,
        label: &str,
        pipeline: &Pipeline,
        descriptors: Option<&Descriptors>,
        workgroups: [u32; 3],
    ) -> Result<(), GpuError> {
        let axis = (0..3).max_by_key(|&axis| workgroups[axis]).unwrap_or(0);
        let row_workgroups = workgroups.iter().map(|&n| u64::from(n)).product::<u64>() / u64::from(workgroups[axis]);
        let mut from = 0;
        while from < workgroups[axis] {
            let portion = pace.portion(label, &self.piece, [workgroups[axis] - from, workgroups[axis]], row_workgroups);
            let (mut base, mut count) = ([0; 3], workgroups);
            (base[axis], count[axis]) = (from, portion.rows);
            self.record_portion(label, pipeline, descriptors, Portion::From { base, count })?;
            self.piece.add(label, u64::from(portion.rows) * row_workgroups, portion.milliseconds);
            from += portion.rows;
            if portion.ends_piece {
                self.finish_piece(pace)?;
                self.restart()?;
            }
        }
        Ok(())
    }

    /// Runs a piece and learns how long it took.
    pub(super) fn finish_piece(&mut self, pace: &Pace) -> Result<(), GpuError> {
        if pace.is_stopped() {
            return Err(GpuError::Stopped(self.label.clone()));
        }
        let started = Instant::now();
        self.flush()?;
        let (piece, took) = (std::mem::take(&mut self.piece), started.elapsed());
        if self.clock == Some(Clock::Host) {
            self.piece_times.extend(piece.times(took));
        }
        pace.learn(&piece, took);
        Ok(())
    }
}
