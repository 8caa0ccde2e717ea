//! What is worth its time: points that nothing else beats in both error and time.

use super::results::{Family, Point};

/// Notes for each point what beats it in both; of several the most accurate. Solvers of the reference run elsewhere than
/// the device and are compared among themselves.
pub fn mark_dominated(points: &mut [Point]) {
    let beats = |a: &Point, b: &Point| {
        (a.family == Family::Reference) == (b.family == Family::Reference)
            && a.milliseconds.median < b.milliseconds.median
            && a.error.rms < b.error.rms
    };
    let marks: Vec<Option<String>> = points
        .iter()
        .map(|point| {
            let better = points.iter().filter(|other| beats(other, point));
            better.min_by(|a, b| a.error.rms.total_cmp(&b.error.rms)).map(|other| other.name.clone())
        })
        .collect();
    points.iter_mut().zip(marks).for_each(|(point, mark)| point.dominated_by = mark);
}

/// Whether one point beats another by more than the error bars and the spread of times leave in doubt.
pub fn beats_clearly(a: &Point, b: &Point) -> bool {
    a.milliseconds.third_quartile < b.milliseconds.first_quartile && a.error.high < b.error.low
}

/// The points that nothing beats, cheapest first; of the device alone.
pub fn front(points: &[Point]) -> Vec<&Point> {
    let mut best: Vec<&Point> =
        points.iter().filter(|point| point.family != Family::Reference && point.dominated_by.is_none()).collect();
    best.sort_by(|a, b| a.milliseconds.median.total_cmp(&b.milliseconds.median));
    best
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Deviation;
    use super::super::results::Spread;
    use super::*;

    pub(in crate::report) fn point(name: &str, milliseconds: f64, rms: f64, family: Family) -> Point {
        let error = Deviation {
            rms,
            low: 0.9 * rms,
            high: 1.1 * rms,
            noise: 0.0,
            median: rms,
            p95: rms,
            p99: rms,
            energy_ratio: 1.0,
            pixels: 10,
        };
        Point {
            name: name.to_owned(),
            family,
            preset: None,
            error,
            milliseconds: Spread::of(&[milliseconds]),
            passes: Default::default(),
            dominated_by: None,
        }
    }

    #[test]
    fn the_front_is_what_nothing_beats_in_both() {
        let mut points = vec![
            point("good", 10.0, 0.01, Family::Ladder),
            point("cheap", 1.0, 0.1, Family::Ladder),
            point("bad", 12.0, 0.05, Family::Variation),
            point("walks", 5.0, 0.001, Family::Reference),
        ];
        mark_dominated(&mut points);
        assert_eq!(front(&points).iter().map(|point| point.name.as_str()).collect::<Vec<_>>(), ["cheap", "good"]);
        assert_eq!(points[2].dominated_by.as_deref(), Some("good"));
        assert!(beats_clearly(&points[0], &points[2]) && !beats_clearly(&points[1], &points[0]));
        // Half a per cent more accurate is within the bars.
        assert!(!beats_clearly(&point("a", 1.0, 0.0995, Family::Ladder), &point("b", 2.0, 0.1, Family::Ladder)));
    }
}
