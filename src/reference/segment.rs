//! Events spread along a whole ray through stratified air, each with its exact transmittance.
//!
//! Delta tracking finds one collision where the matter is; in twilight the light is where matter is thin, behind
//! much that is dense. Here several points are drawn along the ray from a density that covers both, weighted with the
//! transmittance that quadrature gives, and the walk goes on from one of them.

use glam::DVec3;
use welkin_lut::Bands;

use super::air::Air;
use super::line::Line;
use super::shape::Span;
use super::spectrum;
use super::world::World;

/// Shares of the density of points: scattering × transmittance where there is sun, the same anywhere, length.
const SHARES: [f64; 3] = [0.6, 0.25, 0.15];
/// Pieces into which a ray is cut at least.
const PIECES: f64 = 16.0;

/// A piecewise constant probability density of distances along a ray; its buffers are reused.
#[derive(Debug, Clone, Default)]
pub struct Segment {
    edges: Vec<f64>,
    weights: Vec<[f64; 3]>,
    cumulative: Vec<f64>,
}

impl Segment {
    /// Prepares the density for the ray from `p` along `d`. `weight` says how much each band counts.
    pub fn prepare(&mut self, world: &World, p: DVec3, d: DVec3, span: &Span, sun: DVec3, weight: Bands) {
        let (shape, air) = (&world.shape, &world.air);
        let line = shape.line(p, d);
        self.cut(air, &line, span);
        self.weights.clear();
        let mut depth = spectrum::ZERO;
        let mut density = Vec::with_capacity(8);
        for ends in self.edges.windows(2) {
            let (length, middle) = (ends[1] - ends[0], 0.5 * (ends[0] + ends[1]));
            let local = air.local(line.altitude(middle), &mut density);
            let (scattering, extinction) = (local.scattering(), local.extinction());
            let (mut seen, mut thin) = (0.0, 0.0);
            for j in 0..weight.len() {
                let tau = depth[j] + 0.5 * length * extinction[j];
                thin += weight[j] * scattering[j] * length;
                seen += weight[j] * scattering[j] * length * (-tau).exp();
            }
            spectrum::accumulate(&mut depth, length, extinction);
            let lit = !shape.blocked(p + d * middle, sun);
            self.weights.push([if lit { seen } else { 0.0 }, 0.9 * seen + 0.1 * thin, length]);
        }
        self.accumulate();
    }

    fn accumulate(&mut self) {
        let mut totals = [0.0; 3];
        for weights in &self.weights {
            (0..3).for_each(|k| totals[k] += weights[k]);
        }
        let factors: [f64; 3] = std::array::from_fn(|k| if totals[k] > 0.0 { SHARES[k] / totals[k] } else { 0.0 });
        self.cumulative.clear();
        let mut running = 0.0;
        for weights in &self.weights {
            running += (0..3).map(|k| factors[k] * weights[k]).sum::<f64>();
            self.cumulative.push(running);
        }
        self.cumulative.iter_mut().for_each(|c| *c /= running);
    }

    /// Whether the ray has no length: it starts where it ends, on the ground.
    pub fn is_empty(&self) -> bool {
        self.cumulative.is_empty()
    }

    /// A distance (m) and its density (1/m) from a number in [0, 1[.
    pub fn sample(&self, u: f64) -> (f64, f64) {
        let cell = self.cumulative.partition_point(|&c| c <= u).min(self.cumulative.len() - 1);
        let below = if cell == 0 { 0.0 } else { self.cumulative[cell - 1] };
        let probability = self.cumulative[cell] - below;
        let length = self.edges[cell + 1] - self.edges[cell];
        (self.edges[cell] + length * (u - below) / probability, probability / length)
    }

    /// Cuts at the shells' boundaries and halves what is still long.
    fn cut(&mut self, air: &Air, line: &Line, span: &Span) {
        self.edges.clear();
        self.edges.push(span.start_m);
        let longest = (span.end_m - span.start_m) / PIECES;
        let mut last = span.start_m;
        let lowest = line.lowest();
        let mut add = |t: f64| {
            if t > last && t <= span.end_m {
                let pieces = ((t - last) / longest).ceil().max(1.0);
                let step = (t - last) / pieces;
                (1..pieces as usize).for_each(|k| self.edges.push(last + step * k as f64));
                self.edges.push(t);
                last = t;
            }
        };
        if lowest > span.start_m {
            air.shell_bounds_m().rev().filter_map(|altitude| line.fall(altitude)).for_each(&mut add);
            add(lowest.min(span.end_m));
        }
        air.shell_bounds_m().filter_map(|altitude| line.rise(altitude)).filter(|&t| t > lowest).for_each(&mut add);
        add(span.end_m);
    }
}
