//! Energy is neither made nor lost: light from all directions at once.
//!
//! Where nothing absorbs, neither air nor ground, a uniform sky of radiance 1 is seen everywhere unchanged: what is
//! missing of it behind the air is what the air and the ground scatter into the ray. A uniform sky is parallel light
//! from every direction, so that per unit irradiance ∫ L dω over all directions to the light is 1 - T, T that of a ray
//! which ends in space, and 1 for a ray which ends on the ground.

use std::f64::consts::{FRAC_PI_2, PI};

use welkin::plan::Settings;
use welkin::probe::{Orders, Ray};
use welkin::renderer::Renderer;
use welkin::scene::Scene;
use welkin_lut::quadrature::gauss_legendre;

/// Between these elevations of the light, degrees, what it lights changes smoothly; lower than the first it lights
/// nothing of an Earth.
const EDGES_DEG: [f64; 5] = [-20.0, -5.0, 0.0, 8.0, 90.0];
/// Gauss nodes in each part.
const NODES: usize = 4;
/// Midpoints in its azimuth, all around.
const AZIMUTHS: usize = 8;

/// Views: up, up at a slant, and down at the ground, as zenith angle and azimuth.
pub const VIEWS_RAD: [[f64; 2]; 3] = [[0.0, 0.0], [1.2, 0.5], [2.2, 1.0]];

/// What is seen along a view under uniform light, over what must be seen, in each band.
pub fn energy(renderer: &mut Renderer, scene: &Scene, settings: Settings, view: [f64; 2]) -> [f64; 3] {
    let (rays, weights) = lights(scene.camera.altitude_m, view);
    let answers = renderer.probe(scene, settings, &rays, Orders::All).unwrap_or_else(|error| panic!("{error}"));
    let meets_ground = view[0] > FRAC_PI_2 + 0.1;
    std::array::from_fn(|band| {
        let seen: f64 = answers.iter().zip(&weights).map(|(answer, weight)| weight * answer.radiance[band]).sum();
        let missing = if meets_ground { 1.0 } else { 1.0 - answers[0].transmittance[band] };
        seen / missing
    })
}

/// Rays along one view under lights from all directions, and the solid angle of each light.
fn lights(altitude_m: f64, [view_zenith_rad, view_azimuth_rad]: [f64; 2]) -> (Vec<Ray>, Vec<f64>) {
    let (mut rays, mut weights) = (Vec::new(), Vec::new());
    for part in EDGES_DEG.windows(2) {
        let (low, high) = (part[0].to_radians(), part[1].to_radians());
        for node in gauss_legendre(NODES) {
            let elevation_rad = low + (high - low) * node.abscissa;
            for k in 0..AZIMUTHS {
                rays.push(Ray {
                    altitude_m,
                    view_zenith_rad,
                    view_azimuth_rad,
                    sun_zenith_rad: FRAC_PI_2 - elevation_rad,
                    sun_azimuth_rad: 2.0 * PI * (k as f64 + 0.5) / AZIMUTHS as f64,
                    distance_m: f64::INFINITY,
                });
                weights.push((high - low) * node.weight * elevation_rad.cos() * 2.0 * PI / AZIMUTHS as f64);
            }
        }
    }
    (rays, weights)
}
