//! Optical depth and what follows from it, along rays, without sampling.

use std::sync::Arc;

use glam::DVec3;
use welkin_lut::Bands;

use super::quadrature::{Integral, integrate};
use super::shape::{End, Span};
use super::spectrum;
use super::world::World;

/// The distances at which matter along a ray has a kink or a jump, with the ends of the span, m, ascending.
pub fn breakpoints(world: &World, p: DVec3, d: DVec3, span: &Span) -> Vec<f64> {
    let line = world.shape.line(p, d);
    let mut cuts = vec![line.lowest()];
    for altitude in world.air.cuts_m() {
        cuts.extend(line.fall(altitude));
        cuts.extend(line.rise(altitude));
    }
    for body in world.bodies.iter() {
        let Some((start, end)) = body.span(p, d) else { continue };
        let (start, end) = (start.max(span.start_m), end.min(span.end_m));
        if start >= end {
            continue;
        }
        // Where one empty stretch follows another nothing changes.
        let mut was_empty = false;
        cuts.push(start);
        body.field.march(p, d, start, end, &mut |end_m, majorant| {
            if was_empty && majorant == 0.0 {
                cuts.pop();
            }
            was_empty = majorant == 0.0;
            cuts.push(end_m);
            true
        });
    }
    cuts.retain(|&t| t > span.start_m && t < span.end_m);
    cuts.extend([span.start_m, span.end_m]);
    cuts.sort_by(f64::total_cmp);
    cuts
}

/// c along a ray at a distance, 1/m.
pub fn extinction(world: &World, p: DVec3, d: DVec3, t_m: f64) -> Bands {
    let at = p + d * t_m;
    let mut density = Vec::new();
    let mut total = world.air.local(world.shape.altitude(at), &mut density).extinction();
    for body in world.bodies.iter() {
        spectrum::accumulate(&mut total, body.field.density(at), body.matter[0].extinction_per_m);
    }
    total
}

/// τ from `p` along the unit vector `d` over `distance_m` (which may be infinite) or to the ground, by adaptive
/// quadrature to a relative error, with the error reached (Premože 2003, eq. 13).
pub fn optical_depth(world: &World, p: DVec3, d: DVec3, distance_m: f64, relative_error: f64) -> Integral {
    let Some(mut span) = world.span(p, d) else { return Integral::default() };
    span.end_m = span.end_m.min(distance_m);
    if span.end_m <= span.start_m {
        return Integral::default();
    }
    let cuts = breakpoints(world, p, d, &span);
    integrate(|t| extinction(world, p, d, t), &cuts, relative_error, 1e-300)
}

/// T = exp(-τ) to space or to the ground (Premože 2003, eq. 14): of stratified air by adaptive quadrature to 10⁻¹⁰ of
/// τ, of bodies by steps that follow their detail.
pub fn transmittance(world: &World, p: DVec3, d: DVec3) -> Bands {
    let stratified = World { bodies: Arc::new([]), ..world.clone() };
    let mut depth = optical_depth(&stratified, p, d, f64::INFINITY, 1e-10).value;
    if let Some(span) = world.span(p, d) {
        for body in world.bodies.iter() {
            spectrum::accumulate(&mut depth, 1.0, body.optical_depth(p, d, span.start_m, span.end_m));
        }
    }
    spectrum::attenuation(depth)
}

/// α = 1 - T (Premože 2003, eq. 15), without cancellation in thin matter.
pub fn opacity(optical_depth: Bands) -> Bands {
    optical_depth.map(|tau| -(-tau).exp_m1())
}

/// W = b / c at a point; 0 in vacuum.
pub fn albedo(world: &World, p: DVec3) -> Bands {
    let mut density = Vec::new();
    let local = world.air.local(world.shape.altitude(p), &mut density);
    let (mut b, mut c) = (local.scattering(), local.extinction());
    for body in world.bodies.iter() {
        let rho = body.field.density(p);
        spectrum::accumulate(&mut b, rho, body.matter[0].scattering_per_m);
        spectrum::accumulate(&mut c, rho, body.matter[0].extinction_per_m);
    }
    std::array::from_fn(|j| if c[j] > 0.0 { b[j] / c[j] } else { 0.0 })
}

/// Whether a ray ends on the ground.
pub fn hits_ground(world: &World, p: DVec3, d: DVec3) -> bool {
    world.shape.span(p, d).is_some_and(|span| span.end == End::Ground)
}
