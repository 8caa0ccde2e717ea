//! A phase function given as a table, for instance from Mie theory.

use std::f64::consts::PI;

use super::monotone_cubic::{Interval, monotone_slopes};
use super::{PhaseError, inversion, quadrature};

/// Pieces into which each step of a table is cut. Eight follow a fall by a factor of four to 1e-4.
const PIECES: usize = 8;

/// A table of (cos θ, P), joined by monotone cubics in cos θ and scaled to ∫P dω = 1.
///
/// A monotone cubic passes through every point and never overshoots between two of them, so it stays non-negative.
/// Where all points are positive, ln P is joined first and each step of the table cut into pieces along that curve,
/// because a peak that falls to a third within a step is far from a cubic but near to an exponential. P itself is then
/// a cubic on each piece; its integral is a quartic, so the normalisation is exact and the sampling inverts the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct TabulatedPhase {
    cos_theta: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
    /// Share of the light further back than each point.
    cumulative: Vec<f64>,
    table_integral: f64,
}

impl TabulatedPhase {
    /// A table from points (cos θ, P in 1/sr or any other unit), cos θ strictly rising or falling between -1 and 1.
    ///
    /// # Errors
    /// [`PhaseError::TablePoint`] for a point out of order, out of range or not finite; [`PhaseError::Table`] where an
    /// end is missing or the table holds no light.
    pub fn from_points(points: &[(f64, f64)]) -> Result<Self, PhaseError> {
        let mut points = points.to_vec();
        let falling = points.len() > 1 && points[0].0 > points[1].0;
        check(&points, falling)?;
        if falling {
            points.reverse();
        }
        let (cos_theta, mut value) = refine(&points);
        let mut slope = monotone_slopes(&cos_theta, &value);
        let mut cumulative = vec![0.0];
        for i in 1..cos_theta.len() {
            let h = cos_theta[i] - cos_theta[i - 1];
            let integral = h * (value[i - 1] + value[i]) / 2.0 + h * h * (slope[i - 1] - slope[i]) / 12.0;
            cumulative.push(cumulative[i - 1] + integral);
        }
        let total = cumulative[cumulative.len() - 1];
        let table_integral = 2.0 * PI * total;
        if !(table_integral > 0.0 && table_integral.is_finite()) {
            return Err(whole(format!("its integral over the sphere is {table_integral}; it must be positive")));
        }
        value.iter_mut().chain(&mut slope).for_each(|v| *v /= table_integral);
        cumulative.iter_mut().for_each(|share| *share /= total);
        Ok(Self { cos_theta, value, slope, cumulative, table_integral })
    }

