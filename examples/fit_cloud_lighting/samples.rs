//! The points along the rays of a view at which all methods are evaluated.

use glam::DVec3;
use rayon::prelude::*;
use welkin::reference::{DensityField, GridField};

use super::fields::extent_m;
use super::views::{PIXELS, View, suns};

/// Rays across and down each pixel.
const RAYS: usize = 2;
/// Longest step along a view ray and along a ray to a sun, m; steps are shorter where it is dense.
const STEP_M: f64 = 20.0;
const STEP_DEPTH: f64 = 0.3;

/// A point.
pub struct Sample {
    pub pixel: usize,
    pub place_m: DVec3,
    /// Optical depth of the step, and of the ray before it.
    pub step_depth: f64,
    pub view_depth: f64,
    /// Towards each sun, and away from it.
    pub sun_depth: [f64; 3],
    pub through_depth: [f64; 3],
}

/// All points of a view.
pub struct Samples {
    pub view: View,
    pub points: Vec<Sample>,
    /// 1 - transmittance of each pixel.
    pub opacity: Vec<f64>,
}

fn inside(p: DVec3) -> bool {
    p.cmpge(DVec3::ZERO).all() && p.cmple(extent_m()).all()
}

/// Optical depth from a point until the ray leaves the box.
fn depth(cloud: &GridField, from: DVec3, d: DVec3) -> f64 {
    let (mut t, mut sum) = (0.5 * STEP_M, 0.0);
    while inside(from + t * d) && sum < 300.0 {
        sum += STEP_M * cloud.density(from + t * d);
        t += STEP_M;
    }
    sum
}

fn ray(cloud: &GridField, view: View, pixel: usize, start: DVec3, points: &mut Vec<Sample>) -> f64 {
    let d = view.direction();
    let (mut t, mut view_depth) = (0.0, 0.0);
    while t < 9000.0 && view_depth < 30.0 {
        let here = start + t * d;
        let density = if inside(here + 0.5 * STEP_M * d) { cloud.density(here + 0.5 * STEP_M * d) } else { 0.0 };
        let step_m = if density * STEP_M > STEP_DEPTH { STEP_DEPTH / density } else { STEP_M };
        let place_m = here + 0.5 * step_m * d;
        let step_depth = if inside(place_m) { step_m * cloud.density(place_m) } else { 0.0 };
        if step_depth > 0.0 {
            let towards = |sign: f64| suns().map(|sun| depth(cloud, place_m, sign * sun));
            let (sun_depth, through_depth) = (towards(1.0), towards(-1.0));
            points.push(Sample { pixel, place_m, step_depth, view_depth, sun_depth, through_depth });
        }
        view_depth += step_depth;
        t += step_m;
    }
    -f64::exp_m1(-view_depth)
}

impl Samples {
    pub fn gather(cloud: &GridField, view: View) -> Self {
        let count = PIXELS[0] * PIXELS[1];
        let pixels: Vec<(Vec<Sample>, f64)> = (0..count)
            .into_par_iter()
            .map(|pixel| {
                let (mut points, mut opacity) = (Vec::new(), 0.0);
                for i in 0..RAYS * RAYS {
                    let offset = |n: usize| (n as f64 + 0.5) / RAYS as f64;
                    let across = ((pixel % PIXELS[0]) as f64 + offset(i % RAYS)) / PIXELS[0] as f64;
                    let down = ((pixel / PIXELS[0]) as f64 + offset(i / RAYS)) / PIXELS[1] as f64;
                    opacity += ray(cloud, view, pixel, view.start(across, down), &mut points);
                }
                (points, opacity / (RAYS * RAYS) as f64)
            })
            .collect();
        let opacity = pixels.iter().map(|pixel| pixel.1).collect();
        Self { view, points: pixels.into_iter().flat_map(|pixel| pixel.0).collect(), opacity }
    }

    /// A picture: ∫ e^(-share view depth) source d(depth), by exact integration over each step.
    pub fn picture(&self, share: f64, source: impl Fn(&Sample) -> f64) -> Vec<f64> {
        let mut picture = vec![0.0; self.opacity.len()];
        for point in &self.points {
            let seen = (-share * point.view_depth).exp() * -f64::exp_m1(-share * point.step_depth) / share;
            picture[point.pixel] += seen * source(point) / (RAYS * RAYS) as f64;
        }
        picture
    }
}
