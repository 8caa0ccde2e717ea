//! Clouds as bodies of the path tracer: the shared definition of their density, with majorants of its own.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use welkin_lut::cloud::{CloudBounds, CloudField, CloudLayer, CloudNoise, CloudParameters, to_map};

use super::field::{Body, DensityField};
use super::matter::Matter;
use super::shape::Shape;

/// A length over which the finest noise changes little, m.
const DETAIL_M: f64 = 20.0;
/// How far beyond a boundary the altitude is looked at, m.
const BEYOND_M: f64 = 1e-3;

/// A layer of clouds around a planet.
#[derive(Debug)]
pub struct CloudShell {
    field: CloudField<'static>,
    bounds: &'static CloudBounds,
    shape: Shape,
    radius_m: f64,
    base_m: f64,
    top_m: f64,
}

impl CloudShell {
    /// The layer at a time in seconds, as a body; `None` where it has no cloud.
    pub fn body(layer: &CloudLayer, radius_m: f64, time_s: f64) -> Option<Body> {
        static BOUNDS: OnceLock<CloudBounds> = OnceLock::new();
        if layer.is_empty() {
            return None;
        }
        let noise = CloudNoise::shared();
        let parameters = CloudParameters::new(layer, time_s);
        let base_m = f64::from(parameters.base_m);
        let top_m = base_m + f64::from(parameters.thickness_m);
        let extinction_per_m = f64::from(parameters.extinction_per_m);
        let shell = Self {
            field: CloudField { noise, parameters },
            bounds: BOUNDS.get_or_init(|| CloudBounds::new(noise)),
            shape: Shape::Sphere { radius_m, height_m: top_m },
            radius_m,
            base_m,
            top_m,
        };
        let matter = Matter {
            scattering_per_m: layer.albedo.map(|albedo| albedo * extinction_per_m),
            extinction_per_m: [extinction_per_m; 3],
            emission_per_m: [0.0; 3],
            phase: layer.phase.clone(),
        };
        Some(Body { matter: [matter], field: Arc::new(shell) })
    }

    fn place(&self, p: DVec3) -> ([f64; 2], f64) {
        (to_map(self.radius_m, p.to_array()), self.shape.altitude(p))
    }
}

impl DensityField for CloudShell {
    /// All of the sphere that the layer encloses: rays skip what is not the layer in one stretch.
    fn bounds_m(&self) -> (DVec3, DVec3) {
        let outer = self.radius_m + self.top_m;
        let centre = DVec3::new(0.0, 0.0, -self.radius_m);
        (centre - DVec3::splat(outer), centre + DVec3::splat(outer))
    }

    fn density(&self, p: DVec3) -> f64 {
        let (map_m, altitude_m) = self.place(p);
        self.field.density(map_m, altitude_m)
    }

    fn stretch(&self, p: DVec3, d: DVec3, from_m: f64) -> (f64, f64) {
        let mut first = (from_m, 0.0);
        self.march(p, d, from_m, f64::INFINITY, &mut |end_m, majorant| {
            first = (end_m, majorant);
            end_m <= from_m
        });
        first
    }

    fn march(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, visit: &mut dyn FnMut(f64, f64) -> bool) {
        let line = self.shape.line(p, d);
        let crossings = [line.fall(self.top_m), line.fall(self.base_m), line.rise(self.base_m), line.rise(self.top_m)];
        let next = |t: f64| {
            crossings.iter().flatten().copied().filter(|&cut| cut > t + BEYOND_M).fold(f64::INFINITY, f64::min)
        };
        let mut t = from_m;
        while t < to_m {
            let cut = next(t);
            let ahead = line.altitude(if cut.is_finite() { 0.5 * (t + cut) } else { t + BEYOND_M });
            // Between two boundaries a ray is above the base and below the top, or on one outer side of the layer.
            if !(self.base_m..=self.top_m).contains(&ahead) {
                if !visit(cut.min(to_m), 0.0) {
                    return;
                }
                t = cut;
                continue;
            }
            let (map_m, altitude_m) = self.place(p + d * t);
            let (reach_m, majorant) = self.bounds.around(&self.field, map_m, altitude_m);
            let end = (t + reach_m).min(cut);
            if !visit(end.min(to_m), majorant) {
                return;
            }
            t = end;
        }
    }

    fn detail_m(&self) -> f64 {
        DETAIL_M
    }
}
