//! Discrete ordinates, solved by doubling (Grant & Hunt 1969; van de Hulst 1963; Wiscombe 1976 for the first layer).
//!
//! Fluxes need the azimuthal mean of radiance alone. Streams are Gauss's nodes on each hemisphere, so that fluxes are
//! integrated exactly; the phase function's peak beyond what they can follow counts as not scattered (Wiscombe 1977).

use std::f64::consts::{PI, TAU};

use super::matrix::Matrix;
use super::{Fluxes, SlabMethod, without_forward_peak};
use crate::reference::quadrature::GaussLegendre;
use crate::reference::slab::Slab;

/// Optical thickness of the layer from which doubling begins, along the flattest stream.
const FIRST_LAYER: f64 = 1e-4;

/// The method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DiscreteOrdinates {
    /// Streams in each hemisphere, at least 1.
    pub streams: usize,
}

/// A homogeneous layer: what it does to the streams' radiances, and what it sends out of the beam, per irradiance at its top.
struct Layer {
    reflects: Matrix,
    transmits: Matrix,
    up: Vec<f64>,
    down: Vec<f64>,
}

impl SlabMethod for DiscreteOrdinates {
    fn name(&self) -> String {
        format!("{} discrete ordinates", 2 * self.streams)
    }

    fn fluxes(&self, slab: &Slab) -> Fluxes {
        let nodes = GaussLegendre::new(self.streams).points;
        let peak = slab.phase.legendre_moment(2 * self.streams);
        let (thickness, albedo) = without_forward_peak(slab, peak);
        let moments: Vec<f64> =
            (0..2 * self.streams).map(|l| (slab.phase.legendre_moment(l) - peak) / (1.0 - peak)).collect();
        let flattest = nodes.iter().map(|(mu, _)| *mu).fold(slab.mu0, f64::min);
        let doublings = (thickness / (FIRST_LAYER * flattest)).log2().ceil().max(0.0) as i32;
        let first = thickness / 2_f64.powi(doublings);
        let mut layer = Layer::thin(&nodes, &moments, albedo, slab.mu0, first);
        for doubling in 0..doublings {
            layer = layer.doubled((-first * 2_f64.powi(doubling) / slab.mu0).exp());
        }
        let beam = (-thickness / slab.mu0).exp();
        let direct = (-slab.optical_thickness / slab.mu0).exp();
        layer.over_surface(&nodes, slab.surface_albedo, slab.mu0, beam, direct)
    }
}

impl Layer {
    /// By the trapezoidal rule in depth: right to the third power of the thickness.
    fn thin(nodes: &[(f64, f64)], moments: &[f64], albedo: f64, mu0: f64, thickness: f64) -> Self {
        let polynomials: Vec<Vec<f64>> = nodes.iter().map(|(mu, _)| legendre(*mu, moments.len())).collect();
        let of_beam = legendre(mu0, moments.len());
        // The azimuthal mean of 4π P, to the same hemisphere (sign 1) or to the other (-1).
        let phase = |a: &[f64], b: &[f64], sign: f64| -> f64 {
            let term = |l: usize| sign.powi(l as i32) * (2 * l + 1) as f64 * moments[l] * a[l] * b[l];
            (0..moments.len()).map(term).sum()
        };
        let n = nodes.len();
        let half = |row: usize| 0.5 * thickness / nodes[row].0;
        let scattered = |row: usize, column: usize, sign: f64| {
            0.5 * albedo * nodes[column].1 * phase(&polynomials[row], &polynomials[column], sign)
        };
        let along = Matrix::from_fn(n, |row, column| {
            half(row) * (f64::from(u8::from(row == column)) - scattered(row, column, 1.0))
        });
        let across = Matrix::from_fn(n, |row, column| half(row) * scattered(row, column, -1.0));
        // Even and odd parts of the field in the two hemispheres do not mix.
        let [even, odd] = [-1.0, 1.0].map(|sign| {
            let sum = along.plus(sign, &across);
            (sum.identity_plus(1.0).inverse(), sum.identity_plus(-1.0))
        });
        let (x, y) = (even.0.times(&even.1), odd.0.times(&odd.1));
        let in_layer = mu0 * -(-thickness / mu0).exp_m1();
        let source = |sign: f64| -> Vec<f64> {
            let towards = |(row, node): (usize, &(f64, f64))| {
                albedo / (4.0 * PI) * phase(&polynomials[row], &of_beam, sign) * in_layer / node.0
            };
            nodes.iter().enumerate().map(towards).collect()
        };
        let (down, up) = (source(1.0), source(-1.0));
        let both: Vec<f64> = down.iter().zip(&up).map(|(d, u)| d + u).collect();
        let apart: Vec<f64> = down.iter().zip(&up).map(|(d, u)| d - u).collect();
        let (both, apart) = (even.0.apply(&both), odd.0.apply(&apart));
        let half_sum = |sign: f64| both.iter().zip(&apart).map(|(b, a)| 0.5 * (b + sign * a)).collect();
        Self {
            transmits: Matrix::from_fn(n, |_, _| 0.0).plus(0.5, &x).plus(0.5, &y),
            reflects: Matrix::from_fn(n, |_, _| 0.0).plus(0.5, &x).plus(-0.5, &y),
            down: half_sum(1.0),
            up: half_sum(-1.0),
        }
    }

