//! What frames and their passes cost: processor time, repeated, in turn.
//!
//! Times are those that all threads of the process have worked, so that a machine which others keep busy says nearly the
//! same as a quiet one; with a driver that computes on the CPU they hold the device's work too. On a GPU they are the
//! host's share alone, and the passes' times are the device's.

mod frames;
mod growth;
mod motion;
mod passes;
mod series;
mod start;
mod stopwatch;
mod work;

pub use frames::{FrameCase, FrameCost, frame_costs};
pub use growth::{Growth, growth_of_frames, growth_of_reference, growth_of_tables};
pub use motion::Motion;
pub use passes::{PassCost, pass_costs};
pub use series::{Fit, Series};
pub use start::{Start, start};
pub use stopwatch::{Stopwatch, peak_memory_bytes};
pub use work::{WorkCost, bake_cost, reference_cost};
