//! The reference's answer for a few pixels of a case.

use std::f64::consts::FRAC_PI_2;

use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::probe::probe_world;
use welkin::reference::{Effort, World};
use welkin::scene::{Light, Scene};
use welkin_lut::mapping::SkyViewMapping;

use super::{Bound, Case};

/// Where pixels are compared, in shares of the picture's width and height.
const PLACES: [[f64; 2]; 6] = [[0.1, 0.15], [0.5, 0.05], [0.9, 0.35], [0.2, 0.6], [0.4, 0.95], [0.85, 0.8]];
/// Pixels that the horizon or a disc comes closer to than this are mixed of two things, pixels.
const CLEAR_PIXELS: f64 = 1.5;
const SEED: u64 = 11;

/// What the reference says of some pixels.
pub struct Truth {
    /// Columns and rows.
    pub pixels: Vec<[u32; 2]>,
    /// Its answers.
    pub answers: Vec<RayRadiance>,
}

/// The pixels of a scene that can be compared.
pub fn pixels(scene: &Scene) -> Vec<[u32; 2]> {
    let camera = &scene.camera;
    let place = |[x, y]: [f64; 2]| [(x * f64::from(camera.width)) as u32, (y * f64::from(camera.height)) as u32];
    let mut pixels: Vec<_> = PLACES.into_iter().map(place).filter(|&pixel| is_clear(scene, pixel)).collect();
    pixels.dedup();
    pixels
}

/// Whether a pixel shows neither the horizon nor a disc.
fn is_clear(scene: &Scene, [x, y]: [u32; 2]) -> bool {
    let camera = &scene.camera;
    let view = camera.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let clear_rad = CLEAR_PIXELS * camera.vertical_field_of_view_rad / f64::from(camera.height);
    let horizon_rad = SkyViewMapping::new(&scene.planet, camera.altitude_m.max(0.0), 2).horizon_rad;
    let is_off_discs = scene.lights.iter().all(|light| match light {
        Light::Directional(light) if light.angular_radius_rad > 0.0 => {
            view.angle_between(light.direction.to_vector()) > light.angular_radius_rad + clear_rad
        }
        _ => true,
    });
    is_off_discs && (view.z.clamp(-1.0, 1.0).acos() - horizon_rad).abs() > clear_rad
}

/// The rays of those pixels, ending at a distance.
pub fn rays(scene: &Scene, pixels: &[[u32; 2]], distance_m: f64) -> Vec<Ray> {
    let first = scene.lights.iter().find_map(|light| match light {
        Light::Directional(light) => Some(light.direction),
        _ => None,
    });
    let (sun_zenith_rad, sun_azimuth_rad) = first.map_or((0.0, 0.0), |d| (FRAC_PI_2 - d.elevation_rad, d.azimuth_rad));
    let ray = |&[x, y]: &[u32; 2]| {
        let view = scene.camera.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5);
        Ray {
            altitude_m: scene.camera.altitude_m,
            view_zenith_rad: view.truncate().length().atan2(view.z),
            view_azimuth_rad: view.x.atan2(view.y),
            sun_zenith_rad,
            sun_azimuth_rad,
            distance_m,
        }
    };
    pixels.iter().map(ray).collect()
}

/// What the reference says of a case, where it is held to that.
pub fn of(case: &Case, walks: u64) -> Option<Truth> {
    (!matches!(case.bound, Bound::LawsOnly(_))).then(|| trace(&case.scene(), walks))
}

/// Traces those pixels.
pub fn trace(scene: &Scene, walks: u64) -> Truth {
    let pixels = pixels(scene);
    let rays = rays(scene, &pixels, f64::INFINITY);
    let answers = probe_world(&World::from_scene(scene), &rays, Orders::All, Effort::Walks(walks), SEED);
    Truth { pixels, answers }
}
