//! Reflection and transmission of an even layer, by doubling from one too thin to scatter twice.

use std::f64::consts::{PI, TAU};

use super::matrix::{Matrix, Vector};
use super::{MOMENTS, STREAMS};
use crate::quadrature::{GaussNode, gauss_legendre};

/// Optical depth of what is doubled first, at most: light that it scatters twice is as small against that scattered once.
const THIN: f64 = 2e-5;

/// Directions of a hemisphere by Gauss's rule, and how matter scatters what of radiance goes as cos(m φ) between them, φ the azimuth from the
/// beam.
#[derive(Debug, Clone)]
pub struct Streams {
    /// m.
    mode: usize,
    cosines: Vector,
    weights: Vector,
    albedo: f64,
    /// (2l+1) times the moments of the phase function.
    strengths: [f64; MOMENTS],
    /// Λ_l^m at the cosines.
    at_cosines: [[f64; MOMENTS]; STREAMS],
}

/// √((l-m)! / (l+m)!) P_l^m for all l: products of two of them are the modes of P_l of the angle between two directions.
pub fn associated(mode: usize, cosine: f64) -> [f64; MOMENTS] {
    let mut values = [0.0; MOMENTS];
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    values[mode] = (1..=mode).map(|k| sine * ((2 * k - 1) as f64 / (2 * k) as f64).sqrt()).product();
    for l in mode + 1..MOMENTS {
        let root = |l: usize| ((l * l - mode * mode) as f64).sqrt();
        let before = if l >= 2 { values[l - 2] } else { 0.0 };
        values[l] = ((2 * l - 1) as f64 * cosine * values[l - 1] - root(l - 1) * before) / root(l);
    }
    values
}

/// 1 or -1: Λ_l^m of a cosine and of minus that cosine are the same but for this sign.
fn parity(mode: usize, degree: usize) -> f64 {
    if (mode + degree).is_multiple_of(2) { 1.0 } else { -1.0 }
}

impl Streams {
    pub fn new(mode: usize, albedo: f64, moments: &[f64; MOMENTS]) -> Self {
        let nodes = gauss_legendre(STREAMS);
        let [cosines, weights]: [Vector; 2] = [|node: &GaussNode| node.abscissa, |node: &GaussNode| node.weight]
            .map(|of| std::array::from_fn(|i| of(&nodes[i])));
        let strengths = std::array::from_fn(|l| (2 * l + 1) as f64 * moments[l]);
        let at_cosines = cosines.map(|cosine| associated(mode, cosine));
        Self { mode, cosines, weights, albedo, strengths, at_cosines }
    }

    /// Mean of radiances over the hemisphere.
    pub fn mean(&self, radiances: &Vector) -> f64 {
        radiances.iter().zip(&self.weights).map(|(radiance, weight)| radiance * weight).sum()
    }

    /// Flux of radiances of mode 0 through a horizontal plane.
    pub fn flux(&self, radiances: &Vector) -> f64 {
        TAU * (0..STREAMS).map(|i| self.cosines[i] * self.weights[i] * radiances[i]).sum::<f64>()
    }

    /// Means over all directions of radiances downwards and upwards, times Λ_l^m of the direction: from them
    /// [`Self::scattered`] finds what goes where.
    pub fn moments(&self, down: &Vector, up: &Vector) -> [f64; MOMENTS] {
        std::array::from_fn(|l| {
            let sum = |i: usize| self.weights[i] * self.at_cosines[i][l] * (down[i] + parity(self.mode, l) * up[i]);
            0.5 * (0..STREAMS).map(sum).sum::<f64>()
        })
    }

    /// Of light with these moments, what matter sends into a direction, per scattering coefficient; `to` is Λ_l^m of its cosine downwards.
    pub fn scattered(&self, moments: &[f64; MOMENTS], to: &[f64; MOMENTS]) -> f64 {
        (self.mode..MOMENTS).map(|l| self.strengths[l] * moments[l] * to[l]).sum()
    }

    /// Share of radiance from one direction that matter sends on into another, per optical depth and steradian; on which side of it says the
    /// sign.
    fn scattered_per_sr(&self, side: f64, to: &[f64; MOMENTS], from: &[f64; MOMENTS]) -> f64 {
        let of_degree = |l: usize| {
            let sign = if side < 0.0 { parity(self.mode, l) } else { 1.0 };
            sign * self.strengths[l] * to[l] * from[l]
        };
        self.albedo / (4.0 * PI) * (self.mode..MOMENTS).map(of_degree).sum::<f64>()
    }

