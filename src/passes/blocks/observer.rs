//! The observer and the lights as the shaders read them.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::vec3;
use crate::plan::Facts;
use crate::scene::{DirectionalLight, LitSphere};

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
    pub(super) sky_end_y: f32,
    pub(super) last_y: f32,
}

/// WGSL `Observer` up to its array of lights.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct ObserverHeader {
    pub(super) altitude_m: f32,
    pub(super) padding: [f32; 3],
    pub(super) view: SkyViewRangeBlock,
}

/// What `DirectionalLight` holds besides, with definition SPHERE.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct LitSphereBlock {
    pub(super) toward_source: [f32; 3],
    pub(super) sphere_scale: f32,
    pub(super) even_share: [f32; 3],
    pub(super) padding: f32,
}

impl LitSphereBlock {
    /// That of a light without a sphere is all zeros.
    fn new(light: &DirectionalLight) -> Self {
        let Some(sphere) = light.sphere else { return Self::zeroed() };
        let integral = LitSphere::disc_integral(sphere.phase_rad(light.direction.to_vector()));
        Self {
            toward_source: sphere.toward_source.as_vec3().to_array(),
            sphere_scale: (1.0 / integral) as f32,
            even_share: vec3(sphere.even_share),
            padding: 0.0,
        }
    }
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
            sky_end_y: mapping.sky_end_y as f32,
            last_y: mapping.last_y as f32,
        },
    };
    let dark = DirectionalLightBlock { direction: [0.0, 0.0, 1.0], ..Zeroable::zeroed() };
    let mut lit: Vec<_> = facts.lights.iter().copied().map(Some).collect();
    lit.resize(facts.light_slots() as usize, None);
    let mut bytes = bytemuck::bytes_of(&header).to_vec();
    for light in lit.into_iter().chain(facts.faint_discs.iter().copied().map(Some)) {
        bytes.extend(bytemuck::bytes_of(&light.map_or(dark, |light| DirectionalLightBlock::new(facts, light))));
        if facts.has_sphere() {
            bytes.extend(bytemuck::bytes_of(&light.map_or(Zeroable::zeroed(), LitSphereBlock::new)));
        }
    }
    bytes
}
