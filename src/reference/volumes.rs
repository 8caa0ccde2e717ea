//! Fog and local volumes as bodies of the path tracer: the shared definition of their density, with majorants of its own.

use std::sync::Arc;

use glam::{DVec3, UVec3};
use welkin_lut::cloud::to_map;
use welkin_lut::volume::{Volume, VolumeField, VolumeForm, VolumeParameters};

use super::field::{Body, DensityField};
use super::grid::GridField;
use super::layer::Layer;
use super::line::Line;
use super::matter::Matter;
use super::shape::{Shape, clip};
use super::spectrum;

/// How far beyond a boundary a ray is looked at, m.
const BEYOND_M: f64 = 1e-6;

/// The volume at a time in seconds, as a body; `None` where nothing of it can be seen.
pub fn body(volume: &Volume, radius_m: f64, time_s: f64) -> Option<Body> {
    if volume.is_empty() {
        return None;
    }
    let matter = Matter {
        scattering_per_m: volume.scattering_per_m,
        extinction_per_m: volume.extinction_per_m(),
        emission_per_m: volume.emission_per_m,
        phase: volume.phase.clone(),
    };
    let filled = Filled { volume: volume.clone(), parameters: VolumeParameters::new(volume, time_s), radius_m };
    let field: Arc<dyn DensityField> = match volume.form {
        VolumeForm::Fog { .. } => Arc::new(FogShell::new(filled)?),
        _ => Arc::new(LocalVolume::new(filled)),
    };
    Some(Body { matter: [matter], field })
}

/// A volume with its numbers.
#[derive(Debug)]
struct Filled {
    volume: Volume,
    parameters: VolumeParameters,
    radius_m: f64,
}

impl Filled {
    fn field(&self) -> VolumeField<'_> {
        VolumeField::new(&self.volume, self.parameters)
    }

    fn density(&self, p: DVec3, altitude_m: f64) -> f64 {
        self.field().density(p.to_array(), to_map(self.radius_m, p.to_array()), altitude_m)
    }
}

/// Fog between two altitudes.
#[derive(Debug)]
struct FogShell {
    filled: Filled,
    layer: Layer,
    /// Change of altitude within which one majorant holds, m.
    slab_m: f64,
}

/// Longest stretch with one majorant, slabs of altitude.
const LONGEST_SLABS: f64 = 40.0;

impl FogShell {
    fn new(filled: Filled) -> Option<Self> {
        let (bottom_m, top_m) = (f64::from(filled.parameters.bottom_m), f64::from(filled.parameters.top_m));
        if top_m <= 0.0 {
            return None;
        }
        let per_scale_height = f64::from(filled.parameters.per_scale_height);
        let slab_m = if per_scale_height > 0.0 { 0.25 / per_scale_height } else { top_m - bottom_m };
        let shape = Shape::Sphere { radius_m: filled.radius_m, height_m: top_m };
        Some(Self { filled, layer: Layer { shape, base_m: bottom_m, top_m, beyond_m: BEYOND_M }, slab_m })
    }

    /// The largest density from an altitude up.
    fn majorant(&self, lowest_m: f64) -> f64 {
        (-(lowest_m - self.layer.base_m).max(0.0) * f64::from(self.filled.parameters.per_scale_height)).exp()
    }
}

impl DensityField for FogShell {
    fn bounds_m(&self) -> (DVec3, DVec3) {
        self.layer.bounds_m(self.filled.radius_m)
    }

    fn density(&self, p: DVec3) -> f64 {
        self.filled.density(p, self.layer.shape.altitude(p))
    }

    fn march(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, visit: &mut dyn FnMut(f64, f64) -> bool) {
        // Halved until the altitude, which is convex along a line, stays within a slab of where it starts.
        let inside = |line: &Line, t: f64, cut: f64| {
            let mut length = (LONGEST_SLABS * self.slab_m).min(cut - t);
            let start_m = line.altitude(t);
            while length > self.slab_m && (line.altitude(t + length) - start_m).abs() > self.slab_m {
                length *= 0.5;
            }
            let lowest = line.altitude(line.lowest().clamp(t, t + length));
            (if length >= cut - t { cut } else { t + length }, self.majorant(lowest))
        };
        self.layer.march([p, d], [from_m, to_m], inside, visit);
    }

