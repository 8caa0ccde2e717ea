//! Curves through points that never overshoot between two of them.

/// The Hermite cubic between two points; t runs from 0 to 1.
pub(super) struct Interval {
    /// Length of the interval.
    pub h: f64,
    /// Values at both ends.
    pub value: [f64; 2],
    /// Slopes at both ends.
    pub slope: [f64; 2],
}

impl Interval {
    /// The curve.
    pub fn value(&self, t: f64) -> f64 {
        let s = 1.0 - t;
        let ends = self.value[0] * s * s * (1.0 + 2.0 * t) + self.value[1] * t * t * (3.0 - 2.0 * t);
        ends + self.h * s * t * (self.slope[0] * s - self.slope[1] * t)
    }

    /// Its integral over x from the lower end to t.
    pub fn integral(&self, t: f64) -> f64 {
        let (t2, t3, t4) = (t * t, t * t * t, t * t * t * t);
        let ends = self.value[0] * (t - t3 + 0.5 * t4) + self.value[1] * (t3 - 0.5 * t4);
        let slopes = self.slope[0] * (0.5 * t2 - t3 * (2.0 / 3.0) + 0.25 * t4) + self.slope[1] * (0.25 * t4 - t3 / 3.0);
        self.h * (ends + self.h * slopes)
    }
}

/// Slopes that keep the cubic between its points (Fritsch & Butland 1984; at the ends the three-point formula of
/// Moler 2004, "Numerical Computing with MATLAB", chapter 3).
pub(super) fn monotone_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let secant: Vec<f64> = y.windows(2).zip(&h).map(|(pair, h)| (pair[1] - pair[0]) / h).collect();
    if n == 2 {
        return vec![secant[0]; 2];
    }
    let inner = |i: usize| {
        if secant[i - 1] * secant[i] <= 0.0 {
            return 0.0;
        }
        let (w1, w2) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
        (w1 + w2) / (w1 / secant[i - 1] + w2 / secant[i])
    };
    let end = |h0: f64, h1: f64, s0: f64, s1: f64| {
        let slope = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
        if slope * s0 <= 0.0 {
            0.0
        } else if s0 * s1 <= 0.0 && slope.abs() > 3.0 * s0.abs() {
            3.0 * s0
        } else {
            slope
        }
    };
    let mut slopes = vec![end(h[0], h[1], secant[0], secant[1])];
    slopes.extend((1..n - 1).map(inner));
    slopes.push(end(h[n - 2], h[n - 3], secant[n - 2], secant[n - 3]));
    slopes
}
