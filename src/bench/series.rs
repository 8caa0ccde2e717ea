//! Repeated measurements, and how they grow with size.

use serde::Serialize;

/// Repeated measurements of one thing.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Series {
    /// In the order in which they were taken.
    pub values: Vec<f64>,
}

impl Series {
    /// The value in the middle; NaN of nothing.
    pub fn median(&self) -> f64 {
        self.quantile(0.5)
    }

    /// Half of the width of the middle half, over the median: how far runs differ.
    pub fn spread(&self) -> f64 {
        0.5 * (self.quantile(0.75) - self.quantile(0.25)) / self.median()
    }

    fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
        let place = share * last as f64;
        let below = place.floor() as usize;
        sorted[below] + (place - place.floor()) * (sorted[(below + 1).min(last)] - sorted[below])
    }
}

/// A power law through costs: where they bend away from it, something else than size decides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Fit {
    /// Of size, in cost ∝ size^exponent: least squares of logarithms.
    pub exponent: f64,
    /// Largest factor between a cost and the law.
    pub bend: f64,
}

impl Fit {
    /// Of costs by size, both positive; none of fewer than two sizes.
    pub fn of(points: &[(f64, f64)]) -> Option<Self> {
        let n = points.len() as f64;
        let logs: Vec<_> = points.iter().map(|(size, cost)| (size.ln(), cost.ln())).collect();
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let variance: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
        if points.len() < 2 || variance == 0.0 {
            return None;
        }
        let exponent = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / variance;
        let residual = logs.iter().map(|p| (p.1 - y - exponent * (p.0 - x)).abs()).fold(0.0, f64::max);
        Some(Self { exponent, bend: residual.exp() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_stands_in_the_middle_whatever_the_worst_does() {
        let series = Series { values: vec![3.0, 1.0, 2.0, 1000.0] };
        assert_eq!(series.median(), 2.5);
        assert!(Series::default().median().is_nan());
    }

    #[test]
    fn a_power_law_is_found_and_a_bend_is_seen() {
        let law = |sizes: [f64; 4]| sizes.map(|size: f64| (size, 3.0 * size.powf(0.8)));
        let fit = Fit::of(&law([1.0, 4.0, 16.0, 64.0])).unwrap();
        assert!((fit.exponent - 0.8).abs() < 1e-12 && (fit.bend - 1.0).abs() < 1e-12);
        let bent = law([1.0, 4.0, 16.0, 64.0]).map(|(size, cost)| (size, cost + 20.0));
        // By hand: the line through the logarithms of 23, 29.1, 47.6 and 103.6 has a slope of 0.361 and is off by 1.1506 at most.
        let fit = Fit::of(&bent).unwrap();
        assert!((fit.exponent - 0.3611).abs() < 1e-4 && (fit.bend - 1.1506).abs() < 1e-4);
        assert_eq!(Fit::of(&[(1.0, 1.0)]), None);
    }
}
