//! The medium and the planet as the shaders read them.

use bytemuck::{Pod, Zeroable};
use welkin_lut::mapping::MultipleScatteringMapping;
use welkin_lut::phase::PhaseLobe;
use welkin_lut::{Constituent, DensityProfile, PhaseFunction};

use super::vec3;
use crate::plan::Facts;

/// Lobes that a constituent has room for: WGSL `MAX_LOBES`.
const MAX_LOBES: usize = 2;

/// WGSL `PhaseLobe`: scale (1 + quadratic ν²) (gap + slope (1 - peak ν))^(-exponent).
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct PhaseLobeBlock {
    pub(super) scale_per_sr: f32,
    pub(super) quadratic: f32,
    pub(super) gap: f32,
    pub(super) slope: f32,
    pub(super) exponent: f32,
    pub(super) peak_nu: f32,
    pub(super) padding: [f32; 2],
}

/// WGSL `Constituent`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct ConstituentBlock {
    pub(super) scattering_per_m: [f32; 3],
    pub(super) profile_a: f32,
    pub(super) extinction_per_m: [f32; 3],
    pub(super) profile_b: f32,
    pub(super) lobes: [PhaseLobeBlock; MAX_LOBES],
    pub(super) profile_group: u32,
    pub(super) padding: [u32; 3],
}

/// WGSL `Atmosphere` up to its array of constituents.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct AtmosphereHeader {
    pub(super) ground_albedo: [f32; 3],
    pub(super) radius_m: f32,
    pub(super) sun_warp: [f32; 3],
    pub(super) top_m: f32,
}

impl PhaseLobeBlock {
    /// A lobe that is not there must still have a base whose logarithm is finite.
    pub(super) const ABSENT: Self = Self {
        scale_per_sr: 0.0,
        quadratic: 0.0,
        gap: 1.0,
        slope: 0.0,
        exponent: 0.0,
        peak_nu: 1.0,
        padding: [0.0; 2],
    };

    /// The lobe with another strength.
    pub(super) fn times(self, strength: f64) -> Self {
        Self { scale_per_sr: (f64::from(self.scale_per_sr) * strength) as f32, ..self }
    }
}

impl From<PhaseLobe> for PhaseLobeBlock {
    fn from(lobe: PhaseLobe) -> Self {
        Self {
            scale_per_sr: lobe.scale_per_sr as f32,
            quadratic: lobe.quadratic as f32,
            gap: lobe.gap_in_single_precision(),
            slope: lobe.slope as f32,
            exponent: lobe.exponent as f32,
            peak_nu: lobe.peak_nu as f32,
            padding: [0.0; 2],
        }
    }
}

/// The lobes of a phase function that has a closed form. The plan refuses tables; a constituent that only absorbs may
/// carry one, and nobody reads it.
fn lobes(phase: &PhaseFunction) -> Vec<PhaseLobeBlock> {
    scaled_lobes(phase, 1.0)
}

/// The same with a factor on the asymmetry of every lobe.
pub(super) fn scaled_lobes(phase: &PhaseFunction, factor: f64) -> Vec<PhaseLobeBlock> {
    phase.scaled_lobes(factor).into_iter().map(PhaseLobeBlock::from).collect()
}

/// Lobes of the most complex phase function among the scatterers.
pub fn lobe_count(facts: &Facts) -> u32 {
    facts.scatterers().iter().map(|constituent| lobes(&constituent.phase).len() as u32).max().unwrap_or(0)
}

/// The two numbers of a density profile, as WGSL `Constituent` documents them.
pub(super) fn profile(profile: &DensityProfile) -> (f32, f32) {
    match *profile {
        DensityProfile::Exponential { scale_height_m } => {
            ((-1.0 / (scale_height_m * std::f64::consts::LN_2)) as f32, 0.0)
        }
        DensityProfile::Tent { centre_m, half_width_m } => (centre_m as f32, (1.0 / half_width_m) as f32),
        DensityProfile::Layer { bottom_m, top_m } => (bottom_m as f32, top_m as f32),
    }
}

impl ConstituentBlock {
    fn new(constituent: &Constituent, profile_group: u32) -> Self {
        let (profile_a, profile_b) = profile(&constituent.profile);
        let mut padded = [PhaseLobeBlock::ABSENT; MAX_LOBES];
        for (slot, lobe) in padded.iter_mut().zip(lobes(&constituent.phase)) {
            *slot = lobe;
        }
        Self {
            scattering_per_m: vec3(constituent.scattering_per_m),
            profile_a,
            extinction_per_m: vec3(constituent.extinction_per_m()),
            profile_b,
            lobes: padded,
            profile_group,
            padding: [0; 3],
        }
    }
}

/// WGSL `Atmosphere`; vacuum keeps one empty slot.
pub fn atmosphere_block(facts: &Facts) -> Vec<u8> {
    let planet = &facts.scene.planet;
    let header = AtmosphereHeader {
        ground_albedo: vec3(planet.ground_albedo),
        radius_m: planet.radius_m as f32,
        sun_warp: vec3(MultipleScatteringMapping::new(planet).sun_warp()),
        top_m: planet.atmosphere_height_m as f32,
    };
    let group = |index: usize| facts.profile_groups.get(index).copied().unwrap_or(0);
    let numbered = facts.constituents.iter().enumerate();
    let mut constituents: Vec<_> = numbered.map(|(i, c)| ConstituentBlock::new(c, group(i))).collect();
    constituents.resize(constituents.len().max(1), ConstituentBlock::zeroed());
    [bytemuck::bytes_of(&header), bytemuck::cast_slice(&constituents)].concat()
}

/// χ_l of each scatterer, row by row; one zero when there is none.
pub fn legendre_moments(facts: &Facts, degree_count: u32) -> Vec<f32> {
    let degrees = degree_count as usize;
    let moments = |c: &&Constituent| (0..degrees).map(|l| c.phase.legendre_moment(l) as f32).collect::<Vec<_>>();
    let mut all: Vec<f32> = facts.scatterers().iter().flat_map(moments).collect();
    all.resize(all.len().max(degrees), 0.0);
    all
}
