//! The space between two altitudes, as rays cross it.

use glam::DVec3;

use super::line::Line;
use super::shape::Shape;

/// Matter between a base and a top, around a planet or over a plane.
#[derive(Debug, Clone)]
pub struct Layer {
    /// Where altitudes are measured from.
    pub shape: Shape,
    /// Its lowest altitude, m.
    pub base_m: f64,
    /// Its highest, m.
    pub top_m: f64,
    /// How far beyond a boundary the altitude is looked at, m.
    pub beyond_m: f64,
}

impl Layer {
    /// The box around the sphere that the layer encloses: rays skip what is not the layer in one stretch.
    pub fn bounds_m(&self, radius_m: f64) -> (DVec3, DVec3) {
        let outer = radius_m + self.top_m;
        let centre = DVec3::new(0.0, 0.0, -radius_m);
        (centre - DVec3::splat(outer), centre + DVec3::splat(outer))
    }

    /// As [`super::field::DensityField::march`]. Outside of the layer there is nothing; inside, `inside` says for a ray at a
    /// distance (m), which leaves the layer at another, where its next stretch ends and the majorant of that.
    pub fn march(
        &self,
        [p, d]: [DVec3; 2],
        [from_m, to_m]: [f64; 2],
        inside: impl Fn(&Line, f64, f64) -> (f64, f64),
        visit: &mut dyn FnMut(f64, f64) -> bool,
    ) {
        let line = self.shape.line(p, d);
        let crossings = [line.fall(self.top_m), line.fall(self.base_m), line.rise(self.base_m), line.rise(self.top_m)];
        let mut t = from_m;
        while t < to_m {
            let ahead = crossings.iter().flatten().filter(|&&cut| cut > t + self.beyond_m);
            let cut = ahead.copied().fold(f64::INFINITY, f64::min);
            let next_m = line.altitude(if cut.is_finite() { 0.5 * (t + cut) } else { t + self.beyond_m });
            // Between two boundaries a ray is above the base and below the top, or on one outer side of the layer.
            let (end, majorant) =
                if (self.base_m..=self.top_m).contains(&next_m) { inside(&line, t, cut) } else { (cut, 0.0) };
            if !visit(end.min(to_m), majorant) {
                return;
            }
            t = end;
        }
    }
}