    /// A table from CSV text with a header line: the column `theta_deg` (degrees) or `cos_theta`, and the column
    /// `phase_per_sr`. Other columns are free.
    ///
    /// # Errors
    /// [`PhaseError::TableLine`] with the line and what it should have held; [`PhaseError::Table`] as above.
    pub fn from_csv(text: &str) -> Result<Self, PhaseError> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let headers = reader.headers().map_err(|error| at_line(1, error.to_string()))?.clone();
        let column = |name: &str| headers.iter().position(|header| header == name);
        let phase = column("phase_per_sr").ok_or_else(|| at_line(1, "it has no column 'phase_per_sr'".into()))?;
        let (angle, in_degrees) = match (column("theta_deg"), column("cos_theta")) {
            (Some(theta), _) => (theta, true),
            (None, Some(cos)) => (cos, false),
            (None, None) => return Err(at_line(1, "it has neither a column 'theta_deg' nor 'cos_theta'".into())),
        };
        let (mut points, mut lines) = (Vec::new(), Vec::new());
        for record in reader.records() {
            let record = record.map_err(|error| whole(error.to_string()))?;
            let line = record.position().map_or(0, |position| position.line() as usize);
            let number = |column: usize| {
                let (name, field) = (&headers[column], &record[column]);
                field.parse::<f64>().map_err(|_| at_line(line, format!("{name} is '{field}'; it must be a number")))
            };
            let angle = number(angle)?;
            points.push((if in_degrees { cos_of_degrees(angle) } else { angle }, number(phase)?));
            lines.push(line);
        }
        Self::from_points(&points).map_err(|error| match error {
            PhaseError::TablePoint { point, problem } => at_line(lines[point - 1], problem),
            other => other,
        })
    }

    /// ∫P dω of the table as it was given, before it was scaled to 1. Far from 1 for a table in 1/sr, the table is
    /// wrong or too coarse for its peak.
    pub fn table_integral(&self) -> f64 {
        self.table_integral
    }

    /// The curve's points (cos θ rising from -1 to 1, P in 1/sr), scaled: the table's and those between.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.cos_theta.iter().copied().zip(self.value.iter().copied())
    }

    /// P(cos θ), 1/sr.
    pub fn value(&self, cos_theta: f64) -> f64 {
        let above = self.cos_theta.partition_point(|&c| c <= cos_theta).clamp(1, self.cos_theta.len() - 1);
        let h = self.cos_theta[above] - self.cos_theta[above - 1];
        let t = ((cos_theta - self.cos_theta[above - 1]) / h).clamp(0.0, 1.0);
        self.interval(above).value(t)
    }

    /// cos θ at which the share `u` of the light lies further back.
    pub(super) fn sample(&self, u: f64) -> f64 {
        let above = self.cumulative.partition_point(|&share| share <= u).clamp(1, self.cumulative.len() - 1);
        let interval = self.interval(above);
        let target = (u - self.cumulative[above - 1]) / (2.0 * PI);
        let t = invert_interval(&interval, target);
        (self.cos_theta[above - 1] + interval.h * t).min(1.0)
    }

    /// χ_l; exact to l = 28, where the rule's degree ends, and beyond it on any table whose steps resolve P_l.
    pub(super) fn legendre_moment(&self, l: usize) -> f64 {
        let panel = |above: usize| {
            let interval = self.interval(above);
            let start = self.cos_theta[above - 1];
            let moment = |t: f64| interval.value(t) * quadrature::legendre(l, start + interval.h * t);
            interval.h * quadrature::integrate_panel(0.0, 1.0, moment)
        };
        2.0 * PI * (1..self.cos_theta.len()).map(panel).sum::<f64>()
    }

    fn interval(&self, above: usize) -> Interval {
        Interval {
            h: self.cos_theta[above] - self.cos_theta[above - 1],
            value: [self.value[above - 1], self.value[above]],
            slope: [self.slope[above - 1], self.slope[above]],
        }
    }
}

/// The points and, where all are positive, points between them on the monotone cubic through (cos θ, ln P).
fn refine(points: &[(f64, f64)]) -> (Vec<f64>, Vec<f64>) {
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    if y.contains(&0.0) {
        return (x, y);
    }
    let log: Vec<f64> = y.iter().map(|y| y.ln()).collect();
    let slopes = monotone_slopes(&x, &log);
    let (mut fine_x, mut fine_y) = (vec![x[0]], vec![y[0]]);
    for i in 1..x.len() {
        let h = x[i] - x[i - 1];
        let curve = Interval { h, value: [log[i - 1], log[i]], slope: [slopes[i - 1], slopes[i]] };
        for piece in 1..PIECES {
            let t = piece as f64 / PIECES as f64;
            fine_x.push(x[i - 1] + h * t);
            fine_y.push(curve.value(t).exp());
        }
        fine_x.push(x[i]);
        fine_y.push(y[i]);
    }
    (fine_x, fine_y)
}

/// The t at which the interval's integral reaches `target`.
fn invert_interval(interval: &Interval, target: f64) -> f64 {
    let total = interval.integral(1.0);
    inversion::invert_increasing(target / total, |t| {
        (interval.integral(t) / total, interval.h * interval.value(t) / total)
    })
}

/// cos of an angle in degrees, exactly -1, 0 and 1 at 180, 90 and 0.
fn cos_of_degrees(theta_deg: f64) -> f64 {
    ((90.0 - theta_deg).to_radians()).sin()
}

fn point(point: usize, problem: String) -> PhaseError {
    PhaseError::TablePoint { point, problem }
}

fn at_line(line: usize, problem: String) -> PhaseError {
    PhaseError::TableLine { line, problem }
}

