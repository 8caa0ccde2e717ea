//! The camera as the shaders read it.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::scene::Camera;

/// WGSL `Camera`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CameraBlock {
    forward: [f32; 3],
    half_width: f32,
    right: [f32; 3],
    half_height: f32,
    up: [f32; 3],
    padding: f32,
    size: [f32; 2],
    padding_end: [f32; 2],
}

impl CameraBlock {
    /// Narrows a camera, which keeps the horizon level.
    pub fn new(camera: &Camera) -> Self {
        let forward = camera.direction.to_vector();
        // Right is horizontal and taken from the azimuth alone, so that it also exists looking straight up.
        let (sin_azimuth, cos_azimuth) = camera.direction.azimuth_rad.sin_cos();
        let right = DVec3::new(cos_azimuth, -sin_azimuth, 0.0);
        let up = right.cross(forward);
        let half_height = (0.5 * camera.vertical_field_of_view_rad).tan();
        let half_width = half_height * f64::from(camera.width) / f64::from(camera.height);
        Self {
            forward: forward.as_vec3().to_array(),
            half_width: half_width as f32,
            right: right.as_vec3().to_array(),
            half_height: half_height as f32,
            up: up.as_vec3().to_array(),
            padding: 0.0,
            size: [camera.width as f32, camera.height as f32],
            padding_end: [0.0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Direction;

    fn looking(elevation_rad: f64, azimuth_rad: f64) -> CameraBlock {
        CameraBlock::new(&Camera {
            altitude_m: 2.0,
            direction: Direction { elevation_rad, azimuth_rad },
            vertical_field_of_view_rad: 1.0,
            width: 200,
            height: 100,
        })
    }

    #[test]
    fn looking_north_east_is_to_the_right_and_up_is_up() {
        let block = looking(0.0, 0.0);
        assert_eq!((block.forward, block.right, block.up), ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    }

    #[test]
    fn looking_straight_up_has_a_frame() {
        let block = looking(std::f64::consts::FRAC_PI_2, 0.3);
        assert!(block.right.iter().chain(&block.up).all(|x| x.is_finite()));
        assert!(block.up[2].abs() < 1e-6);
    }
}
