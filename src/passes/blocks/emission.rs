//! What the air gives off by itself, as the shaders read it.

use bytemuck::{Pod, Zeroable};
use welkin_lut::{Constituent, DensityProfile};

use super::atmosphere::profile;
use super::vec3;
use crate::plan::Facts;

/// Scale heights above which an exponential profile needs no more nodes of its own.
const SCALE_HEIGHTS: f64 = 6.0;

/// Degrees 0 .. n-1 of zonal harmonics that the field of emitted light keeps, at every quality.
pub const ZONAL_COUNT: u32 = 8;

/// WGSL `Emitter`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct EmitterBlock {
    pub(super) emission_per_m: [f32; 3],
    pub(super) profile_a: f32,
    pub(super) profile_b: f32,
    pub(super) padding: [f32; 3],
}

impl EmitterBlock {
    fn new(emitter: &Constituent) -> Self {
        let (profile_a, profile_b) = profile(&emitter.profile);
        Self { emission_per_m: vec3(emitter.emission_per_m), profile_a, profile_b, padding: [0.0; 3] }
    }
}

/// Altitudes inside the air where a ray through a glowing medium must be cut, ascending, m: kinks and jumps of every
/// profile, and the end of the lowest part of exponential emitters.
pub fn emission_breakpoints_m(facts: &Facts) -> Vec<f64> {
    if facts.emitters.is_empty() {
        return Vec::new();
    }
    let kinks = facts.emitters.iter().chain(&facts.constituents).flat_map(|c| c.profile.breakpoints_m());
    let thin = facts.emitters.iter().filter_map(|emitter| match emitter.profile {
        DensityProfile::Exponential { scale_height_m } => Some(SCALE_HEIGHTS * scale_height_m),
        _ => None,
    });
    let top_m = facts.scene.planet.atmosphere_height_m;
    let mut all: Vec<f64> = kinks.chain(thin).filter(|&h| h > 0.0 && h < top_m).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// WGSL `Emission`; a medium that does not glow keeps an empty slot of each kind.
pub fn emission_block(facts: &Facts) -> Vec<u8> {
    let mut emitters: Vec<_> = facts.emitters.iter().map(|emitter| EmitterBlock::new(emitter)).collect();
    emitters.resize(emitters.len().max(1), EmitterBlock::zeroed());
    let mut breakpoints: Vec<[f32; 4]> =
        emission_breakpoints_m(facts).into_iter().map(|h| [h as f32, 0.0, 0.0, 0.0]).collect();
    breakpoints.resize(breakpoints.len().max(1), [0.0; 4]);
    [bytemuck::cast_slice::<_, u8>(&emitters), bytemuck::cast_slice(&breakpoints)].concat()
}
