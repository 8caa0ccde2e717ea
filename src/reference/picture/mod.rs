//! Pictures by the reference: pixels gathered in batches, with standard errors, on one machine or many.

mod camera_view;
mod checkpoint;
mod exposure;
mod film;
mod identity;
mod part;
mod sampling;

pub use camera_view::CameraView;
pub use checkpoint::{CheckpointError, load, path_for, save};
pub use exposure::{Observer, Outcome, Stop, Subject, expose};
pub use film::{Film, FilmError, PixelMean, Shard};
pub use identity::{Fingerprint, Identity};
pub use part::{Part, PartError, merge, read_part, write_part};
pub use sampling::Sampling;
