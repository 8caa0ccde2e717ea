//! How much work an answer is worth.

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effort {
    /// After this many walks (or marches) for each ray.
    Walks(u64),
    /// When one standard error is below this share of the radiance in every band.
    RelativeError(f64),
}
