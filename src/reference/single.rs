//! Solver (a): single scattering by adaptive quadrature along the view ray, with a shadow ray to every light at every
//! node (Premože 2003, eq. 18 and 19, with the steps chosen by an error estimate).

use std::f64::consts::PI;

use glam::DVec3;
use welkin_lut::Bands;

use super::light::Emitter;
use super::quadrature::{Integral, integrate};
use super::shape::{End, Shape, Span};
use super::sight_line::{SightLine, depth_between};
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

    /// Adds the difference from a coarser result to the error, and says whether it is within a share of the light.
    fn agrees_with(&mut self, coarser: &Self, relative_error: f64) -> bool {
        let (fine, coarse) = (self.total(), coarser.total());
        let mut agree = true;
        for j in 0..fine.len() {
            self.single.error[j] += (self.single.value[j] - coarser.single.value[j]).abs();
            agree &= (fine[j] - coarse[j]).abs() <= relative_error * fine[j];
        }
        agree
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

/// Relative error that [`first_order`] is asked for where it is the answer: through bodies, whose density has kinks
/// everywhere, less is worth its time.
pub fn usual_error(world: &World) -> f64 {
    if world.bodies.is_empty() { 1e-7 } else { 1e-3 }
}

/// Everything up to the first event for the ray from `p` along the unit vector `d`, to a relative error.
pub fn first_order(world: &World, p: DVec3, d: DVec3, relative_error: f64) -> FirstOrder {
    first_order_within(world, p, d, f64::INFINITY, relative_error)
}

/// The same for a ray that ends on a black surface at the distance `reach_m`, if nothing stops it before.
///
/// Optical depth through bodies comes from steps that are halved until two results agree to the relative error; their
/// difference is part of the error of the result.
pub fn first_order_within(world: &World, p: DVec3, d: DVec3, reach_m: f64, relative_error: f64) -> FirstOrder {
    let mut body_step = COARSEST_STEP;
    let mut result = first_order_by(world, p, d, reach_m, Resolution { relative_error, body_step });
    while !world.bodies.is_empty() && body_step > FINEST_STEP {
        body_step *= 0.5;
        let mut finer = first_order_by(world, p, d, reach_m, Resolution { relative_error, body_step });
        let agree = finer.agrees_with(&result, relative_error);
        result = finer;
        if agree {
            break;
        }
    }
    result
}

/// Longest and shortest steps through bodies, in details of their fields.
const COARSEST_STEP: f64 = 2.0;
const FINEST_STEP: f64 = 0.125;

/// How finely to integrate.
#[derive(Debug, Clone, Copy)]
struct Resolution {
    relative_error: f64,
    /// Steps through bodies, in details of their fields.
    body_step: f64,
}
/// [`first_order_within`] at one resolution.
fn first_order_by(world: &World, p: DVec3, d: DVec3, reach_m: f64, resolution: Resolution) -> FirstOrder {
    let mut result = FirstOrder { transmittance: spectrum::ONE, ..FirstOrder::default() };
    let span = world.shape.span(p, d).and_then(|span| span.within(reach_m));
    if let Some(span) = &span {
        let Resolution { relative_error, body_step } = resolution;
        let cuts = lit_breakpoints(world, p, d, span);
        let sight = SightLine::new(world, p, d, &cuts, body_step);
        result.single = integrate(|t| source(world, p + d * t, d, &sight, t, body_step), &cuts, relative_error, 0.0);
        result.transmittance = spectrum::attenuation(sight.depth_to(span.end_m));
        if emits(world) {
            let emission = |t| spectrum::product(emitted(world, p + d * t), spectrum::attenuation(sight.depth_to(t)));
            result.unscattered = integrate(emission, &cuts, relative_error, 0.0).value;
        }
    }
    match span {
        Some(span) if span.end == End::Ground => {
            let lit = ground_radiance(world, p + d * span.end_m, resolution.body_step);
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

/// Irradiance (W·m⁻²·nm⁻¹, normal to its direction) that arrives at `at` from a light without extent, and from where.
fn arriving(world: &World, light: &Emitter, at: DVec3, body_step: f64) -> Option<(DVec3, Bands)> {
    let sample = light.sample(at, 0.0, 0.0);
    let mut irradiance = sample.irradiance;
    if let Some(span) = world.shape.span(at, sample.direction) {
        if span.end == End::Ground && span.end_m < sample.distance_m {
            return None;
        }
        let way = (span.start_m, span.end_m.min(sample.distance_m));
        let depth = depth_between(world, at, sample.direction, way, body_step);
        irradiance = spectrum::product(irradiance, spectrum::attenuation(depth));
    }
    Some((sample.direction, irradiance))
}

/// The integrand: what is scattered at a point of the ray, at a distance, towards its start and gets there.
fn source(world: &World, at: DVec3, d: DVec3, sight: &SightLine, t_m: f64, body_step: f64) -> Bands {
    let transmittance = spectrum::attenuation(sight.depth_to(t_m));
    let mut total = spectrum::ZERO;
    // Deep in a cloud nothing arrives, and its shadow rays are the longest.
    if transmittance == spectrum::ZERO {
        return total;
    }
    for light in world.lights.iter().filter(|light| is_covered(light)) {
        let Some((direction, irradiance)) = arriving(world, light, at, body_step) else { continue };
        let response = in_scattering(world, at, d.dot(direction).clamp(-1.0, 1.0));
        spectrum::accumulate(&mut total, 1.0, spectrum::product(response, irradiance));
    }
    spectrum::product(total, transmittance)
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

/// Radiance leaving the ground at a point under the lights without extent, without any scattering in between.
fn ground_radiance(world: &World, at: DVec3, body_step: f64) -> Bands {
    let normal = world.shape.up(at);
    let mut total = spectrum::ZERO;
    for light in world.lights.iter().filter(|light| is_covered(light)) {
        if let Some((direction, irradiance)) = arriving(world, light, at, body_step) {
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