    /// Two of these, one above the other; `beam` is what the upper one leaves of the beam.
    fn doubled(&self, beam: f64) -> Self {
        let bounces = self.reflects.times(&self.reflects).identity_plus(-1.0).inverse();
        let below: Vec<f64> = self.up.iter().map(|up| beam * up).collect();
        let back = self.reflects.apply(&below);
        let between_down =
            bounces.apply(&self.down.iter().zip(&back).map(|(down, back)| down + back).collect::<Vec<_>>());
        let returned = self.reflects.apply(&between_down);
        let between_up: Vec<f64> = returned.iter().zip(&below).map(|(returned, below)| returned + below).collect();
        let (through_up, through_down) = (self.transmits.apply(&between_up), self.transmits.apply(&between_down));
        let into = bounces.times(&self.transmits);
        Self {
            up: self.up.iter().zip(through_up).map(|(up, through)| up + through).collect(),
            down: self.down.iter().zip(through_down).map(|(down, through)| beam * down + through).collect(),
            reflects: self.reflects.plus(1.0, &self.transmits.times(&self.reflects).times(&into)),
            transmits: self.transmits.times(&into),
        }
    }

    /// Fluxes over a Lambertian surface. `beam` arrives unscattered or in the peak, `direct` unscattered alone.
    fn over_surface(&self, nodes: &[(f64, f64)], albedo: f64, mu0: f64, beam: f64, direct: f64) -> Fluxes {
        let flux = |radiances: &[f64]| -> f64 {
            TAU * nodes.iter().zip(radiances).map(|((mu, weight), radiance)| weight * mu * radiance).sum::<f64>()
        };
        let uniform = vec![1.0; nodes.len()];
        let (returned, through) = (flux(&self.reflects.apply(&uniform)), flux(&self.transmits.apply(&uniform)));
        // Radiance of the surface; light that it sends up and the slab returns comes to it again.
        let surface = albedo / PI * (flux(&self.down) + mu0 * beam) / (1.0 - albedo / PI * returned);
        Fluxes {
            reflectance: (flux(&self.up) + surface * through) / mu0,
            diffuse_transmittance: (flux(&self.down) + surface * returned) / mu0 + beam - direct,
        }
    }
}

/// P_0 .. P_(n-1).
fn legendre(x: f64, count: usize) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for l in 2..count {
        values.push(((2 * l - 1) as f64 * x * values[l - 1] - (l - 1) as f64 * values[l - 2]) / l as f64);
    }
    values.truncate(count);
    values
}