    fn detail_m(&self) -> f64 {
        self.filled.volume.detail_m()
    }
}

/// A box or an ellipsoid.
#[derive(Debug)]
struct LocalVolume {
    filled: Filled,
    centre_m: DVec3,
    half_size_m: DVec3,
    is_ellipsoid: bool,
    /// Its samples in its own axes, for their majorants.
    grid: Option<GridField>,
}

impl LocalVolume {
    fn new(filled: Filled) -> Self {
        let parameters = &filled.parameters;
        let of = |numbers: [f32; 3]| DVec3::from_array(numbers.map(f64::from));
        let (centre_m, half_size_m) = (of(parameters.centre_m), of(parameters.half_size_m));
        let grid = filled.volume.grid.as_ref().and_then(|grid| {
            let samples = grid.samples().iter().map(|&sample| f64::from(sample)).collect();
            let size = UVec3::from_array(grid.size().map(|n| n as u32));
            let field = GridField::new(-half_size_m, half_size_m, size, samples).ok()?;
            Some(field.for_extinction(spectrum::largest(filled.volume.extinction_per_m())))
        });
        let is_ellipsoid = matches!(filled.volume.form, VolumeForm::Ellipsoid { .. });
        Self { centre_m, half_size_m, is_ellipsoid, grid, filled }
    }

    /// A ray in the volume's own axes.
    fn inside(&self, p: DVec3, d: DVec3) -> (DVec3, DVec3) {
        let field = self.filled.field();
        let q = DVec3::from_array(field.inside(p.to_array()));
        (q, DVec3::from_array(field.inside((self.centre_m + d).to_array())))
    }

    /// Distances between which a ray in the volume's own axes is inside.
    fn span(&self, q: DVec3, e: DVec3) -> Option<(f64, f64)> {
        if !self.is_ellipsoid {
            return clip(q, e, -self.half_size_m, self.half_size_m);
        }
        let (from, along) = (q / self.half_size_m, e / self.half_size_m);
        let (a, b, c) = (along.length_squared(), from.dot(along), from.length_squared() - 1.0);
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let (start, end) = ((-b - root) / a, (-b + root) / a);
        (end > 0.0).then_some((start.max(0.0), end))
    }
}

impl DensityField for LocalVolume {
    fn bounds_m(&self) -> (DVec3, DVec3) {
        let [cos, sin] = self.filled.parameters.turn.map(|x| f64::from(x.abs()));
        let h = self.half_size_m;
        let reach = DVec3::new(cos * h.x + sin * h.y, sin * h.x + cos * h.y, h.z);
        (self.centre_m - reach, self.centre_m + reach)
    }

    fn density(&self, p: DVec3) -> f64 {
        self.filled.density(p, 0.0)
    }

    fn march(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, visit: &mut dyn FnMut(f64, f64) -> bool) {
        let (q, e) = self.inside(p, d);
        let Some((start, end)) = self.span(q, e).filter(|&(start, end)| end > from_m && start < to_m) else {
            visit(to_m, 0.0);
            return;
        };
        if start > from_m && !visit(start, 0.0) {
            return;
        }
        let (start, end) = (start.max(from_m), end.min(to_m));
        let mut goes_on = true;
        match &self.grid {
            Some(grid) => grid.march(q, e, start, end, &mut |next, majorant| {
                goes_on = visit(next, majorant);
                goes_on
            }),
            None => goes_on = visit(end, 1.0),
        }
        if goes_on && end < to_m {
            visit(to_m, 0.0);
        }
    }

    fn detail_m(&self) -> f64 {
        self.filled.volume.detail_m()
    }
}
