//! Light of a beam that its scatterings have hardly turned: the forward peak of a phase function, taken by itself.
//!
//! # Method
//! A phase function P is cut at a ceiling C: min(P, C) turns light away, and what rises above it, the peak, scarcely does. C is chosen so that the
//! peak holds f = χ_n of the light, as the similar medium of n moments leaves it unscattered (Joseph, Wiscombe & Weinman 1976; Wiscombe 1977):
//! the more moments who solves for the rest can follow, the narrower the peak.
//! Light that only peaks have scattered keeps to the beam's path while its directions spread, so its Legendre moments after an optical
//! depth τ are e^(-(1 - W p_l) τ), p_l the peak's moments and W the albedo (Goudsmit & Saunderson 1940, Physical Review 57, 24). What peaks scatter of it is,
//! over the beam's irradiance and the scattering coefficient,
//!
//! Σ (2l+1)/4π p_l e^(-(1 - W p_l) τ) P_l(ν) = (P(ν) - C)₊ e^(-τ) + K(τ, ν),
//!
//! K what has been scattered before. On the way to the observer all of it is dimmed by the whole depth: light that peaks scatter once more
//! there has been counted where they do. What min(P, C) scatters is dimmed by the depth of the similar medium, before and behind.

use std::f64::consts::PI;

use crate::PhaseFunction;
use crate::legendre::legendre;

/// Moments of which K is made.
const DEGREES: usize = 192;
/// Angles at which the phase function is looked at.
const ANGLES: usize = 2048;
const HALVINGS: usize = 60;

/// The forward peak of a phase function: see the [module](self).
#[derive(Debug, Clone)]
pub struct ForwardPeak {
    ceiling_per_sr: f64,
    /// p_l.
    moments: Vec<f64>,
}

/// f, the share of scattered light that counts as unscattered where so many moments of the rest are followed: the next one, and nothing where
/// more light is turned back than goes on.
pub fn share(phase: &PhaseFunction, moments: usize) -> f64 {
    if phase.mean_cosine() > 0.0 { phase.legendre_moment(moments).max(0.0) } else { 0.0 }
}

/// Moments of what is scattered besides.
pub fn moments_of_rest<const MOMENTS: usize>(phase: &PhaseFunction) -> [f64; MOMENTS] {
    let f = share(phase, MOMENTS);
    std::array::from_fn(|degree| (phase.legendre_moment(degree) - f) / (1.0 - f))
}

/// A phase function between two angles that lie close together.
struct Ring {
    cosine: f64,
    solid_angle_sr: f64,
    per_sr: f64,
}

/// All directions, in rings that crowd where phase functions peak.
fn rings(phase: &PhaseFunction) -> Vec<Ring> {
    let angle = |i: usize| PI * (i as f64 / ANGLES as f64).powi(3);
    let ring = |i: usize| {
        let (near, far) = (angle(i), angle(i + 1));
        let cosine = (0.5 * (near + far)).cos();
        // cos a - cos b without cancellation.
        let solid_angle_sr = 4.0 * PI * (0.5 * (near + far)).sin() * (0.5 * (far - near)).sin();
        Ring { cosine, solid_angle_sr, per_sr: phase.value(cosine) }
    };
    (0..ANGLES).map(ring).collect()
}

/// The ceiling below which a phase function holds so much of the light, 1/sr.
fn ceiling_per_sr(rings: &[Ring], below: f64) -> f64 {
    let (mut low, mut high) = (0.0, rings.iter().fold(0.0, |most, ring| ring.per_sr.max(most)));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let held: f64 = rings.iter().map(|ring| ring.per_sr.min(middle) * ring.solid_angle_sr).sum();
        *(if held < below { &mut low } else { &mut high }) = middle;
    }
    high
}

impl ForwardPeak {
    /// Of a phase function, of whose rest so many moments are followed; one that turns back more light than goes on has none.
    pub fn new(phase: &PhaseFunction, moments: usize) -> Self {
        let f = share(phase, moments);
        if f <= 0.0 {
            return Self { ceiling_per_sr: f64::INFINITY, moments: vec![0.0; DEGREES] };
        }
        let rings = rings(phase);
        let ceiling_per_sr = ceiling_per_sr(&rings, 1.0 - f);
        let mut moments: Vec<f64> = (0..DEGREES).map(|l| phase.legendre_moment(l)).collect();
        // What is below the ceiling is smooth: its moments are sums that the peak's would not be.
        for ring in &rings {
            let below = ring.per_sr.min(ceiling_per_sr) * ring.solid_angle_sr;
            moments.iter_mut().zip(legendre(DEGREES, ring.cosine)).for_each(|(moment, p)| *moment -= below * p);
        }
        Self { ceiling_per_sr, moments }
    }

    /// C, 1/sr; infinite where there is no peak.
    pub fn ceiling_per_sr(&self) -> f64 {
        self.ceiling_per_sr
    }

    /// p_l, for l below 192.
    pub fn moment(&self, degree: usize) -> f64 {
        self.moments[degree]
    }

    /// K of many directions, 1/sr, in matter of an albedo at an optical depth along the beam.
    pub fn scattered_again_per_sr(&self, albedo: f64, depth: f64, cosines: &[f64]) -> Vec<f64> {
        let weights: Vec<f64> = (self.moments.iter().enumerate())
            .map(|(l, &p)| {
                // The last degrees fade out, so that the series does not ring where it ends.
                let fade = (-4.0 * (l as f64 / DEGREES as f64).powi(4)).exp();
                (2 * l + 1) as f64 / (4.0 * PI) * p * (-depth).exp() * (albedo * p * depth).exp_m1() * fade
            })
            .collect();
        let at =
            |&cosine: &f64| weights.iter().zip(legendre(DEGREES, cosine)).map(|(w, p)| w * p).sum::<f64>().max(0.0);
        cosines.iter().map(at).collect()
    }
}
