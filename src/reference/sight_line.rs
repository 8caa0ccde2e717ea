//! Optical depth along one ray, asked for again and again while light along it is integrated.

use glam::DVec3;
use welkin_lut::Bands;

use super::line::Line;
use super::spectrum;
use super::world::World;

/// A ray through a world: rules of proven error through the air, and through bodies what a walk from cut to cut has found.
#[derive(Debug)]
pub struct SightLine<'a> {
    world: &'a World,
    p: DVec3,
    d: DVec3,
    line: Line,
    cuts: &'a [f64],
    /// τ of the bodies from the first cut to each; empty where there are none.
    through_bodies: Vec<Bands>,
    body_step: f64,
}

impl<'a> SightLine<'a> {
    /// The ray from `p` along the unit vector `d` between the first and the last of the ascending distances `cuts`, m, with
    /// steps through bodies in details of their fields.
    pub fn new(world: &'a World, p: DVec3, d: DVec3, cuts: &'a [f64], body_step: f64) -> Self {
        let line = world.shape.line(p, d);
        let mut sight = Self { world, p, d, line, cuts, through_bodies: Vec::new(), body_step };
        if !world.bodies.is_empty() {
            let mut depth = spectrum::ZERO;
            let mut through_bodies = vec![depth];
            for ends in cuts.windows(2) {
                spectrum::accumulate(&mut depth, 1.0, bodies_between(world, p, d, (ends[0], ends[1]), body_step));
                through_bodies.push(depth);
            }
            sight.through_bodies = through_bodies;
        }
        sight
    }

    /// τ from the first cut to a distance between it and the last, m.
    pub fn depth_to(&self, t_m: f64) -> Bands {
        let mut depth = self.world.air.optical_depth(&self.line, self.cuts[0], t_m);
        if !self.through_bodies.is_empty() {
            let before = self.cuts.partition_point(|&cut| cut <= t_m).saturating_sub(1);
            spectrum::accumulate(&mut depth, 1.0, self.through_bodies[before]);
            let rest = bodies_between(self.world, self.p, self.d, (self.cuts[before], t_m), self.body_step);
            spectrum::accumulate(&mut depth, 1.0, rest);
        }
        depth
    }
}

/// τ between two distances along a ray: rules of proven error through the air, steps through bodies.
pub fn depth_between(world: &World, p: DVec3, d: DVec3, (from_m, to_m): (f64, f64), body_step: f64) -> Bands {
    let mut depth = world.air.optical_depth(&world.shape.line(p, d), from_m, to_m);
    spectrum::accumulate(&mut depth, 1.0, bodies_between(world, p, d, (from_m, to_m), body_step));
    depth
}

fn bodies_between(world: &World, p: DVec3, d: DVec3, (from_m, to_m): (f64, f64), body_step: f64) -> Bands {
    let mut depth = spectrum::ZERO;
    for body in world.bodies.iter() {
        spectrum::accumulate(&mut depth, 1.0, body.optical_depth_by(p, d, from_m, to_m, body_step));
    }
    depth
}
