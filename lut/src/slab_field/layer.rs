//! Reflection and transmission of an even layer, by doubling from one too thin to scatter twice.

use std::f64::consts::{PI, TAU};

use super::STREAMS;
use crate::quadrature::{GaussNode, gauss_legendre};

/// Radiances in the directions of a hemisphere.
pub type Vector = [f64; STREAMS];

/// Optical depth of what is doubled first, at most: light that it scatters twice is as small against that scattered once.
const THIN: f64 = 1e-6;

/// What radiances in a hemisphere become.
#[derive(Debug, Clone, Copy)]
pub struct Matrix(pub [Vector; STREAMS]);

impl Matrix {
    pub fn from_fn(entry: impl Fn(usize, usize) -> f64) -> Self {
        Self(std::array::from_fn(|row| std::array::from_fn(|column| entry(row, column))))
    }

    pub fn times(&self, vector: &Vector) -> Vector {
        self.0.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
    }

    pub fn column(&self, column: usize) -> Vector {
        self.0.map(|row| row[column])
    }

    pub fn product(&self, other: &Self) -> Self {
        Self::from_fn(|row, column| (0..STREAMS).map(|k| self.0[row][k] * other.0[k][column]).sum())
    }

    pub fn sum(&self, other: &Self) -> Self {
        Self::from_fn(|row, column| self.0[row][column] + other.0[row][column])
    }

    /// (1 - self)⁻¹ of a vector. Its rows sum to less than 1, by which elimination needs no pivots.
    pub fn solve_from_identity(&self, vector: &Vector) -> Vector {
        let mut left = Self::from_fn(|row, column| f64::from(u8::from(row == column)) - self.0[row][column]).0;
        let mut right = *vector;
        for pivot in 0..STREAMS {
            let of_pivot = left[pivot];
            for row in pivot + 1..STREAMS {
                let factor = left[row][pivot] / of_pivot[pivot];
                left[row].iter_mut().zip(of_pivot).for_each(|(entry, other)| *entry -= factor * other);
                right[row] -= factor * right[pivot];
            }
        }
        for row in (0..STREAMS).rev() {
            let known: f64 = (row + 1..STREAMS).map(|column| left[row][column] * right[column]).sum();
            right[row] = (right[row] - known) / left[row][row];
        }
        right
    }

    /// (1 - self)⁻¹ other.
    fn solve_all(&self, other: &Self) -> Self {
        let columns: Vec<Vector> = (0..STREAMS).map(|column| self.solve_from_identity(&other.column(column))).collect();
        Self::from_fn(|row, column| columns[column][row])
    }
}

/// A part of radiance by azimuth φ from the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Part {
    /// Its mean.
    Mean,
    /// What goes as cos φ.
    Cosine,
}

/// Directions of a hemisphere by Gauss's rule, and how matter scatters one part of radiance between them.
#[derive(Debug, Clone)]
pub struct Streams {
    part: Part,
    cosines: Vector,
    weights: Vector,
    albedo: f64,
    mean_cosine: f64,
}

fn sine(cosine: f64) -> f64 {
    (1.0 - cosine * cosine).sqrt()
}

impl Streams {
    pub fn new(part: Part, albedo: f64, mean_cosine: f64) -> Self {
        let nodes = gauss_legendre(STREAMS);
        let [cosines, weights] = [|node: &GaussNode| node.abscissa, |node: &GaussNode| node.weight]
            .map(|of| std::array::from_fn(|i| of(&nodes[i])));
        Self { part, cosines, weights, albedo, mean_cosine }
    }

    /// Mean of radiances over the hemisphere.
    pub fn mean(&self, radiances: &Vector) -> f64 {
        radiances.iter().zip(&self.weights).map(|(radiance, weight)| radiance * weight).sum()
    }

    /// Flux of radiances through a horizontal plane.
    pub fn flux(&self, radiances: &Vector) -> f64 {
        TAU * (0..STREAMS).map(|i| self.cosines[i] * self.weights[i] * radiances[i]).sum::<f64>()
    }

    /// Flux of the part that goes as cos φ through a vertical plane that faces the beam's azimuth, from one hemisphere.
    pub fn flux_along(&self, radiances: &Vector) -> f64 {
        PI * (0..STREAMS).map(|i| sine(self.cosines[i]) * self.weights[i] * radiances[i]).sum::<f64>()
    }

    /// Share of a beam with a cosine that matter sends on into another, per optical depth and steradian; on which side of it says the
    /// sign.
    fn beam_scattered_per_sr(&self, side: f64, to: f64, from: f64) -> f64 {
        self.albedo / (4.0 * PI)
            * match self.part {
                Part::Mean => 1.0 + 3.0 * self.mean_cosine * side * to * from,
                Part::Cosine => 3.0 * self.mean_cosine * sine(to) * sine(from),
            }
    }

    /// The same of radiance that goes as the part does: the mean of cos² φ is a half.
    fn scattered_per_sr(&self, side: f64, to: f64, from: f64) -> f64 {
        self.beam_scattered_per_sr(side, to, from) * if self.part == Part::Mean { 1.0 } else { 0.5 }
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

impl Layer {
    /// Of an optical depth.
    pub fn new(streams: &Streams, depth: f64) -> Self {
        let (doublings, thin) = Streams::thin(depth);
        (0..doublings).fold(Self::thin(streams, thin), |layer, _| layer.doubled())
    }

    fn thin(streams: &Streams, depth: f64) -> Self {
        let cosines = &streams.cosines;
        let scattered = |side: f64, to: usize, from: usize| {
            let per_sr = streams.scattered_per_sr(side, cosines[to], cosines[from]);
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

/// That of a layer of an optical depth under a beam of this cosine, whose flux through a horizontal plane is 1 at the top.
pub fn source(streams: &Streams, depth: f64, mu: f64) -> Source {
    let (doublings, thin) = Streams::thin(depth);
    let of = |side: f64| {
        std::array::from_fn(|i| {
            let cosine = streams.cosines[i];
            streams.beam_scattered_per_sr(side, cosine, mu) * lost(thin, mu) / cosine
        })
    };
    let mut layer = Layer::thin(streams, thin);
    let mut source = Source { down: of(1.0), up: of(-1.0) };
    let mut left = (-thin / mu).exp();
    for _ in 0..doublings {
        // The lower half lies under what the upper one leaves of the beam.
        let lower_up = source.up.map(|radiance| left * radiance);
        let returned = layer.reflected.times(&lower_up);
        let arriving = std::array::from_fn(|i| source.down[i] + returned[i]);
        let down = layer.reflected.product(&layer.reflected).solve_from_identity(&arriving);
        let up = layer.reflected.times(&down);
        let up: Vector = std::array::from_fn(|i| up[i] + lower_up[i]);
        let (passed_down, passed_up) = (layer.transmitted.times(&down), layer.transmitted.times(&up));
        source = Source {
            down: std::array::from_fn(|i| passed_down[i] + left * source.down[i]),
            up: std::array::from_fn(|i| source.up[i] + passed_up[i]),
        };
        layer = layer.doubled();
        left *= left;
    }
    source
}
