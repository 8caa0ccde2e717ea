//! Files that pictures become.

mod atomic_file;
pub mod display;
mod error;
mod exr_channel;
mod exr_file;
mod png_file;
pub mod screen;

pub use atomic_file::AtomicFile;
pub use error::OutputError;
pub use exr_channel::{DEPTH_CHANNELS, Plane, read_exr_channel};
pub use exr_file::{ExrHeader, read_exr, read_exr_with_header, write_exr, write_exr_with_header};
pub use png_file::write_png;
