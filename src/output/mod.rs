//! Files that pictures become.

pub mod display;
