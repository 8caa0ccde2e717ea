//! Which pixels of the clouds a frame marches, and how the frame before saw them, as the shaders read it.

use bytemuck::{Pod, Zeroable};

use super::CameraBlock;
use crate::plan::{Facts, Moment, pixel_of_block};

/// The golden ratio: its multiples divide the unit interval evenly, however many there are.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;

/// WGSL `CloudFrame` up to its array of drifts.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CloudFrameHeader {
    pub(super) first_pixel: [u32; 2],
    pub(super) jitter: f32,
    pub(super) still: f32,
    pub(super) forward: [f32; 3],
    pub(super) half_width: f32,
    pub(super) right: [f32; 3],
    pub(super) half_height: f32,
    pub(super) up: [f32; 3],
    pub(super) altitude_m: f32,
}

/// WGSL `CloudFrame`.
pub fn cloud_frame_block(facts: &Facts) -> Vec<u8> {
    let block = facts.cloud_block();
    let index = facts.sequence.filter(|_| block > 1).map_or(0, |sequence| sequence.index);
    let now = Moment { camera: facts.scene.camera, time_s: facts.scene.time_s };
    let before = facts.sequence.and_then(|sequence| sequence.before).unwrap_or(now);
    let camera = CameraBlock::new(&before.camera, 1.0);
    let header = CloudFrameHeader {
        first_pixel: pixel_of_block(block, index % (block * block)),
        jitter: (f64::from(index / (block * block)) * GOLDEN_RATIO).fract() as f32,
        still: if facts.sequence.is_some_and(|sequence| sequence.is_still) { 1.0 } else { 0.0 },
        forward: camera.forward,
        half_width: camera.half_width,
        right: camera.right,
        half_height: camera.half_height,
        up: camera.up,
        altitude_m: before.camera.altitude_m.max(0.0) as f32,
    };
    let elapsed_s = now.time_s - before.time_s;
    let mut drifts: Vec<[f32; 2]> =
        facts.clouds.iter().map(|layer| layer.wind_m_per_s.map(|speed| (speed * elapsed_s) as f32)).collect();
    drifts.resize(drifts.len().max(1).next_multiple_of(2), [0.0; 2]);
    [bytemuck::bytes_of(&header), bytemuck::cast_slice(&drifts)].concat()
}