fn whole(problem: String) -> PhaseError {
    PhaseError::Table { problem }
}

fn check(points: &[(f64, f64)], falling: bool) -> Result<(), PhaseError> {
    if points.len() < 2 {
        return Err(whole(format!("it has {} points; it must have at least 2", points.len())));
    }
    for (i, &(cos_theta, value)) in points.iter().enumerate() {
        if !(-1.0..=1.0).contains(&cos_theta) {
            return Err(point(i + 1, format!("cos θ is {cos_theta}; it must lie in [-1, 1]")));
        }
        if !(value.is_finite() && value >= 0.0) {
            return Err(point(i + 1, format!("the phase function is {value}; it must be finite and at least 0")));
        }
        let in_order = |previous: f64| if falling { previous > cos_theta } else { previous < cos_theta };
        if i > 0 && !in_order(points[i - 1].0) {
            return Err(point(i + 1, "the angles must all rise or all fall".into()));
        }
    }
    let (first, last) = (points[0].0, points[points.len() - 1].0);
    if first.min(last) != -1.0 || first.max(last) != 1.0 {
        return Err(whole(format!("it spans cos θ from {first} to {last}; it must span [-1, 1]")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_passes_through_its_points_and_never_overshoots() {
        let points = [(-1.0, 1.0), (-0.4, 1.0), (0.3, 5.0), (0.5, 5.0), (0.9, 0.0), (1.0, 20.0)];
        let phase = TabulatedPhase::from_points(&points).unwrap();
        for pair in points.windows(2) {
            let at = |c: f64| phase.value(c) * phase.table_integral();
            assert!((at(pair[0].0) - pair[0].1).abs() < 1e-14 && (at(pair[1].0) - pair[1].1).abs() < 1e-13);
            for step in 0..=50 {
                let value = at(pair[0].0 + (pair[1].0 - pair[0].0) * f64::from(step) / 50.0);
                let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
                assert!(value >= low - 1e-13 && value <= high + 1e-13, "{value} leaves [{low}, {high}]");
            }
        }
    }

    #[test]
    fn sampling_a_table_inverts_its_own_integral() {
        let points: Vec<_> = (0..=60).map(|i| f64::from(i) / 30.0 - 1.0).map(|c| (c, (3.0 * c).exp())).collect();
        let phase = TabulatedPhase::from_points(&points).unwrap();
        for step in 0..=200 {
            let u = f64::from(step) / 200.0;
            let c = phase.sample(u);
            let share = 2.0
                * PI
                * (0..400)
                    .map(|i| {
                        let (a, b) =
                            (-1.0 + (c + 1.0) * f64::from(i) / 400.0, -1.0 + (c + 1.0) * f64::from(i + 1) / 400.0);
                        quadrature::integrate_panel(a, b, |x| phase.value(x))
                    })
                    .sum::<f64>();
            // The panels of 1/200 straddle the points, where the cubic's second derivative jumps.
            assert!((share - u).abs() < 1e-7, "u = {u}: {share}");
        }
    }

    #[test]
    fn an_impossible_table_is_refused_with_its_line() {
        let message = |text: &str| TabulatedPhase::from_csv(text).unwrap_err().to_string();
        assert!(message("theta_deg,phase_per_sr\n0,1\n90,x\n180,1\n").contains("line 3: phase_per_sr is 'x'"));
        assert!(message("theta_deg,phase_per_sr\n0,1\n90,-1\n180,1\n").contains("line 3"));
        assert!(message("theta_deg,phase_per_sr\n0,1\n90,1\n80,1\n180,1\n").contains("line 4"));
        assert!(message("theta_deg,phase_per_sr\n0,1\n90,1\n").contains("must span [-1, 1]"));
        assert!(message("theta_deg,phase_per_sr\n0,0\n180,0\n").contains("must be positive"));
        assert!(message("theta_deg,p\n0,0\n180,0\n").contains("no column 'phase_per_sr'"));
        assert!(message("angle,phase_per_sr\n0,0\n180,0\n").contains("neither a column"));
        assert!(message("theta_deg,phase_per_sr\n0,1\n180\n").contains("line"));
    }
}
