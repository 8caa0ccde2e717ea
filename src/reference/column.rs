//! Columns of altitude profiles along straight rays: ∫ρ(h(t)) dt for every profile at once.
//!
//! Altitude is cut into panels at the profiles' kinks; a ray's leg through a panel is integrated in distance with a
//! Gauss-Legendre rule whose length is chosen, when the object is made, so that the worst of a set of test legs
//! (grazing, inclined, vertical) has an optical depth within [`TOLERANCE`]. Nothing is tabulated.

use welkin_lut::DensityProfile;

use super::line::Line;
use super::quadrature::GaussLegendre;

/// Largest error of a panel's optical depth, relative where that exceeds 1.
pub const TOLERANCE: f64 = 1e-8;

const RULE_LENGTHS: [usize; 12] = [2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 20, 24];
const LONGEST_RULE: usize = RULE_LENGTHS[RULE_LENGTHS.len() - 1];

/// A profile and the largest extinction coefficient (1/m at density 1) with which its column will be multiplied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weighted {
    /// The profile.
    pub profile: DensityProfile,
    /// Largest coefficient, 1/m.
    pub coefficient_per_m: f64,
}

#[derive(Debug, Clone)]
struct Panel {
    low_m: f64,
    high_m: f64,
    rule: GaussLegendre,
    /// The profiles whose column in this panel is not negligible.
    active: Vec<usize>,
}

/// Integrates a fixed set of profiles along rays over one planet or plane.
#[derive(Debug, Clone)]
pub struct Columns {
    radius_m: f64,
    profiles: Vec<DensityProfile>,
    panels: Vec<Panel>,
}

impl Columns {
    /// Prepares rules for the air between the ground and `height_m`.
    pub fn new(radius_m: f64, height_m: f64, weighted: &[Weighted]) -> Self {
        let mut columns = Self { radius_m, profiles: weighted.iter().map(|w| w.profile).collect(), panels: Vec::new() };
        let mut pending = first_cuts(height_m, weighted);
        pending.reverse();
        while let Some((low_m, high_m)) = pending.pop() {
            match columns.panel(low_m, high_m, weighted) {
                Some(panel) => columns.panels.push(panel),
                None => {
                    let middle = 0.5 * (low_m + high_m);
                    pending.push((middle, high_m));
                    pending.push((low_m, middle));
                }
            }
        }
        columns
    }

    /// Altitudes at which the integrand may have a kink, m, ascending.
    pub fn cuts_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.panels.iter().map(|p| p.low_m).chain(self.panels.last().map(|p| p.high_m))
    }

    /// The panel with the shortest rule that meets the tolerance, or `None` when it has to be halved.
    fn panel(&self, low_m: f64, high_m: f64, weighted: &[Weighted]) -> Option<Panel> {
        let legs = self.test_legs(low_m, high_m);
        let longest = legs.iter().map(|(_, a, b)| b - a).fold(0.0, f64::max);
        let active: Vec<usize> = (0..weighted.len())
            .filter(|&i| {
                let w = weighted[i];
                w.coefficient_per_m * w.profile.majorant(low_m, high_m) * longest > 0.1 * TOLERANCE
            })
            .collect();
        let fine = GaussLegendre::new(40);
        // Profile by profile: errors of opposite sign must not hide each other from a band that has only one of them.
        let depth = |i: usize, rule: &GaussLegendre, leg: &(Line, f64, f64), pieces: u32| -> f64 {
            let step = (leg.2 - leg.1) / f64::from(pieces);
            let w = weighted[i];
            let starts = (0..pieces).map(|k| leg.1 + step * f64::from(k));
            starts.map(|a| w.coefficient_per_m * along(&leg.0, &w.profile, rule, a, step)).sum()
        };
        let cases: Vec<_> = active.iter().flat_map(|&i| legs.iter().map(move |leg| (i, leg))).collect();
        let exact: Vec<f64> = cases.iter().map(|&(i, leg)| depth(i, &fine, leg, 8)).collect();
        let good = |rule: &GaussLegendre| {
            let fits =
                |(&(i, leg), e): (&(usize, &_), &f64)| (depth(i, rule, leg, 1) - e).abs() <= TOLERANCE * e.max(1.0);
            cases.iter().zip(&exact).all(fits)
        };
        let rule = RULE_LENGTHS.iter().map(|&n| GaussLegendre::new(n)).find(good);
        // A panel too thin to halve is taken as it is: its whole column is below rounding of the others.
        let thin = || (high_m - low_m < 1e-3).then(|| GaussLegendre::new(LONGEST_RULE));
        Some(Panel { low_m, high_m, rule: rule.or_else(thin)?, active })
    }

    /// Legs from the bottom (or from inside, or from their lowest point) of a panel to its top.
    fn test_legs(&self, low_m: f64, high_m: f64) -> Vec<(Line, f64, f64)> {
        let mut legs = Vec::new();
        for fraction in [0.0, 0.003, 0.1, 0.5] {
            let start = low_m + fraction * (high_m - low_m);
            for cosine in [0.0, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0] {
                // A horizontal ray over a plane never leaves its layer and has a constant integrand.
                if cosine == 0.0 && self.radius_m == f64::INFINITY {
                    continue;
                }
                let line = Line::new(self.radius_m, start, cosine);
                if let Some(end) = line.rise(high_m) {
                    legs.push((line, 0.0, end));
                }
            }
        }
        legs
    }

    /// Adds to `columns` (one per profile, m) the part of the line between two distances.
    pub fn add(&self, line: &Line, from_m: f64, to_m: f64, columns: &mut [f64]) {
        let lowest = line.lowest();
        if lowest > from_m {
            self.add_leg(line, from_m, to_m.min(lowest), columns);
        }
        if to_m > lowest {
            self.add_leg(line, from_m.max(lowest), to_m, columns);
        }
    }

    /// A part of the line on which altitude is monotone.
    fn add_leg(&self, line: &Line, from_m: f64, to_m: f64, columns: &mut [f64]) {
        let (start, end) = (line.altitude(from_m), line.altitude(to_m));
        let (low, high) = (start.min(end), start.max(end));
        let falling = end < start;
        let first = self.panels.partition_point(|p| p.high_m <= low);
        for panel in self.panels[first..].iter().take_while(|p| p.low_m < high || p.low_m == low) {
            // Distances at which the leg enters and leaves the panel, from its lower to its upper end.
            let crossing = |altitude| if falling { line.fall(altitude) } else { line.rise(altitude) };
            let below = if panel.low_m <= low { None } else { crossing(panel.low_m) };
            let above = if panel.high_m >= high { None } else { crossing(panel.high_m) };
            let (lower_end, upper_end) = if falling { (to_m, from_m) } else { (from_m, to_m) };
            let (a, b) = (below.unwrap_or(lower_end), above.unwrap_or(upper_end));
            panel.add(&self.profiles, line, a.min(b), (b - a).abs(), columns);
        }
    }
}

