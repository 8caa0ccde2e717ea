//! Inverting a cumulative distribution that has no closed inverse.

/// The x in [0, 1] at which an increasing function reaches `target`, to rounding.
///
/// `f` returns value and slope. Newton's method, with a bisection whenever a step would leave the bracket; so it ends
/// where the slope vanishes, too. A target outside the function's range gives the nearer end.
pub(super) fn invert_increasing(target: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    // Bisection alone would end after 53 steps at the resolution of x near 1.
    const MAX_STEPS: usize = 128;
    let (mut low, mut high) = (0.0, 1.0);
    let mut x = target.clamp(0.0, 1.0);
    for _ in 0..MAX_STEPS {
        let (value, slope) = f(x);
        let excess = value - target;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - excess / slope;
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= f64::EPSILON * x {
            return next;
        }
        x = next;
    }
    x
}
