//! Matter that varies in all three dimensions: clouds, plumes, laboratory bodies.

use std::sync::Arc;

use glam::DVec3;
use welkin_lut::Bands;

use super::air::{EMITTING_DEPTH, Tentative};
use super::matter::Matter;
use super::random::Draw;
use super::shape::clip;
use super::spectrum;

/// Steps through bodies where nobody asks for others, in details of their fields.
pub const USUAL_STEP: f64 = 0.5;

/// A density in space, relative to the coefficients it is used with.
pub trait DensityField: std::fmt::Debug + Send + Sync {
    /// The box outside which the density is zero: its lowest and its highest corner, m.
    fn bounds_m(&self) -> (DVec3, DVec3);

    /// Density at a point, at least 0.
    fn density(&self, p: DVec3) -> f64;

    /// Calls `visit` with the end (m) and the majorant of one stretch of the ray from `p` along the unit vector `d` after the
    /// other, from one distance inside the bounds to another, until it says false. Only a stretch that does not start where
    /// the walk did may be empty.
    fn march(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, visit: &mut dyn FnMut(f64, f64) -> bool);

    /// A length over which the density changes little, m: where deterministic integration starts to subdivide.
    fn detail_m(&self) -> f64;
}

/// How many of its details a field is across, roughly, where nothing else is known of it.
const DETAILS_ACROSS: f64 = 4.0;

/// A density field filled with one kind of matter.
#[derive(Debug, Clone)]
pub struct Body {
    /// What it is made of; always exactly one constituent, as a slice, which is how matter is summed up everywhere.
    pub matter: [Matter; 1],
    /// Where it is.
    pub field: Arc<dyn DensityField>,
}

impl Body {
    /// Largest extinction over the bands at density 1, 1/m.
    pub fn largest_extinction_per_m(&self) -> f64 {
        spectrum::largest(self.matter[0].extinction_per_m)
    }

    /// Rate of tentative collisions at density 1, 1/m: never below the extinction, and where the body emits enough of them for
    /// walks to find that, see [`EMITTING_DEPTH`].
    fn collision_rate_per_m(&self) -> f64 {
        let largest = self.largest_extinction_per_m();
        if spectrum::largest(self.matter[0].emission_per_m) == 0.0 {
            return largest;
        }
        largest.max(EMITTING_DEPTH / (DETAILS_ACROSS * self.field.detail_m()))
    }

    /// Distances between which a ray lies inside the body's bounds.
    pub fn span(&self, p: DVec3, d: DVec3) -> Option<(f64, f64)> {
        let (min_m, max_m) = self.field.bounds_m();
        clip(p, d, min_m, max_m)
    }
}

impl Body {
    /// The next tentative collision between two distances: a Poisson process at the field's local majorant.
    pub fn tentative(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, unit_exponential: f64) -> Option<Tentative> {
        let largest = self.collision_rate_per_m();
        let (start, end) = self.span(p, d)?;
        let mut t = start.max(from_m);
        let mut remaining = unit_exponential;
        let mut found = None;
        self.field.march(p, d, t, end.min(to_m), &mut |end_m, majorant| {
            let majorant_per_m = majorant * largest;
            let depth = (end_m - t) * majorant_per_m;
            if depth > remaining {
                found = Some(Tentative { t_m: t + remaining / majorant_per_m, majorant_per_m });
                return false;
            }
            remaining -= depth;
            t = end_m;
            true
        });
        found
    }

    /// An unbiased estimate of the transmittance over a distance: the product of the shares of null matter at the
    /// tentative collisions (Novák et al. 2014), ended by Russian roulette where it hardly matters any more.
    pub fn ratio_tracking(&self, p: DVec3, d: DVec3, to_m: f64, draw: &mut Draw) -> Bands {
        const ROULETTE_BELOW: f64 = 0.1;
        let largest = self.largest_extinction_per_m();
        let mut transmittance = spectrum::ONE;
        let Some((start, end)) = self.span(p, d) else { return transmittance };
        let mut t = start;
        let mut remaining = draw.exponential();
        self.field.march(p, d, start, end.min(to_m), &mut |end_m, majorant| {
            let majorant_per_m = majorant * largest;
            while (end_m - t) * majorant_per_m > remaining {
                t += remaining / majorant_per_m;
                remaining = draw.exponential();
                let density = self.field.density(p + d * t);
                let null = self.matter[0].extinction_per_m.map(|c| 1.0 - density * c / majorant_per_m);
                transmittance = spectrum::product(transmittance, null);
                let most = spectrum::largest(transmittance);
                if most < ROULETTE_BELOW {
                    let survival = most / ROULETTE_BELOW;
                    if draw.uniform() >= survival {
                        transmittance = spectrum::ZERO;
                        return false;
                    }
                    transmittance = transmittance.map(|w| w / survival);
                }
            }
            remaining -= (end_m - t) * majorant_per_m;
            t = end_m;
            true
        });
        transmittance
    }
}

impl Body {
    /// τ between two distances along a ray, by 4-point Gauss steps of the usual length.
    pub fn optical_depth(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64) -> Bands {
        self.optical_depth_by(p, d, from_m, to_m, USUAL_STEP)
    }

    /// The same by steps of another length, in details of the field. Stretches without matter cost nothing.
    pub fn optical_depth_by(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, step: f64) -> Bands {
        const NODES: [(f64, f64); 2] =
            [(0.339_981_043_584_856_26, 0.652_145_154_862_546_1), (0.861_136_311_594_052_6, 0.347_854_845_137_453_85)];
        let Some((start, end)) = self.span(p, d) else { return spectrum::ZERO };
        let (mut t, end) = (start.max(from_m), end.min(to_m));
        let mut column = 0.0;
        if t >= end {
            return spectrum::ZERO;
        }
        self.field.march(p, d, t, end, &mut |stretch_end, majorant| {
            if majorant > 0.0 {
                let steps = ((stretch_end - t) / (step * self.field.detail_m())).ceil().max(1.0);
                let half = 0.5 * (stretch_end - t) / steps;
                for k in 0..steps as usize {
                    let middle = t + half * (2 * k + 1) as f64;
                    for (node, weight) in NODES {
                        let (a, b) = (p + d * (middle - half * node), p + d * (middle + half * node));
                        column += half * weight * (self.field.density(a) + self.field.density(b));
                    }
                }
            }
            t = stretch_end;
            true
        });
        self.matter[0].extinction_per_m.map(|c| c * column)
    }
}
