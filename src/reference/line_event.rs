//! Light of point lights on a whole ray of a walk at once.
//!
//! A collision near a point light sees its light with the inverse square of the distance, which has no variance in three
//! dimensions. Here the place is drawn along the ray in proportion to that square (equiangular sampling: Kulla & Fajardo
//! 2012, Importance Sampling Techniques for Path Tracing in Participating Media, section 3), so that it cancels.

use glam::DVec3;

use super::light::Emitter;
use super::shape::Span;
use super::single::in_scattering;
use super::spectrum::{self, sum};
use super::tally::Tally;
use super::walk::{State, Walker};

/// A point light as a ray sees it.
struct Seen {
    /// Distance along the ray to the place nearest to the light, m.
    nearest_m: f64,
    /// Distance of the light from there, m.
    off_m: f64,
    /// Angles at the light from that place to the ends of the ray, rad.
    angles: [f64; 2],
}

/// A light that stands on a ray itself counts as this far from it, m.
const SMALLEST_OFF_M: f64 = 1e-6;

impl Seen {
    fn new(position_m: DVec3, p: DVec3, d: DVec3, span: &Span) -> Self {
        let nearest_m = (position_m - p).dot(d);
        let off_m = (p + d * nearest_m - position_m).length().max(SMALLEST_OFF_M);
        let angle = |t: f64| ((t - nearest_m) / off_m).atan();
        Self { nearest_m, off_m, angles: [angle(span.start_m), angle(span.end_m)] }
    }

    fn opening(&self) -> f64 {
        self.angles[1] - self.angles[0]
    }

    /// A distance along the ray, m, and its density, 1/m, from a number in [0, 1[.
    fn sample(&self, u: f64) -> (f64, f64) {
        let offset_m = self.off_m * (self.angles[0] + u * self.opening()).tan();
        (self.nearest_m + offset_m, self.off_m / (self.opening() * (self.off_m * self.off_m + offset_m * offset_m)))
    }
}

impl Walker<'_> {
    /// Adds what the ray ahead scatters of one point light's light, chosen by what each would send through clear matter.
    pub(super) fn line_event(&mut self, state: &State, span: &Span, tally: &mut Tally) {
        let (world, p, d) = (self.world, state.position, state.direction);
        let lights = || {
            world.lights.iter().filter_map(|light| match light {
                Emitter::Point { position_m, intensity, .. } => {
                    let seen = Seen::new(*position_m, p, d, span);
                    let share = sum(*intensity) * seen.opening() / seen.off_m;
                    Some((light, seen, share))
                }
                _ => None,
            })
        };
        let total: f64 = lights().map(|(_, _, share)| share).sum();
        let mut choice = self.draw.uniform() * total;
        let u = self.draw.uniform();
        let chosen = lights().find(|(_, _, share)| {
            choice -= share;
            choice < 0.0
        });
        let Some((light, seen, share)) = chosen else { return };
        let (t_m, pdf_per_m) = seen.sample(u);
        let t_m = t_m.clamp(span.start_m, span.end_m);
        let at = p + d * t_m;
        let sample = light.sample(at, 0.0, 0.0);
        let response = in_scattering(world, at, d.dot(sample.direction).clamp(-1.0, 1.0));
        if sum(response) == 0.0 || sum(sample.irradiance) == 0.0 {
            return;
        }
        let Some(before) = world.transmittance(p, d, t_m, &mut self.draw) else { return };
        let Some(after) = world.transmittance(at, sample.direction, sample.distance_m, &mut self.draw) else { return };
        let through = spectrum::product(before, after);
        let weight = total / (share * pdf_per_m);
        let value = std::array::from_fn(|j| state.weight[j] * weight * response[j] * sample.irradiance[j] * through[j]);
        tally.add(state.order + 1, state.ground, value);
    }
}
