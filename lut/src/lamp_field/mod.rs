//! Light of a point light that even matter around it has scattered, in a ball with nothing outside.
//!
//! At a distance of r from the light, τ optical depths away, matter scatters once I P(ν) e^(-τ) / r² of its intensity I per
//! unit of b. What it scatters of light that was scattered before is I K(τ, ν) / r², ν the cosine between the direction in
//! which the light leaves and that away from the lamp. K is what this module finds.
//!
//! # Method
//! The scattered field, times r², in Legendre moments f_l(τ) = r² ∫ L P_l dω, obeys the spherical harmonics' equations in
//! spherical coordinates (Davison 1957, Neutron Transport Theory, chapter 12),
//!
//! (l+1)/(2l+1) \[f'_{l+1} + l f_{l+1}/τ\] + l/(2l+1) \[f'_{l-1} - (l+1) f_{l-1}/τ\] + (1 - W χ_l) f_l = W χ_l e^(-τ),
//!
//! W the albedo and χ_l the moments of the phase function. Near the light f_l = W A_l τ with
//! A_l = 2π ∫ P(Θ) ∫₀^Θ P_l(cos θ) dθ dΘ: light scattered once, by equiangular coordinates. A series that is cut at some l
//! fails there, as A_l falls no faster than 1/l. Here the moments above the last that is solved for are those of light that keeps
//! close to its line, f_l = e^(-τ) (e^(W A_l τ) - 1): exact for light scattered once, and what scattering again and again by small angles
//! makes of it. They enter the system as a source, and the field as what they are.

mod banded;
mod first_scattering;
mod spherical;

use std::f64::consts::PI;

use crate::PhaseFunction;
use crate::legendre::legendre;

/// Moments that are solved for.
const SOLVED: usize = 8;
/// Moments of which K is made.
const DEGREES: usize = 192;

/// Light around a point light in an even ball of matter: see the [module](self).
#[derive(Debug, Clone)]
pub struct LampField {
    albedo: f64,
    /// χ_l.
    phase: Vec<f64>,
    /// A_l.
    first: Vec<f64>,
    /// Where f_l are known, in optical depths from the light.
    depths: Vec<f64>,
    solved: Vec<[f64; SOLVED]>,
}

/// Flux and mean of the scattered field, of which irradiances are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScatteredFlux {
    /// r² times the net flux away from the light, over its intensity.
    pub outward: f64,
    /// r² times the integral of radiance over all directions, over its intensity.
    pub scalar: f64,
}

impl LampField {
    /// In matter of this phase function and single-scattering albedo in [0, 1], a ball of `radius` optical depths around the light.
    pub fn new(phase: &PhaseFunction, albedo: f64, radius: f64) -> Self {
        let first = first_scattering::moments(phase, DEGREES);
        let phase: Vec<f64> = (0..DEGREES).map(|l| phase.legendre_moment(l)).collect();
        let problem = spherical::Problem { albedo, phase: &phase, first: &first, radius: radius.clamp(0.01, 100.0) };
        let (depths, solved) = problem.solve();
        Self { albedo, phase, first, depths, solved }
    }

    /// f_l at an optical depth from the light.
    fn moment(&self, degree: usize, depth: f64) -> f64 {
        if degree >= SOLVED {
            return spherical::nearly_straight(self.albedo, self.first[degree], depth);
        }
        let last = self.depths.len() - 1;
        let place = self.depths.partition_point(|&d| d <= depth);
        match place {
            0 => self.solved[0][degree] * depth / self.depths[0],
            place if place > last => self.solved[last][degree],
            place => {
                let [low, high] = [place - 1, place].map(|i| self.depths[i].ln());
                let share = (depth.ln() - low) / (high - low);
                self.solved[place - 1][degree] * (1.0 - share) + self.solved[place][degree] * share
            }
        }
    }

    /// K of many directions, 1/sr, at an optical depth from the light.
    pub fn scattered_per_sr(&self, depth: f64, cosines: &[f64]) -> Vec<f64> {
        // The last degrees fade out, so that the series does not ring where it ends.
        let weight = |l: usize| {
            let fade = (-4.0 * (l as f64 / DEGREES as f64).powi(4)).exp();
            (2 * l + 1) as f64 / (4.0 * PI) * self.phase[l] * self.moment(l, depth) * fade
        };
        let weights: Vec<f64> = (0..DEGREES).map(weight).collect();
        let at =
            |&cosine: &f64| weights.iter().zip(legendre(DEGREES, cosine)).map(|(w, p)| w * p).sum::<f64>().max(0.0);
        cosines.iter().map(at).collect()
    }

    /// ∫ K P_l dω: what is scattered more than once, as moments.
    pub fn scattered_moment(&self, degree: usize, depth: f64) -> f64 {
        self.phase[degree] * self.moment(degree, depth)
    }

    /// The field's own flux and mean.
    pub fn flux(&self, depth: f64) -> ScatteredFlux {
        ScatteredFlux { outward: self.moment(1, depth), scalar: self.moment(0, depth) }
    }
}
