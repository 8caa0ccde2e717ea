//! Clouds as bodies of the path tracer: the shared definition of their density, with majorants of its own.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use welkin_lut::cloud::{CloudBounds, CloudField, CloudLayer, CloudNoise, CloudParameters, to_map};

use super::field::{Body, DensityField};
use super::layer::Layer;
use super::line::Line;
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
    layer: Layer,
    radius_m: f64,
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
            layer: Layer { shape: Shape::Sphere { radius_m, height_m: top_m }, base_m, top_m, beyond_m: BEYOND_M },
            radius_m,
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
        (to_map(self.radius_m, p.to_array()), self.layer.shape.altitude(p))
    }
}

impl DensityField for CloudShell {
    fn bounds_m(&self) -> (DVec3, DVec3) {
        self.layer.bounds_m(self.radius_m)
    }

    fn density(&self, p: DVec3) -> f64 {
        let (map_m, altitude_m) = self.place(p);
        self.field.density(map_m, altitude_m)
    }

    fn march(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, visit: &mut dyn FnMut(f64, f64) -> bool) {
        let inside = |_: &Line, t: f64, cut: f64| {
            let (map_m, altitude_m) = self.place(p + d * t);
            let (reach_m, majorant) = self.bounds.around(&self.field, map_m, altitude_m);
            ((t + reach_m).min(cut), majorant)
        };
        self.layer.march([p, d], [from_m, to_m], inside, visit);
    }

    fn detail_m(&self) -> f64 {
        DETAIL_M
    }
}
