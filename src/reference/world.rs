//! The world as the solvers see it: an outline, matter in it, lights outside it.

use std::sync::Arc;

use glam::DVec3;
use welkin_lut::{Bands, Constituent};

use super::air::{Air, Tentative};
use super::clouds::CloudShell;
use super::field::Body;
use super::light::Emitter;
use super::random::Draw;
use super::shape::{End, Shape, Span};
use super::spectrum;
use super::volumes;
use crate::scene::{Scene, Terrain};

/// The problem that every solver is given. Cheap to clone: matter is shared.
#[derive(Debug, Clone)]
pub struct World {
    /// The outline, and with it the ground.
    pub shape: Shape,
    /// Lambertian reflectance of the ground, each in [0, 1].
    pub ground_albedo: Bands,
    /// Matter that depends on altitude alone.
    pub air: Arc<Air>,
    /// Matter that varies in three dimensions; it has to lie inside the shape.
    pub bodies: Arc<[Body]>,
    /// Hills and mountains on the ground.
    pub relief: Option<Arc<Terrain>>,
    /// What shines.
    pub lights: Vec<Emitter>,
}

/// Which component of the medium a walk collides with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// The stratified air.
    Air,
    /// One of the bodies, by index.
    Body(usize),
}

impl World {
    /// Stratified constituents inside a shape, without lights.
    pub fn stratified(shape: Shape, ground_albedo: Bands, constituents: &[Constituent]) -> Self {
        let air = Arc::new(Air::new(&shape, constituents));
        Self { shape, ground_albedo, air, bodies: Arc::new([]), relief: None, lights: Vec::new() }
    }

    /// The scene's planet, medium, clouds, volumes and lights; the origin is the ground point below the camera.
    pub fn from_scene(scene: &Scene) -> Self {
        let planet = &scene.planet;
        let shape = Shape::Sphere { radius_m: planet.radius_m, height_m: planet.atmosphere_height_m };
        let mut world = Self::stratified(shape, planet.ground_albedo, &scene.medium.constituents);
        let clouds = scene.clouds.iter().filter_map(|layer| CloudShell::body(layer, planet.radius_m, scene.time_s));
        let volumes = scene.volumes.iter().filter_map(|volume| volumes::body(volume, planet.radius_m, scene.time_s));
        world.bodies = clouds.chain(volumes).collect();
        world.lights = scene.lights.iter().map(|light| Emitter::new(light, scene.time_s)).collect();
        world.relief = scene.terrain.clone().map(Arc::new);
        world
    }

    /// The same world with a smooth ground.
    pub fn without_relief(self) -> Self {
        Self { relief: None, ..self }
    }

    /// The part of a ray inside the shape and above the ground.
    pub fn span(&self, p: DVec3, d: DVec3) -> Option<Span> {
        let span = self.shape.span(p, d)?;
        let meets = self.relief.as_ref().and_then(|relief| relief.meets(&self.shape, p, d, &span));
        Some(meets.map_or(span, |end_m| Span { end_m, end: End::Ground, ..span }))
    }

    /// Normal and Lambertian reflectance of the ground at a point on it.
    pub fn ground_at(&self, at: DVec3) -> (DVec3, Bands) {
        match &self.relief {
            Some(relief) => (relief.normal(&self.shape, at), relief.albedo(&self.shape, at)),
            None => (self.shape.up(at), self.ground_albedo),
        }
    }

    /// The same world with its first directional light moved.
    pub fn with_sun(&self, toward: DVec3) -> Self {
        let mut world = self.clone();
        if let Some(sun) = world.lights.iter_mut().find(|l| l.toward().is_some()) {
            *sun = sun.moved(toward);
        }
        world
    }

    /// Unit vector to the first directional light.
    pub fn sun(&self) -> Option<DVec3> {
        self.lights.iter().find_map(Emitter::toward)
    }

    /// The nearest tentative collision between two distances along a ray. Components are independent Poisson
    /// processes, so the nearest of one draw from each is a draw from their superposition.
    pub fn tentative(
        &self,
        p: DVec3,
        d: DVec3,
        from_m: f64,
        to_m: f64,
        draw: &mut Draw,
    ) -> Option<(Tentative, Source)> {
        let mut end = to_m;
        let mut nearest = None;
        if !self.air.is_empty() {
            let line = self.shape.line(p, d);
            if let Some(found) = self.air.tentative(&line, from_m, end, draw.exponential()) {
                end = found.t_m;
                nearest = Some((found, Source::Air));
            }
        }
        for (i, body) in self.bodies.iter().enumerate() {
            if let Some(found) = body.tentative(p, d, from_m, end, draw.exponential()) {
                end = found.t_m;
                nearest = Some((found, Source::Body(i)));
            }
        }
        nearest
    }

    /// An unbiased estimate of the transmittance between `p` and a point `distance_m` (which may be infinite) away:
    /// quadrature through the air, ratio tracking through bodies. `None` when the ground is in between.
    pub fn transmittance(&self, p: DVec3, d: DVec3, distance_m: f64, draw: &mut Draw) -> Option<Bands> {
        let Some(span) = self.span(p, d) else { return Some(spectrum::ONE) };
        if span.end == End::Ground && span.end_m < distance_m {
            return None;
        }
        let end = span.end_m.min(distance_m);
        let mut transmittance = spectrum::ONE;
        if !self.air.is_empty() {
            let depth = self.air.optical_depth(&self.shape.line(p, d), span.start_m, end);
            transmittance = spectrum::attenuation(depth);
        }
        for body in self.bodies.iter() {
            transmittance = spectrum::product(transmittance, body.ratio_tracking(p, d, end, draw));
        }
        Some(transmittance)
    }
}
