//! How many pixels the sky is computed in, so that a frame takes no longer than its budget.

use std::time::{Duration, Instant};

/// The coarsest picture, as a share of the window's side.
pub const LEAST: f64 = 0.1;

/// Time without change after which the picture is computed once in every pixel of the window.
const REST: Duration = Duration::from_millis(300);

/// Changes of the scale below this are not worth new images.
const DEAD_ZONE: f64 = 0.12;

/// Finds the scale that holds a budget from what frames have taken.
#[derive(Debug, Clone)]
pub struct Resolution {
    /// Milliseconds that a frame may take while anything moves.
    pub budget_ms: f64,
    /// A scale of the user's, in place of the one that is found.
    pub fixed: Option<f64>,
    found: f64,
    changed: Instant,
}

impl Resolution {
    /// Starts small: the first frame of an unknown device must not take long.
    pub fn new(budget_ms: f64, now: Instant) -> Self {
        Self { budget_ms, fixed: None, found: 0.25, changed: now }
    }

    /// The scene has changed: pictures are to come fast.
    pub fn touch(&mut self, now: Instant) {
        self.changed = now;
    }

    /// Whether nothing has changed for a while, so that there is time for every pixel.
    pub fn is_at_rest(&self, now: Instant) -> bool {
        now.duration_since(self.changed) >= REST
    }

    /// When it will be at rest.
    pub fn rests_at(&self) -> Instant {
        self.changed + REST
    }

    /// Share of the window's side, in ]0, 1].
    pub fn scale(&self) -> f64 {
        self.fixed.unwrap_or(self.found)
    }

    /// Learns from a frame of a scale: milliseconds of passes that go with the pixels, and of all others.
    pub fn learn(&mut self, scale: f64, pixels_ms: f64, others_ms: f64) {
        // Where tables alone take the budget, pixels get a quarter of it: less would not show what has changed.
        let left_ms = (self.budget_ms - others_ms).max(0.25 * self.budget_ms);
        let wanted = (scale * (left_ms / pixels_ms.max(1e-3)).sqrt()).clamp(LEAST, 1.0);
        if (wanted / self.found - 1.0).abs() > DEAD_ZONE || wanted == 1.0 {
            self.found = wanted;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs frames on a device that takes so long for all pixels of the window and for tables, and says the last frame's
    /// time and scale.
    fn settled(full_ms: f64, tables_ms: f64) -> (f64, f64) {
        let mut resolution = Resolution::new(33.0, Instant::now());
        for _ in 0..20 {
            let scale = resolution.scale();
            resolution.learn(scale, full_ms * scale * scale, tables_ms);
        }
        let scale = resolution.scale();
        (full_ms * scale * scale + tables_ms, scale)
    }

    #[test]
    fn the_budget_is_held_on_any_device() {
        for full_ms in [40.0, 200.0, 900.0, 3000.0] {
            let (frame_ms, scale) = settled(full_ms, 5.0);
            // The dead zone lets the scale stay 12 % too large, and its pixels 25 % too many.
            assert!(frame_ms < 33.0 * 1.26, "{full_ms} ms: {frame_ms} ms at {scale}");
            assert!(frame_ms > 33.0 * 0.7, "{full_ms} ms: only {frame_ms} ms at {scale}");
        }
        assert_eq!(settled(10.0, 1.0).1, 1.0, "a fast device has every pixel");
        assert!(settled(900.0, 500.0).1 >= LEAST, "tables beyond the budget leave a picture");
    }

    #[test]
    fn every_pixel_comes_when_nothing_moves() {
        let start = Instant::now();
        let mut resolution = Resolution::new(33.0, start);
        assert!(!resolution.is_at_rest(start + Duration::from_millis(100)));
        assert!(resolution.is_at_rest(resolution.rests_at()));
        resolution.touch(start + Duration::from_secs(1));
        assert!(!resolution.is_at_rest(start + Duration::from_secs(1)));
    }
}
