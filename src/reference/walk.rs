//! One backward walk: delta tracking, next-event estimation at every tentative collision (of point lights, once on every
//! ray: [`super::line_event`]), Russian roulette.
//!
//! All bands travel together. At a tentative collision the walk scatters or goes on with probabilities in proportion
//! to what the bands' weights would become ("history-aware" spectral tracking, Kutz et al. 2017, section 5), so the
//! sum of the weights never grows, however much extinction differs between bands; absorption is taken out of the
//! weights.

mod turning;

use std::f64::consts::PI;

use glam::DVec3;
use welkin_lut::Bands;

use super::guide::Guide;
use super::light::Emitter;
use super::matter::Local;
use super::random::Draw;
use super::segment::Segment;
use super::shape::End;
use super::spectrum::{self, sum};
use super::sunward::Sunward;
use super::tally::Tally;
use super::world::{Source, World};

/// Below this share of its first weight a walk is played for its life.
const ROULETTE_BELOW: f64 = 0.02;

/// A walk between two events.
#[derive(Debug, Clone, Copy)]
pub struct State {
    /// Where it is, m.
    pub position: DVec3,
    /// Where it goes, against the light.
    pub direction: DVec3,
    /// Contribution of a unit of radiance that arrives from `direction`.
    pub weight: Bands,
    /// Scatterings and reflections so far.
    pub order: usize,
    /// Whether it has met the ground.
    pub ground: bool,
    /// Density with which the direction was chosen, 1/sr; `None` for a camera's ray.
    pub pdf_per_sr: Option<f64>,
    /// Distance at which a black surface stands on the ray, m; infinite after the first event.
    pub reach_m: f64,
    /// Sum of the weights at which roulette measures.
    pub reference: f64,
}

/// Walks through one world.
#[derive(Debug)]
pub struct Walker<'a> {
    pub(super) world: &'a World,
    guide: Option<Guide>,
    sunward: Option<Sunward<'a>>,
    /// Whether there are point lights, whose light in matter is found ray by ray and not at collisions.
    has_points: bool,
    pub(super) density: Vec<f64>,
    pub(super) segment: Segment,
    /// The random numbers.
    pub draw: Draw,
}

/// A place where light turns into the walk's direction.
pub(super) enum Vertex<'a> {
    /// Matter, and the rate with which walks collide there (1/m).
    Medium(Local<'a>, f64),
    /// Ground with this albedo and normal.
    Ground(Bands, DVec3),
}

impl Vertex<'_> {
    /// Contribution per unit of irradiance arriving from `to`, for a walk that came along `from`, 1/sr.
    fn response(&self, from: DVec3, to: DVec3) -> Bands {
        match self {
            Self::Medium(local, rate) => local.in_scattering(from.dot(to).clamp(-1.0, 1.0)).map(|s| s / rate),
            Self::Ground(albedo, normal) => albedo.map(|a| a / PI * normal.dot(to).max(0.0)),
        }
    }
}

impl<'a> Walker<'a> {
    /// A walker with its own random numbers.
    pub fn new(world: &'a World, draw: Draw) -> Self {
        Self {
            world,
            guide: Guide::new(world),
            sunward: Sunward::new(world),
            has_points: world.lights.iter().any(is_point),
            density: Vec::new(),
            segment: Segment::default(),
            draw,
        }
    }

    /// Follows a walk to its end. Light that it finds is added to `tally`.
    pub fn follow(&mut self, mut state: State, tally: &mut Tally) {
        while self.advance(&mut state, tally) {}
    }

    /// Follows the ray to the next real event; false when the walk has ended.
    fn advance(&mut self, state: &mut State, tally: &mut Tally) -> bool {
        let (p, d) = (state.position, state.direction);
        let blocked = |state: &State| state.reach_m < f64::INFINITY;
        let Some(span) = self.world.span(p, d).and_then(|span| span.within(state.reach_m)) else {
            if !blocked(state) {
                self.escape(state, tally);
            }
            return false;
        };
        if let Some(guide) = self.guide.filter(|guide| guide.spreads(self.world, p)) {
            return self.spread(state, &span, guide.sun(), tally);
        }
        if self.has_points {
            self.line_event(state, &span, tally);
        }
        let mut t = span.start_m;
        while let Some((found, source)) = self.world.tentative(p, d, t, span.end_m, &mut self.draw) {
            t = found.t_m;
            let at = p + d * t;
            let mut density = std::mem::take(&mut self.density);
            let local = self.local(at, source, &mut density);
            let alive = self.collide(state, at, &local, found.majorant_per_m, tally);
            self.density = density;
            match alive {
                Some(true) => return true,
                Some(false) => {}
                None => return false,
            }
        }
        if span.end == End::Space {
            if !blocked(state) {
                self.escape(state, tally);
            }
            return false;
        }
        self.reflect(state, p + d * span.end_m, |_| true, tally)
    }

