//! The pictures that each approximation makes of a view: radiance per unit irradiance of the sun, 1/sr.

use std::f64::consts::PI;

use welkin::passes::ordinates::coefficients::{BAND_ASYMMETRY, forward_share, reduced_cosine};
use welkin_lut::PhaseFunction;

use super::field::LightField;
use super::phase::scaled;
use super::samples::Samples;
use super::views::suns;

/// What a cloud's sides let out of the slab's field; measured on voxel clouds.
const SLAB_LEAK: f64 = 0.5;

/// Cosine of the angle between the view and a sun.
pub fn nu(samples: &Samples, sun: usize) -> f64 {
    samples.view.direction().dot(suns()[sun])
}

/// Sunlight that shares of the optical depths to the sun and along the view dim.
pub fn dimmed(samples: &Samples, sun: usize, [sun_share, view_share]: [f64; 2]) -> Vec<f64> {
    samples.picture(view_share, |point| (-sun_share * point.sun_depth[sun]).exp())
}

/// Octaves: [strength, share of the depth, asymmetry] to the power of the octave's number.
pub fn octaves(
    samples: &Samples,
    sun: usize,
    phase: &PhaseFunction,
    count: i32,
    [a, b, c]: [f64; 3],
    view: bool,
) -> Vec<f64> {
    let mut sum = vec![0.0; samples.opacity.len()];
    for i in 0..count {
        let share = b.powi(i);
        let light = dimmed(samples, sun, [share, if view { share } else { 1.0 }]);
        add(&mut sum, &light, a.powi(i) * scaled(phase, c.powi(i), nu(samples, sun)));
    }
    sum
}

/// The two bands' factors: P[g] - P[0.6 g] and P[0.6 g].
pub fn band_phases(phase: &PhaseFunction, nu: f64) -> [f64; 2] {
    let wide = scaled(phase, BAND_ASYMMETRY, nu);
    [scaled(phase, 1.0, nu) - wide, wide]
}

/// Bands of near-forward light.
pub fn bands(samples: &Samples, sun: usize, phase: &PhaseFunction, attenuations: [f64; 2]) -> Vec<f64> {
    let mut sum = vec![0.0; samples.opacity.len()];
    for (share, factor) in attenuations.into_iter().zip(band_phases(phase, nu(samples, sun))) {
        add(&mut sum, &dimmed(samples, sun, [share; 2]), factor);
    }
    sum
}

/// What the solved field adds, along a view ray through the similar medium.
pub fn field(samples: &Samples, sun: usize, field: &LightField) -> Vec<f64> {
    let (d, q) = (samples.view.direction(), 1.0 - field.forward_share);
    samples.picture(q, |point| q * field.scattered(point.place_m, d, (-q * point.sun_depth[sun]).exp())[0])
}

/// The field of a slab in closed form (delta-Eddington), from the optical depths to both sides along the sun's line.
pub fn slab(samples: &Samples, sun: usize, phase: &PhaseFunction) -> Vec<f64> {
    let (q, reduced, nu) = (1.0 - forward_share(phase), reduced_cosine(phase), nu(samples, sun));
    samples.picture(q, |point| {
        let (depth, whole) = (q * point.sun_depth[sun], q * (point.sun_depth[sun] + point.through_depth[sun]));
        let k = 3.0 / (4.0 * PI);
        let a = k * (5.0 / 3.0 - (-whole).exp() / 3.0) / (4.0 / 3.0 + (1.0 - reduced) * whole);
        let b = k + 2.0 / 3.0 * (k - a);
        let (mean, flux) = (b - (1.0 - reduced) * a * depth - k * (-depth).exp(), a - k * (-depth).exp());
        q * SLAB_LEAK * (mean + reduced * nu * flux).max(0.0)
    })
}

/// Adds a picture times a factor.
pub fn add(sum: &mut [f64], picture: &[f64], factor: f64) {
    for (s, p) in sum.iter_mut().zip(picture) {
        *s += factor * p;
    }
}

/// Two pictures together.
pub fn sum(mut a: Vec<f64>, b: &[f64]) -> Vec<f64> {
    add(&mut a, b, 1.0);
    a
}
