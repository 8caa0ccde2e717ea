//! Solver (a): single scattering by adaptive quadrature along the view ray, with a shadow ray to every light at every
//! node (Premože 2003, eq. 18 and 19, with the steps chosen by an error estimate).

use std::f64::consts::PI;

use glam::DVec3;
use welkin_lut::Bands;

use super::light::Emitter;
use super::quadrature::{Integral, integrate};
use super::shape::{End, Shape, Span};
use super::spectrum;
use super::transport::breakpoints;
use super::world::World;

/// Light that arrives without a second event, in closed form or by quadrature.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FirstOrder {
    /// Scattered exactly once in the medium, from beams and points, with its error bound.
    pub single: Integral,
    /// Beams and points reflected once by the ground at the end of the ray.
    pub ground: Bands,
    /// Emitted by the medium, and the environment behind it.
    pub unscattered: Bands,
    /// From the start of the ray to the ground or to space.
    pub transmittance: Bands,
}

impl FirstOrder {
    /// All of it: what arrives after at most one event.
    pub fn total(&self) -> Bands {
        std::array::from_fn(|j| self.single.value[j] + self.ground[j] + self.unscattered[j])
    }
}

/// Whether [`first_order`] covers a light; the others have an extent and are sampled.
pub fn is_covered(light: &Emitter) -> bool {
    matches!(light, Emitter::Beam { .. } | Emitter::Point { .. })
}

/// Whether matter gives off light of its own.
pub fn emits(world: &World) -> bool {
    world.air.emits() || world.bodies.iter().any(|body| body.matter[0].emission_per_m != spectrum::ZERO)
}

/// Everything up to the first event for the ray from `p` along the unit vector `d`, to a relative error.
pub fn first_order(world: &World, p: DVec3, d: DVec3, relative_error: f64) -> FirstOrder {
    first_order_within(world, p, d, f64::INFINITY, relative_error)
}

/// The same for a ray that ends on a black surface at the distance `reach_m`, if nothing stops it before.
pub fn first_order_within(world: &World, p: DVec3, d: DVec3, reach_m: f64, relative_error: f64) -> FirstOrder {
    let mut result = FirstOrder { transmittance: spectrum::ONE, ..FirstOrder::default() };
    let span = world.shape.span(p, d).and_then(|span| span.within(reach_m));
    if let Some(span) = &span {
        let cuts = lit_breakpoints(world, p, d, span);
        result.single = integrate(|t| source(world, p, d, span, t), &cuts, relative_error, 0.0);
        result.transmittance = spectrum::attenuation(depth_between(world, p, d, span.start_m, span.end_m));
        if emits(world) {
            let emitted = integrate(|t| emission(world, p, d, span, t), &cuts, relative_error, 0.0);
            result.unscattered = emitted.value;
        }
    }
    match span {
        Some(span) if span.end == End::Ground => {
            let lit = ground_radiance(world, p + d * span.end_m);
            result.ground = spectrum::product(result.transmittance, lit);
        }
        _ if reach_m < f64::INFINITY => {}
        _ => {
            for light in &world.lights {
                if let Emitter::Environment { radiance } = light {
                    spectrum::accumulate(
                        &mut result.unscattered,
                        1.0,
                        spectrum::product(result.transmittance, *radiance),
                    );
                }
            }
        }
    }
    result
}

/// τ between two distances along a ray: rules of proven error through the air, composite Gauss through bodies.
pub fn depth_between(world: &World, p: DVec3, d: DVec3, from_m: f64, to_m: f64) -> Bands {
    let mut depth = world.air.optical_depth(&world.shape.line(p, d), from_m, to_m);
    for body in world.bodies.iter() {
        spectrum::accumulate(&mut depth, 1.0, body.optical_depth(p, d, from_m, to_m));
    }
    depth
}

/// Irradiance (W·m⁻²·nm⁻¹, normal to its direction) that arrives at `at` from a light without extent, and from where.
fn arriving(world: &World, light: &Emitter, at: DVec3) -> Option<(DVec3, Bands)> {
    let sample = light.sample(at, 0.0, 0.0);
    let mut irradiance = sample.irradiance;
    if let Some(span) = world.shape.span(at, sample.direction) {
        if span.end == End::Ground && span.end_m < sample.distance_m {
            return None;
        }
        let end = span.end_m.min(sample.distance_m);
        let depth = depth_between(world, at, sample.direction, span.start_m, end);
        irradiance = spectrum::product(irradiance, spectrum::attenuation(depth));
    }
    Some((sample.direction, irradiance))
}