    /// The matter of one component at a point.
    pub(super) fn local<'b>(&self, at: DVec3, source: Source, density: &'b mut Vec<f64>) -> Local<'b>
    where
        'a: 'b,
    {
        match source {
            Source::Air => self.world.air.local(self.world.shape.altitude(at), density),
            Source::Body(i) => {
                let body = &self.world.bodies[i];
                density.clear();
                density.push(body.field.density(at));
                Local { matter: &body.matter, density }
            }
        }
    }

    /// A tentative collision: true when the walk scattered, false when it goes on, `None` when it ended.
    fn collide(&mut self, state: &mut State, at: DVec3, local: &Local, rate: f64, tally: &mut Tally) -> Option<bool> {
        let vertex = Vertex::Medium(*local, rate);
        let emission = local.emission();
        if sum(emission) > 0.0 {
            let value = std::array::from_fn(|j| state.weight[j] * emission[j] / rate);
            tally.add(state.order, state.ground, value);
        }
        let (b, c) = (local.scattering(), local.extinction());
        if sum(b) > 0.0 {
            self.next_event(state, at, &vertex, |light| !is_point(light), tally);
        }
        let scattered: Bands = std::array::from_fn(|j| state.weight[j] * b[j] / rate);
        let passed: Bands = std::array::from_fn(|j| state.weight[j] * (1.0 - c[j] / rate).max(0.0));
        let probability = sum(scattered) / (sum(scattered) + sum(passed));
        // Nothing is left of the walk: 0/0.
        if probability.is_nan() {
            return None;
        }
        if self.draw.uniform() < probability {
            state.weight = state.weight.map(|w| w / probability);
            self.turn(state, at, &vertex, tally);
            return self.survives(state).then_some(true);
        }
        state.weight = passed.map(|w| w / (1.0 - probability));
        self.survives(state).then_some(false)
    }

    /// Makes the first event of a walk happen in the medium at `at`: `state.weight` is the transmittance up to there
    /// and `rate` the density with which that distance was chosen, 1/m. `lights` selects those that are estimated
    /// by next events here.
    pub fn start_in_medium(
        &mut self,
        mut state: State,
        at: DVec3,
        rate: f64,
        lights: impl Fn(&Emitter) -> bool,
        tally: &mut Tally,
    ) {
        let mut density = std::mem::take(&mut self.density);
        let local = self.local(at, Source::Air, &mut density);
        let vertex = Vertex::Medium(local, rate);
        state.reference = sum(spectrum::product(state.weight, local.scattering())) / rate;
        if state.reference > 0.0 {
            self.next_event(&state, at, &vertex, lights, tally);
            self.turn(&mut state, at, &vertex, tally);
            self.density = density;
            self.follow(state, tally);
        } else {
            self.density = density;
        }
    }

    /// Makes the first event of a walk a reflection by the ground at `at`, with the lights that `lights` selects.
    pub fn start_on_ground(
        &mut self,
        mut state: State,
        at: DVec3,
        lights: impl Fn(&Emitter) -> bool,
        tally: &mut Tally,
    ) {
        state.reference = sum(state.weight);
        if self.reflect(&mut state, at, lights, tally) {
            self.follow(state, tally);
        }
    }

    /// Reflection by the ground; false when the walk has ended.
    fn reflect(&mut self, state: &mut State, at: DVec3, lights: impl Fn(&Emitter) -> bool, tally: &mut Tally) -> bool {
        let (normal, albedo) = self.world.ground_at(at);
        if sum(albedo) == 0.0 {
            return false;
        }
        state.ground = true;
        let vertex = Vertex::Ground(albedo, normal);
        self.next_event(state, at, &vertex, lights, tally);
        self.turn(state, at, &vertex, tally);
        self.survives(state)
    }

    /// Adds the light that arrives at a vertex straight from the lights, one sample of each.
    pub(super) fn next_event(
        &mut self,
        state: &State,
        at: DVec3,
        vertex: &Vertex,
        lights: impl Fn(&Emitter) -> bool,
        tally: &mut Tally,
    ) {
        let world = self.world;
        for light in world.lights.iter().filter(|light| lights(light)) {
            let (u, v) = match light {
                Emitter::Disc { .. } | Emitter::Environment { .. } => (self.draw.uniform(), self.draw.uniform()),
                _ => (0.0, 0.0),
            };
            let sample = light.sample(at, u, v);
            let response = vertex.response(state.direction, sample.direction);
            if sum(response) == 0.0 {
                continue;
            }
            let Some(transmittance) = world.transmittance(at, sample.direction, sample.distance_m, &mut self.draw)
            else {
                continue;
            };
            // Balance heuristic (Veach & Guibas 1995) between this sample and the walk's own next direction.
            let share =
                sample.pdf_per_sr.map_or(1.0, |pdf| pdf / (pdf + self.pdf(state, at, vertex, sample.direction)));
            let value = std::array::from_fn(|j| {
                state.weight[j] * response[j] * sample.irradiance[j] * transmittance[j] * share
            });
            tally.add(state.order + 1, state.ground, value);
        }
    }

    /// The walk has left the world: it sees the lights that have an extent. A camera's own ray does not see discs.
    pub(super) fn escape(&self, state: &State, tally: &mut Tally) {
        for light in &self.world.lights {
            if state.pdf_per_sr.is_none() && !matches!(light, Emitter::Environment { .. }) {
                continue;
            }
            if let Some((radiance, pdf)) = light.radiance(state.direction) {
                let share = state.pdf_per_sr.map_or(1.0, |own| own / (own + pdf));
                tally.add(state.order, state.ground, spectrum::product(state.weight, radiance).map(|v| v * share));
            }
        }
    }

    /// Russian roulette.
    pub(super) fn survives(&mut self, state: &mut State) -> bool {
        let worth = self.sunward.map_or(1.0, |sunward| sunward.worth(state.direction));
        let share = worth * sum(state.weight) / (ROULETTE_BELOW * state.reference);
        if share >= 1.0 {
            return true;
        }
        if share.is_nan() || self.draw.uniform() >= share {
            return false;
        }
        state.weight = state.weight.map(|w| w / share);
        true
    }
}

