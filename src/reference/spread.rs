//! Walks through twilight: events on several points of every ray instead of one collision.

use glam::DVec3;

use super::shape::{End, Span};
use super::spectrum::{self, sum};
use super::tally::Tally;
use super::walk::{State, Vertex, Walker};
use super::world::Source;

/// Points on each ray.
const POINTS: usize = 3;

/// One event out of several, each kept with a probability in proportion to its share: weighted reservoir sampling
/// (Chao 1982).
#[derive(Default)]
struct Reservoir {
    total: f64,
    kept: Option<Event>,
}

/// A scattering in the medium at this rate (1/m), or without one a reflection by the ground.
struct Event {
    state: State,
    at: DVec3,
    rate_per_m: Option<f64>,
    share: f64,
}

impl Reservoir {
    fn offer(&mut self, event: Event, u: f64) {
        self.total += event.share;
        if u * self.total < event.share {
            self.kept = Some(event);
        }
    }
}

impl Walker<'_> {
    /// Finds the light at several points of a ray through stratified air and at its end, and goes on from one of them
    /// in proportion to what they scatter; false when the walk has ended.
    pub(super) fn spread(&mut self, state: &mut State, span: &Span, sun: DVec3, tally: &mut Tally) -> bool {
        let mut reservoir = Reservoir::default();
        let through = self.spread_points(state, span, sun, &mut reservoir, tally);
        if span.end == End::Space {
            if state.reach_m == f64::INFINITY {
                self.escape(&through, tally);
            }
        } else {
            self.offer_ground(through, span, &mut reservoir, tally);
        }
        let Some(event) = reservoir.kept else { return false };
        *state = event.state;
        state.weight = state.weight.map(|w| w * reservoir.total / event.share);
        match event.rate_per_m {
            Some(rate) => {
                let mut density = std::mem::take(&mut self.density);
                let local = self.local(event.at, Source::Air, &mut density);
                self.turn(state, event.at, &Vertex::Medium(local, rate), tally);
                self.density = density;
            }
            None => {
                let (normal, albedo) = self.world.ground_at(event.at);
                let vertex = Vertex::Ground(albedo, normal);
                self.turn(state, event.at, &vertex, tally);
            }
        }
        self.survives(state)
    }

    /// Offers the points on the way; returns the walk as it arrives at the end of the ray.
    fn spread_points(
        &mut self,
        state: &State,
        span: &Span,
        sun: DVec3,
        reservoir: &mut Reservoir,
        tally: &mut Tally,
    ) -> State {
        let world = self.world;
        let (p, d) = (state.position, state.direction);
        let line = world.shape.line(p, d);
        let mut segment = std::mem::take(&mut self.segment);
        segment.prepare(world, p, d, span, sun, state.weight);
        let offset = self.draw.uniform();
        let mut depth = spectrum::ZERO;
        let mut from = span.start_m;
        let points = if segment.is_empty() { 0 } else { POINTS };
        for i in 0..points {
            let (t, pdf) = segment.sample((i as f64 + offset) / POINTS as f64);
            spectrum::accumulate(&mut depth, 1.0, world.air.optical_depth(&line, from, t));
            from = t;
            let there = State { weight: spectrum::product(state.weight, spectrum::attenuation(depth)), ..*state };
            self.offer_point(there, p + d * t, pdf * POINTS as f64, reservoir, tally);
        }
        self.segment = segment;
        spectrum::accumulate(&mut depth, 1.0, world.air.optical_depth(&line, from, span.end_m));
        State { weight: spectrum::product(state.weight, spectrum::attenuation(depth)), ..*state }
    }

    fn offer_point(&mut self, there: State, at: DVec3, rate: f64, reservoir: &mut Reservoir, tally: &mut Tally) {
        let mut density = std::mem::take(&mut self.density);
        let local = self.local(at, Source::Air, &mut density);
        let emission = local.emission();
        if sum(emission) > 0.0 {
            tally.add(there.order, there.ground, spectrum::product(there.weight, emission).map(|v| v / rate));
        }
        let share = sum(spectrum::product(there.weight, local.scattering())) / rate;
        if share > 0.0 {
            self.next_event(&there, at, &Vertex::Medium(local, rate), |_| true, tally);
            reservoir.offer(Event { state: there, at, rate_per_m: Some(rate), share }, self.draw.uniform());
        }
        self.density = density;
    }

    fn offer_ground(&mut self, through: State, span: &Span, reservoir: &mut Reservoir, tally: &mut Tally) {
        let at = through.position + through.direction * span.end_m;
        let (normal, albedo) = self.world.ground_at(at);
        let share = sum(spectrum::product(through.weight, albedo));
        if share == 0.0 {
            return;
        }
        let state = State { ground: true, ..through };
        self.next_event(&state, at, &Vertex::Ground(albedo, normal), |_| true, tally);
        reservoir.offer(Event { state, at, rate_per_m: None, share }, self.draw.uniform());
    }
}
