//! Where along a view ray through stratified air the first event of a walk is put.

use glam::DVec3;
use welkin_lut::{BAND_COUNT, Bands};

use super::guide::Guide;
use super::shape::End;
use super::single;
use super::spectrum;
use super::transport::breakpoints;
use super::world::World;

/// Cells into which a view ray is cut at least.
const CELLS: f64 = 24.0;
/// Largest optical depth of a cell (in the band that sees least) up to [`OPAQUE`].
const CELL_DEPTH: f64 = 0.4;
/// Optical depth beyond which cells are no longer refined.
const OPAQUE: f64 = 12.0;
/// Shares of the density of distances: scattering × transmittance × light from the sunward horizon (in twilight);
/// scattering × transmittance; scattering; length.
const SHARES: [f64; 4] = [0.4, 0.35, 0.15, 0.1];

/// A piecewise constant probability density of distances, and a probability of the ground at the end.
#[derive(Debug, Clone)]
pub struct FirstEvent {
    /// Cell boundaries, m.
    edges: Vec<f64>,
    /// Running sum of the cells' probabilities; the last is 1 - the ground's.
    cumulative: Vec<f64>,
}

/// A place for the first event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Distance along the ray, m.
    pub t_m: f64,
    /// Whether it is the ground.
    pub on_ground: bool,
    /// Probability of the ground, or density of the distance, 1/m.
    pub probability: f64,
}

impl FirstEvent {
    /// For the ray from `p` along `d` up to a distance; `None` when nothing can happen to it.
    pub fn new(world: &World, p: DVec3, d: DVec3, reach_m: f64) -> Option<Self> {
        let span = world.shape.span(p, d)?.within(reach_m)?;
        let edges = cut(world, p, d, &breakpoints(world, p, d, &span));
        let cells = edges.len() - 1;
        let mut density = Vec::new();
        let mut depth: Bands = [0.0; BAND_COUNT];
        let mut thin = vec![[0.0; BAND_COUNT]; cells];
        let mut seen = thin.clone();
        for i in 0..cells {
            let (a, b) = (edges[i], edges[i + 1]);
            let at = world.shape.altitude(p + d * (0.5 * (a + b)));
            let scattering = world.air.local(at, &mut density).scattering();
            let step = cell_depth(world, p, d, a, b);
            for j in 0..BAND_COUNT {
                thin[i][j] = scattering[j] * (b - a);
                // Mean transmittance over the cell; (1 - e^-x)/x without cancellation.
                let mean = if step[j] > 1e-8 { -(-step[j]).exp_m1() / step[j] } else { 1.0 };
                seen[i][j] = thin[i][j] * (-depth[j]).exp() * mean;
                depth[j] += step[j];
            }
        }
        let glow = Guide::new(world).and_then(|guide| glow(world, &guide, p, d, &edges));
        let glowing = match glow {
            Some(glow) => seen.iter().zip(glow).map(|(&seen, glow)| spectrum::product(seen, glow)).collect(),
            None => seen.clone(),
        };
        let reflected: Bands = match span.end {
            End::Ground => std::array::from_fn(|j| world.ground_albedo[j] * (-depth[j]).exp()),
            End::Space => [0.0; BAND_COUNT],
        };
        Self::from_weights(edges, &[glowing, seen, thin], reflected)
    }

