//! The observer and the lights as the shaders read them.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::vec3;
use crate::plan::Facts;
use crate::scene::DirectionalLight;

/// WGSL `DirectionalLight`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct DirectionalLightBlock {
    pub(super) direction: [f32; 3],
    pub(super) azimuth_rad: f32,
    pub(super) irradiance: [f32; 3],
    pub(super) angular_radius_rad: f32,
    pub(super) limb_exponent: [f32; 3],
    pub(super) averaged_radius_rad: f32,
}

/// WGSL `SkyViewRange`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct SkyViewRangeBlock {
    pub(super) horizon_rad: f32,
    pub(super) sky_end_rad: f32,
    pub(super) natural_y: f32,
    pub(super) snapped_y: f32,
}

/// WGSL `Observer` up to its array of lights.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct ObserverHeader {
    pub(super) altitude_m: f32,
    pub(super) padding: [f32; 3],
    pub(super) view: SkyViewRangeBlock,
}

impl DirectionalLightBlock {
    fn new(facts: &Facts, light: &DirectionalLight) -> Self {
        let averaged_radius_rad = if facts.is_wide(light) { light.angular_radius_rad as f32 } else { 0.0 };
        Self {
            direction: light.direction.to_vector().as_vec3().to_array(),
            azimuth_rad: wrapped_azimuth_rad(light.direction.to_vector()) as f32,
            irradiance: vec3(light.irradiance),
            angular_radius_rad: light.angular_radius_rad as f32,
            limb_exponent: vec3(light.limb_exponent()),
            averaged_radius_rad,
        }
    }
}

/// Azimuth as the shaders' atan2 gives it, in [-π, π].
fn wrapped_azimuth_rad(direction: DVec3) -> f64 {
    direction.x.atan2(direction.y)
}

/// WGSL `Observer`, with one light that does not shine when there is none.
pub fn observer_block(facts: &Facts) -> Vec<u8> {
    let mapping = facts.sky_view_mapping();
    let header = ObserverHeader {
        altitude_m: facts.observer_altitude_m() as f32,
        padding: [0.0; 3],
        view: SkyViewRangeBlock {
            horizon_rad: mapping.horizon_rad as f32,
            sky_end_rad: mapping.sky_end_rad as f32,
            natural_y: mapping.horizontal_y[0] as f32,
            snapped_y: mapping.horizontal_y[1] as f32,
        },
    };
    let mut lights: Vec<_> = facts.lights.iter().map(|light| DirectionalLightBlock::new(facts, light)).collect();
    lights.resize(
        facts.light_slots() as usize,
        DirectionalLightBlock { direction: [0.0, 0.0, 1.0], ..Zeroable::zeroed() },
    );
    [bytemuck::bytes_of(&header), bytemuck::cast_slice(&lights)].concat()
}
