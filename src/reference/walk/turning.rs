//! Where a walk goes on from a vertex: by the phase function or the ground's cosine, towards light by a guide's lobe, and
//! with extra walks towards the sun. The density of all these ways together weighs whichever was taken.

use std::f64::consts::PI;

use glam::DVec3;
use welkin_lut::{BAND_COUNT, Bands};

use super::{State, Vertex, Walker};
use crate::reference::matter::{Local, around};
use crate::reference::spectrum::sum;
use crate::reference::sunward;
use crate::reference::tally::Tally;

impl Walker<'_> {
    /// Chooses a new direction at a vertex and weighs it. Extra walks towards the sun are followed to their ends.
    pub(in crate::reference) fn turn(&mut self, state: &mut State, at: DVec3, vertex: &Vertex, tally: &mut Tally) {
        if let Some(sunward) = self.sunward.filter(|_| self.draw.uniform() < sunward::RATE) {
            let direction = sunward.sample(&mut self.draw);
            let mut extra = self.turned(state, at, vertex, direction);
            if sum(extra.weight) > 0.0 && self.survives(&mut extra) {
                self.follow(extra, tally);
            }
        }
        let direction = self.sample(state, at, vertex);
        *state = self.turned(state, at, vertex, direction);
    }

    /// The walk after it has been turned into a direction.
    fn turned(&self, state: &State, at: DVec3, vertex: &Vertex, direction: DVec3) -> State {
        let pdf = self.pdf(state, at, vertex, direction);
        let response = vertex.response(state.direction, direction);
        State {
            position: at,
            direction,
            weight: std::array::from_fn(|j| state.weight[j] * response[j] / pdf),
            order: state.order + 1,
            pdf_per_sr: Some(pdf),
            reach_m: f64::INFINITY,
            ..*state
        }
    }

    fn sample(&mut self, state: &State, at: DVec3, vertex: &Vertex) -> DVec3 {
        let lobe = self.guide.as_ref().and_then(|guide| guide.lobe(self.world, at, state.order));
        let mut choice = self.draw.uniform();
        let (u, turn) = (self.draw.uniform(), self.draw.uniform());
        if let Some(lobe) = lobe {
            if choice < lobe.share {
                return lobe.sample(u, turn);
            }
            choice = (choice - lobe.share) / (1.0 - lobe.share);
        }
        match vertex {
            Vertex::Medium(local, _) => {
                let mut choice = choice * importance(local, state.weight).sum::<f64>();
                let mut chosen = 0;
                for (i, share) in importance(local, state.weight).enumerate() {
                    if share > 0.0 {
                        chosen = i;
                        if choice < share {
                            break;
                        }
                        choice -= share;
                    }
                }
                let cosine = local.matter[chosen].phase.sample(u);
                around(state.direction, cosine, turn).normalize()
            }
            Vertex::Ground(_, normal) => around(*normal, (1.0 - u).sqrt(), turn).normalize(),
        }
    }

    /// Density with which a walk and its extra walks choose a direction, 1/sr.
    pub(super) fn pdf(&self, state: &State, at: DVec3, vertex: &Vertex, direction: DVec3) -> f64 {
        let own = match vertex {
            Vertex::Medium(local, _) => {
                let cosine = state.direction.dot(direction).clamp(-1.0, 1.0);
                let (mut total, mut weighted) = (0.0, 0.0);
                for (share, matter) in importance(local, state.weight).zip(local.matter) {
                    if share > 0.0 {
                        total += share;
                        weighted += share * matter.phase.value(cosine);
                    }
                }
                weighted / total
            }
            Vertex::Ground(_, normal) => normal.dot(direction).max(0.0) / PI,
        };
        let chosen = match self.guide.as_ref().and_then(|guide| guide.lobe(self.world, at, state.order)) {
            Some(lobe) => (1.0 - lobe.share) * own + lobe.share * lobe.pdf(direction),
            None => own,
        };
        chosen + self.sunward.map_or(0.0, |sunward| sunward::RATE * sunward.pdf(direction))
    }
}

/// How much each constituent scatters, over the bands as the walk weighs them, relative to the sum of the weights: a
/// weight may be so small that a product with it is zero, and what the products are shares of is not to be 0/0.
fn importance(local: &Local, weight: Bands) -> impl Iterator<Item = f64> {
    let whole = sum(weight);
    let share = weight.map(|w| w / whole);
    local.matter.iter().zip(local.density).map(move |(matter, density)| {
        density * (0..BAND_COUNT).map(|j| share[j] * matter.scattering_per_m[j]).sum::<f64>()
    })
}
