//! Which local volumes may lie in the picture: of the others no light is kept.
//!
//! They still weaken the light of what is seen. The camera's direction is rounded, and the cone of its picture widened by as
//! much, so that a camera that turns changes what is kept at few places.

use std::f64::consts::PI;

use glam::DVec3;
use welkin_lut::volume::Volume;

use crate::scene::{Camera, Direction};

/// To what the camera's direction is rounded, rad.
const TURN_RAD: f64 = PI / 9.0;

/// Numbers of the volumes whose bounding spheres come into the picture of a camera in the air at an altitude, m. All of them where
/// `share` is infinite; below 1 it narrows the picture, which is wrong.
pub fn seen_volumes(camera: &Camera, altitude_m: f64, volumes: &[&Volume], share: f64) -> Vec<usize> {
    let rounded = |angle_rad: f64| (angle_rad / TURN_RAD).round() * TURN_RAD;
    let Direction { elevation_rad, azimuth_rad } = camera.direction;
    let axis = Direction { elevation_rad: rounded(elevation_rad), azimuth_rad: rounded(azimuth_rad) }.to_vector();
    let [_, _, forward] = camera.basis();
    // Both angles are off by half of the step at most.
    let widest_rad = share * (forward.angle_between(camera.direction_through(0.0, 0.0)) + 0.75 * TURN_RAD);
    let eye = DVec3::new(0.0, 0.0, altitude_m);
    let is_seen = |volume: &Volume| {
        let Some((centre_m, radius_m)) = volume.bounding_sphere() else { return false };
        let offset = DVec3::from_array(centre_m) - eye;
        let distance_m = offset.length();
        distance_m <= radius_m || axis.angle_between(offset) <= widest_rad + (radius_m / distance_m).asin()
    };
    (0..volumes.len()).filter(|&index| is_seen(volumes[index])).collect()
}

#[cfg(test)]
mod tests {
    use welkin_lut::PhaseFunction;
    use welkin_lut::volume::VolumeForm;

    use super::*;

    fn ball(centre_m: [f64; 3]) -> Volume {
        Volume {
            name: "ball".to_owned(),
            form: VolumeForm::Ellipsoid { centre_m, size_m: [2.0; 3], turn_rad: 0.0 },
            scattering_per_m: [0.1; 3],
            absorption_per_m: [0.0; 3],
            emission_per_m: [0.0; 3],
            phase: PhaseFunction::Isotropic,
            edge: 0.0,
            noise: None,
            grid: None,
        }
    }

    #[test]
    fn what_a_pixel_meets_is_seen_wherever_the_camera_turns_and_what_is_behind_it_is_not() {
        for step in 0..200 {
            let azimuth_rad = 0.1 * f64::from(step);
            let direction = Direction { elevation_rad: 0.3 * azimuth_rad.sin(), azimuth_rad };
            let camera = Camera { altitude_m: 5.0, direction, vertical_field_of_view_rad: 0.8, width: 160, height: 90 };
            let eye = DVec3::new(0.0, 0.0, 5.0);
            let corner = ball((eye + 100.0 * camera.direction_through(160.0, 0.0)).to_array());
            let behind = ball((eye - 100.0 * direction.to_vector()).to_array());
            assert_eq!(seen_volumes(&camera, 5.0, &[&behind, &corner], 1.0), [1], "{azimuth_rad}");
            assert_eq!(seen_volumes(&camera, 5.0, &[&behind, &corner], f64::INFINITY), [0, 1]);
        }
    }
}