/// The integrand: what is scattered at a distance towards the start of the ray and gets there.
fn source(world: &World, p: DVec3, d: DVec3, span: &Span, t_m: f64) -> Bands {
    let at = p + d * t_m;
    let mut total = spectrum::ZERO;
    for light in world.lights.iter().filter(|light| is_covered(light)) {
        let Some((direction, irradiance)) = arriving(world, light, at) else { continue };
        let response = in_scattering(world, at, d.dot(direction).clamp(-1.0, 1.0));
        spectrum::accumulate(&mut total, 1.0, spectrum::product(response, irradiance));
    }
    if total == spectrum::ZERO {
        return total;
    }
    let depth = depth_between(world, p, d, span.start_m, t_m);
    spectrum::product(total, spectrum::attenuation(depth))
}

/// b P(cos θ) of everything at a point, 1/m/sr.
pub fn in_scattering(world: &World, at: DVec3, cos_theta: f64) -> Bands {
    let mut density = Vec::new();
    let mut total = world.air.local(world.shape.altitude(at), &mut density).in_scattering(cos_theta);
    for body in world.bodies.iter() {
        let weight = body.field.density(at) * body.matter[0].phase.value(cos_theta);
        spectrum::accumulate(&mut total, weight, body.matter[0].scattering_per_m);
    }
    total
}

/// a L_e of everything at a point, W·m⁻²·sr⁻¹·nm⁻¹ per m.
pub fn emitted(world: &World, at: DVec3) -> Bands {
    let mut density = Vec::new();
    let mut total = world.air.local(world.shape.altitude(at), &mut density).emission();
    for body in world.bodies.iter() {
        spectrum::accumulate(&mut total, body.field.density(at), body.matter[0].emission_per_m);
    }
    total
}

fn emission(world: &World, p: DVec3, d: DVec3, span: &Span, t_m: f64) -> Bands {
    let total = emitted(world, p + d * t_m);
    let depth = depth_between(world, p, d, span.start_m, t_m);
    spectrum::product(total, spectrum::attenuation(depth))
}

/// Radiance leaving the ground at a point under the lights without extent, without any scattering in between.
fn ground_radiance(world: &World, at: DVec3) -> Bands {
    let normal = world.shape.up(at);
    let mut total = spectrum::ZERO;
    for light in world.lights.iter().filter(|light| is_covered(light)) {
        if let Some((direction, irradiance)) = arriving(world, light, at) {
            let cosine = normal.dot(direction).max(0.0);
            spectrum::accumulate(&mut total, cosine / PI, spectrum::product(world.ground_albedo, irradiance));
        }
    }
    total
}

/// Breakpoints of the matter, of the planet's shadow, and the points nearest to point lights.
fn lit_breakpoints(world: &World, p: DVec3, d: DVec3, span: &Span) -> Vec<f64> {
    let mut cuts = breakpoints(world, p, d, span);
    for light in world.lights.iter().filter(|light| is_covered(light)) {
        match *light {
            Emitter::Beam { toward, .. } => cuts.extend(shadow_crossings(&world.shape, p, d, toward)),
            Emitter::Point { position_m, .. } => cuts.push((position_m - p).dot(d)),
            _ => {}
        }
    }
    cuts.retain(|&t| t >= span.start_m && t <= span.end_m);
    cuts.sort_by(f64::total_cmp);
    cuts
}

/// Distances at which a ray crosses the cylinder that a sphere's shadow fills: its axis is the beam through the
/// centre. Where the ray meets it on the lit side nothing happens.
fn shadow_crossings(shape: &Shape, p: DVec3, d: DVec3, toward: DVec3) -> Vec<f64> {
    let Shape::Sphere { radius_m, .. } = *shape else { return Vec::new() };
    let across = |v: DVec3| v - toward * v.dot(toward);
    let (from_axis, drift) = (across(p + DVec3::new(0.0, 0.0, radius_m)), across(d));
    let a = drift.length_squared();
    let b = from_axis.dot(drift);
    let c = (from_axis.length() - radius_m) * (from_axis.length() + radius_m);
    let discriminant = b * b - a * c;
    if a == 0.0 || discriminant < 0.0 {
        return Vec::new();
    }
    // The two roots without cancellation (Press et al., Numerical Recipes, section 5.6).
    let q = -(b + discriminant.sqrt().copysign(b));
    [q / a, c / q].into_iter().filter(|t| t.is_finite()).collect()
}