    /// The same of a beam, whose modes but the first are twice as strong.
    fn beam_scattered_per_sr(&self, side: f64, to: &[f64; MOMENTS], beam: &[f64; MOMENTS]) -> f64 {
        self.scattered_per_sr(side, to, beam) * if self.mode == 0 { 1.0 } else { 2.0 }
    }

    /// How many times a layer that is thin enough is doubled, and its optical depth.
    fn thin(depth: f64) -> (u32, f64) {
        let doublings = (depth / THIN).log2().ceil().max(0.0) as u32;
        (doublings, depth / f64::from(doublings).exp2())
    }
}

/// What a layer takes from light of a cosine, without cancellation: with it a thin layer keeps energy to the last digit.
fn lost(depth: f64, cosine: f64) -> f64 {
    -(-depth / cosine).exp_m1()
}

/// A layer of even matter. It is the same from above and from below.
#[derive(Debug, Clone, Copy)]
pub struct Layer {
    /// What it sends back.
    pub reflected: Matrix,
    /// What it lets through, scattered or not.
    pub transmitted: Matrix,
}

/// A layer with the thinner ones that were doubled to it.
#[derive(Debug, Clone)]
pub struct Doubled {
    depth: f64,
    layers: Vec<Layer>,
}

impl Doubled {
    /// Of an optical depth.
    pub fn new(streams: &Streams, depth: f64) -> Self {
        let (doublings, thin) = Streams::thin(depth);
        let first = Layer::thin(streams, thin);
        let layers = std::iter::successors(Some(first), |layer| Some(layer.doubled())).take(doublings as usize + 1);
        Self { depth, layers: layers.collect() }
    }

    /// The whole layer.
    pub fn whole(&self) -> &Layer {
        self.layers.last().expect("there is one at least")
    }

    /// What it scatters out of a beam of this cosine, whose flux through a horizontal plane is 1 at the top.
    pub fn source(&self, streams: &Streams, mu: f64) -> Source {
        let (doublings, thin) = Streams::thin(self.depth);
        let beam = associated(streams.mode, mu);
        let of = |side: f64| {
            std::array::from_fn(|i| {
                streams.beam_scattered_per_sr(side, &streams.at_cosines[i], &beam) * lost(thin, mu) / streams.cosines[i]
            })
        };
        let first = Source { down: of(1.0), up: of(-1.0) };
        let lefts = (0..doublings).scan((-thin / mu).exp(), |left, _| Some(std::mem::replace(left, *left * *left)));
        self.layers.iter().zip(lefts).fold(first, |source, (half, left)| source.doubled(half, left))
    }
}

impl Layer {
    fn thin(streams: &Streams, depth: f64) -> Self {
        let (cosines, at) = (&streams.cosines, &streams.at_cosines);
        let scattered = |side: f64, to: usize, from: usize| {
            let per_sr = streams.scattered_per_sr(side, &at[to], &at[from]);
            TAU * streams.weights[from] * per_sr * lost(depth, cosines[from]) * cosines[from] / cosines[to]
        };
        let straight = |to: usize, from: usize| if to == from { (-depth / cosines[to]).exp() } else { 0.0 };
        Self {
            reflected: Matrix::from_fn(|to, from| scattered(-1.0, to, from)),
            transmitted: Matrix::from_fn(|to, from| straight(to, from) + scattered(1.0, to, from)),
        }
    }

    fn doubled(&self) -> Self {
        // Light between the halves goes back and forth.
        let between = self.reflected.product(&self.reflected).solve_all(&self.transmitted);
        let returned = self.transmitted.product(&self.reflected.product(&between));
        Self { reflected: self.reflected.sum(&returned), transmitted: self.transmitted.product(&between) }
    }
}

/// What a layer scatters out of a beam: radiances at its bottom and at its top.
#[derive(Debug, Clone, Copy, Default)]
pub struct Source {
    pub down: Vector,
    pub up: Vector,
}

impl Source {
    /// That of two layers, of which each scatters so and the upper one leaves so much of the beam.
    fn doubled(&self, half: &Layer, left: f64) -> Self {
        let lower_up = self.up.map(|radiance| left * radiance);
        let returned = half.reflected.times(&lower_up);
        let arriving = std::array::from_fn(|i| self.down[i] + returned[i]);
        let down = half.reflected.product(&half.reflected).solve_from_identity(&arriving);
        let up = half.reflected.times(&down);
        let up: Vector = std::array::from_fn(|i| up[i] + lower_up[i]);
        let (passed_down, passed_up) = (half.transmitted.times(&down), half.transmitted.times(&up));
        Self {
            down: std::array::from_fn(|i| passed_down[i] + left * self.down[i]),
            up: std::array::from_fn(|i| self.up[i] + passed_up[i]),
        }
    }
}
