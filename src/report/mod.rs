//! How far one picture is from another.

mod metrics;

pub use metrics::{Comparison, MetricsError, RelativeErrors, compare};
