//! Radiance along single rays, read from the tables that pictures are made of. Not part of a frame.

use std::f64::consts::{PI, TAU};

use bytemuck::{Pod, Zeroable};
use welkin_lut::mapping::{SkyHalf, SkyViewMapping};

use super::{Recording, RenderError, Resources};
use crate::gpu::Work;
use crate::probe::{Ray, RayRadiance};

/// Beyond every ray's end, and finite in f32, m.
const FARTHEST_M: f64 = 1e30;

/// WGSL `ProbeRay`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ProbeRayBlock {
    zenith_rad: f32,
    azimuth_rad: f32,
    below_horizon: u32,
    distance_m: f32,
}

/// WGSL `ProbeAnswer`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ProbeAnswerBlock {
    radiance: [f32; 3],
    padding: f32,
    transmittance: [f32; 3],
    padding_end: f32,
}

impl ProbeRayBlock {
    /// `sun_azimuth_rad` is that of the scene's light, which the ray is turned with.
    fn new(ray: &Ray, sun_azimuth_rad: f64, mapping: &SkyViewMapping) -> Self {
        let azimuth_rad = ray.view_azimuth_rad - ray.sun_azimuth_rad + sun_azimuth_rad;
        Self {
            zenith_rad: ray.view_zenith_rad as f32,
            azimuth_rad: (PI - (PI - azimuth_rad).rem_euclid(TAU)) as f32,
            // Decided in f64: at the horizon f32 would take some rays for the other half.
            below_horizon: u32::from(mapping.half(ray.view_zenith_rad) == SkyHalf::Ground),
            distance_m: ray.distance_m.min(FARTHEST_M) as f32,
        }
    }
}

/// Uploads rays that are all seen from the scene's camera altitude under the scene's lights, whose first directional one
/// stands where the first ray has it. Where there is no other, rays may have it at other azimuths.
pub fn upload(resources: &mut Resources, rays: &[Ray], mapping: &SkyViewMapping) -> Result<(), RenderError> {
    let sun_azimuth_rad = rays.first().map_or(0.0, |ray| ray.sun_azimuth_rad);
    let blocks: Vec<_> = rays.iter().map(|ray| ProbeRayBlock::new(ray, sun_azimuth_rad, mapping)).collect();
    resources.fill_buffer("rays", &blocks)?;
    resources.fill_buffer("answers", &vec![ProbeAnswerBlock::zeroed(); rays.len()])?;
    Ok(())
}

/// Records the dispatch; the tables must have been made.
pub fn record(recording: &mut Recording, rays: usize) -> Result<(), RenderError> {
    recording.dispatch("probe", &[], &[], Work::Invocations([rays as u32, 1, 1]))
}

/// Reads the answers back, one for each uploaded ray.
pub fn download(resources: &Resources) -> Result<Vec<RayRadiance>, RenderError> {
    let Some(buffer) = resources.existing_buffer("answers") else { return Ok(Vec::new()) };
    let answers: Vec<ProbeAnswerBlock> = resources.gpu.read_buffer(buffer)?;
    Ok(answers
        .iter()
        .map(|answer| RayRadiance {
            radiance: answer.radiance.map(f64::from),
            transmittance: answer.transmittance.map(f64::from),
            standard_error: [0.0; 3],
        })
        .collect())
}