impl Panel {
    fn add(&self, profiles: &[DensityProfile], line: &Line, start_m: f64, length_m: f64, columns: &mut [f64]) {
        let mut altitudes = [0.0; LONGEST_RULE];
        let points = &self.rule.points;
        for (altitude, (node, _)) in altitudes.iter_mut().zip(points) {
            *altitude = line.altitude(start_m + length_m * node);
        }
        for &i in &self.active {
            let weighted = |density: &dyn Fn(f64) -> f64| -> f64 {
                points.iter().zip(&altitudes).map(|((_, weight), &h)| weight * density(h)).sum()
            };
            columns[i] += length_m
                * match profiles[i] {
                    // The same as `density`, with the division taken out of the innermost loop.
                    DensityProfile::Exponential { scale_height_m } => {
                        let falloff = -1.0 / scale_height_m;
                        points.iter().zip(&altitudes).map(|((_, w), &h)| w * (h * falloff).exp()).sum::<f64>()
                    }
                    profile => weighted(&|h| profile.density(h)),
                };
        }
    }
}

fn along(line: &Line, profile: &DensityProfile, rule: &GaussLegendre, start_m: f64, length_m: f64) -> f64 {
    length_m * rule.points.iter().map(|(x, w)| w * profile.density(line.altitude(start_m + length_m * x))).sum::<f64>()
}

/// Cuts altitude at every kink, and where an exponential has fallen so far that its rule can end.
fn first_cuts(height_m: f64, weighted: &[Weighted]) -> Vec<(f64, f64)> {
    let mut cuts = vec![0.0, height_m];
    for w in weighted {
        cuts.extend(w.profile.breakpoints_m().into_iter().filter(|&h| h > 0.0 && h < height_m));
    }
    cuts.sort_by(f64::total_cmp);
    for w in weighted {
        if let DensityProfile::Exponential { scale_height_m } = w.profile {
            let end = 8.0 * scale_height_m;
            let near = cuts.iter().any(|&cut| (cut - end).abs() < 0.3 * end);
            if end < height_m && !near {
                cuts.push(end);
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts.windows(2).map(|ends| (ends[0], ends[1])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::quadrature::integrate;

    #[test]
    fn rules_agree_with_adaptive_quadrature_on_every_kind_of_planet() {
        let exponential = |scale_height_m| DensityProfile::Exponential { scale_height_m };
        let air = [
            (exponential(8000.0), 33e-6),
            (exponential(1200.0), 8e-6),
            (DensityProfile::Tent { centre_m: 25e3, half_width_m: 15e3 }, 2e-6),
            (exponential(20.0), 1e-3),
            (DensityProfile::Layer { bottom_m: 300.0, top_m: 700.0 }, 1e-2),
        ];
        let weighted: Vec<Weighted> =
            air.iter().map(|&(profile, coefficient_per_m)| Weighted { profile, coefficient_per_m }).collect();
        for radius in [6.36e6, 3.4e6, 2e5, f64::INFINITY] {
            let columns = Columns::new(radius, 1e5, &weighted);
            for (start, cosine) in [(0.0, 1.0), (0.0, 1e-3), (1.0, 0.3), (350.0, -0.002), (9e3, -0.01), (5e4, 0.02)] {
                let line = Line::new(radius, start, cosine);
                let end = line.fall(0.0).or(line.rise(1e5)).expect("an end");
                let mut fast = vec![0.0; air.len()];
                columns.add(&line, 0.0, end, &mut fast);
                let mut cuts: Vec<f64> = columns
                    .cuts_m()
                    .flat_map(|h| [line.fall(h), line.rise(h)])
                    .flatten()
                    .chain([line.lowest()])
                    .collect();
                cuts.retain(|&t| t > 0.0 && t < end);
                cuts.extend([0.0, end]);
                cuts.sort_by(f64::total_cmp);
                for (i, (profile, coefficient)) in air.iter().enumerate() {
                    let exact =
                        integrate(|t| [coefficient * profile.density(line.altitude(t)); 3], &cuts, 1e-11, 1e-14);
                    let (fast, exact) = (coefficient * fast[i], exact.value[0]);
                    let label = format!("{profile:?} on {radius} m from {start} along {cosine}: {fast} and {exact}");
                    // A ray crosses each of the panels at most twice.
                    let panels = 2.0 * columns.panels.len() as f64;
                    assert!((fast - exact).abs() <= panels * TOLERANCE * exact.max(1.0), "{label}");
                }
            }
        }
    }
}