    fn from_weights(edges: Vec<f64>, densities: &[Vec<Bands>; 3], reflected: Bands) -> Option<Self> {
        let cells = edges.len() - 1;
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let totals: [Bands; 3] =
            std::array::from_fn(|k| std::array::from_fn(|j| densities[k].iter().map(|cell| cell[j]).sum::<f64>()));
        let bands = BAND_COUNT as f64;
        let ground = (0..BAND_COUNT).map(|j| share(reflected[j], reflected[j] + totals[1][j])).sum::<f64>() / bands;
        let length = edges[cells] - edges[0];
        let weight = |i: usize| -> f64 {
            let mean = |k: usize| (0..BAND_COUNT).map(|j| share(densities[k][i][j], totals[k][j])).sum::<f64>() / bands;
            (0..3).map(|k| SHARES[k] * mean(k)).sum::<f64>() + SHARES[3] * (edges[i + 1] - edges[i]) / length
        };
        let mut weights: Vec<f64> = (0..cells).map(weight).collect();
        if totals[2] == spectrum::ZERO {
            weights.fill(0.0);
        }
        let sum: f64 = weights.iter().sum();
        if sum == 0.0 && ground == 0.0 {
            return None;
        }
        let mut running = 0.0;
        let scale = if sum > 0.0 { (1.0 - ground) / sum } else { 0.0 };
        let cumulative = weights.iter().map(|w| {
            running += w * scale;
            running
        });
        Some(Self { cumulative: cumulative.collect(), edges })
    }

    /// Where the ray enters the matter, m.
    pub fn start_m(&self) -> f64 {
        self.edges[0]
    }

    /// A place from a number in [0, 1[.
    pub fn sample(&self, u: f64) -> Sample {
        let cell = self.cumulative.partition_point(|&c| c <= u);
        if cell >= self.cumulative.len() {
            let probability = 1.0 - self.cumulative[self.cumulative.len() - 1];
            return Sample { t_m: self.edges[self.edges.len() - 1], on_ground: true, probability };
        }
        let below = if cell == 0 { 0.0 } else { self.cumulative[cell - 1] };
        let probability = self.cumulative[cell] - below;
        let (a, b) = (self.edges[cell], self.edges[cell + 1]);
        let t_m = a + (b - a) * (u - below) / probability;
        Sample { t_m, on_ground: false, probability: probability / (b - a) }
    }
}

/// In twilight: light of the first order that arrives at the middle of each cell from the sunward horizon. `None` where
/// no cell lies in twilight.
fn glow(world: &World, guide: &Guide, p: DVec3, d: DVec3, edges: &[f64]) -> Option<Vec<Bands>> {
    let middles = edges.windows(2).map(|ends| p + d * (0.5 * (ends[0] + ends[1])));
    let of = |at: DVec3| -> Option<Bands> {
        let lobe = guide.lobe(world, at, 0)?;
        let mut sum = spectrum::ZERO;
        for u in [0.2, 0.4, 0.6, 0.8] {
            let first = single::first_order(world, at, lobe.sample(u, 0.5), 0.3);
            spectrum::accumulate(&mut sum, 0.25, first.single.value);
        }
        Some(sum)
    };
    middles.map(of).collect()
}

fn cell_depth(world: &World, p: DVec3, d: DVec3, from_m: f64, to_m: f64) -> Bands {
    world.air.optical_depth(&world.shape.line(p, d), from_m, to_m)
}

/// Refines cells that are long or opaque, from the start of the ray on.
fn cut(world: &World, p: DVec3, d: DVec3, breakpoints: &[f64]) -> Vec<f64> {
    let (start, end) = (breakpoints[0], breakpoints[breakpoints.len() - 1]);
    let mut pending: Vec<(f64, f64)> =
        breakpoints.windows(2).map(|ends| (ends[0], ends[1])).filter(|(a, b)| b > a).rev().collect();
    let mut edges = vec![start];
    let mut depth = 0.0;
    while let Some((a, b)) = pending.pop() {
        let most = cell_depth(world, p, d, a, b).into_iter().fold(0.0, f64::max);
        let coarse = b - a > (end - start) / CELLS || (most > CELL_DEPTH && depth < OPAQUE);
        if coarse && b - a > 1e-6 * (end - start) {
            let middle = 0.5 * (a + b);
            pending.push((middle, b));
            pending.push((a, middle));
        } else {
            depth += most;
            edges.push(b);
        }
    }
    if edges.len() == 1 {
        edges.push(end);
    }
    edges
}
