//! Hills and mountains as the path tracer meets them: at full detail, whatever their distance.

use glam::DVec3;
use welkin_lut::Bands;

use super::shape::{Shape, Span};
use crate::scene::Terrain;

/// A ray that starts on the ground leaves it for so long, m.
const CLEAR_OF_START_M: f64 = 0.02;
/// Smallest step, m, and over the distance.
const FINEST_STEP: [f64; 2] = [0.2, 2e-5];
/// The gradient is that over such a distance, m: the finest waves are longer.
const GRADIENT_OVER_M: f64 = 0.5;
/// After so many halvings the ground is known to 10⁻⁶ of a step.
const HALVINGS: u32 = 20;
/// Slope over which the renderer lays snow more thinly, and the share of the height over which it begins.
const SNOW: [f64; 2] = [1.5, 0.08];

impl Terrain {
    /// Distance within a span at which a ray goes below the ground, m.
    pub(super) fn meets(&self, shape: &Shape, p: DVec3, d: DVec3, span: &Span) -> Option<f64> {
        let line = shape.line(p, d);
        let clearance = |t: f64| {
            let at = p + d * t;
            line.altitude(t) - self.field.height_at(self.foot(shape, at), 0.0)
        };
        let (mut before, mut t) = (span.start_m, span.start_m.max(CLEAR_OF_START_M));
        while t < span.end_m {
            let altitude_m = line.altitude(t);
            let rise = d.dot(shape.up(p + d * t));
            if altitude_m > self.field.height_m {
                if rise >= 0.0 {
                    return None;
                }
                // Down to the highest peak's shell in one step, or past it.
                let enter = line.fall(self.field.height_m)?;
                (before, t) = (t, enter.max(t) + FINEST_STEP[0]);
                continue;
            }
            let gap = clearance(t);
            if gap <= 0.0 {
                return Some(self.halve(clearance, before, t));
            }
            before = t;
            let approach = (self.field.steepest_slope() - rise).max(0.1);
            t += (gap / approach).max(FINEST_STEP[0]).max(FINEST_STEP[1] * t);
        }
        None
    }

    /// The last distance above the ground between one above and one below it.
    fn halve(&self, clearance: impl Fn(f64) -> f64, mut above: f64, mut below: f64) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (above + below);
            if clearance(middle) > 0.0 { above = middle } else { below = middle }
        }
        above
    }

    /// Foot of a point on the sphere, seen from straight above the origin.
    fn foot(&self, shape: &Shape, at: DVec3) -> [f64; 2] {
        let shrink = shape.radius_m() / (shape.radius_m() + shape.altitude(at));
        [at.x * shrink, at.y * shrink]
    }

    /// The ground's normal at a point on it.
    pub(super) fn normal(&self, shape: &Shape, at: DVec3) -> DVec3 {
        let up = shape.up(at);
        let [to_east, to_north] = self.field.gradient_at(self.foot(shape, at), GRADIENT_OVER_M);
        let east = (DVec3::X - up * up.x).normalize();
        (up - to_east * east - to_north * up.cross(east)).normalize()
    }

    /// The ground's reflectance at a point on it.
    pub(super) fn albedo(&self, shape: &Shape, at: DVec3) -> Bands {
        let [to_east, to_north] = self.field.gradient_at(self.foot(shape, at), GRADIENT_OVER_M);
        let above_m = shape.altitude(at) - self.snow_line_m;
        let depth = above_m / (SNOW[1] * self.field.height_m) - SNOW[0] * to_east.hypot(to_north);
        let x = (depth + 0.5).clamp(0.0, 1.0);
        let snow = x * x * (3.0 - 2.0 * x);
        std::array::from_fn(|j| self.albedo[j] + (self.snow_albedo[j] - self.albedo[j]) * snow)
    }
}
