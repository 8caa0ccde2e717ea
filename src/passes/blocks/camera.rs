//! The camera as the shaders read it.

use bytemuck::{Pod, Zeroable};

use crate::scene::Camera;

/// WGSL `Camera`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CameraBlock {
    pub(super) forward: [f32; 3],
    pub(super) half_width: f32,
    pub(super) right: [f32; 3],
    pub(super) half_height: f32,
    pub(super) up: [f32; 3],
    pub(super) pre_exposure: f32,
    pub(super) size: [f32; 2],
    pub(super) padding_end: [f32; 2],
}

impl CameraBlock {
    /// Narrows a camera, and what its pixels are multiplied with in half floats.
    pub fn new(camera: &Camera, pre_exposure: f64) -> Self {
        let [right, up, forward] = camera.basis();
        let half_height = (0.5 * camera.vertical_field_of_view_rad).tan();
        let half_width = half_height * f64::from(camera.width) / f64::from(camera.height);
        Self {
            forward: forward.as_vec3().to_array(),
            half_width: half_width as f32,
            right: right.as_vec3().to_array(),
            half_height: half_height as f32,
            up: up.as_vec3().to_array(),
            pre_exposure: pre_exposure as f32,
            size: [camera.width as f32, camera.height as f32],
            padding_end: [0.0; 2],
        }
    }
}