fn is_point(light: &Emitter) -> bool {
    matches!(light, Emitter::Point { .. })
}

#[cfg(test)]
mod tests {
    use welkin_lut::{Constituent, DensityProfile, PhaseFunction};

    use super::super::light::Emitter;
    use super::super::shape::Shape;
    use super::*;

    #[test]
    fn a_walk_of_the_smallest_weight_that_a_double_holds_brings_home_a_number() {
        let (scattering_per_m, height_m, scale_height_m) = (1.125, 5546.0, 8000.0);
        let matter = Constituent {
            name: "thick".into(),
            scattering_per_m: [scattering_per_m; 3],
            absorption_per_m: [0.125; 3],
            emission_per_m: [0.0; 3],
            profile: DensityProfile::Exponential { scale_height_m },
            phase: PhaseFunction::Isotropic,
        };
        let mut world = World::stratified(Shape::Plane { height_m: 1e5 }, [0.0; 3], &[matter]);
        world.lights.push(Emitter::Beam { toward: DVec3::Z, irradiance: [1.0; 3] });
        let (smallest, density) = (f64::from_bits(1), (-height_m / scale_height_m).exp());
        // Control: this is the case in which one order of the factors leaves something and the other nothing.
        assert!(smallest * (density * scattering_per_m) > 0.0 && smallest * scattering_per_m * density == 0.0);
        let mut tally = Tally::default();
        for batch in 0..64 {
            let mut walker = Walker::new(&world, Draw::new(1, 0, batch));
            walker.draw.start(0);
            let at = DVec3::Z * height_m;
            let state = State {
                position: at,
                direction: -DVec3::Z,
                weight: [smallest; 3],
                order: 0,
                ground: false,
                pdf_per_sr: None,
                reach_m: f64::INFINITY,
                reference: 1.0,
            };
            walker.start_in_medium(state, at, 1e-6, |_| true, &mut tally);
        }
        assert!(tally.total().iter().all(|radiance| radiance.is_finite()), "{tally:?}");
    }
}
