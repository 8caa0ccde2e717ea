//! Clouds as the shaders read them.

use bytemuck::{Pod, Zeroable};
use welkin_lut::PhaseFunction;
use welkin_lut::cloud::{CloudLayer, CloudParameters};

use super::atmosphere::{PhaseLobeBlock, scaled_lobes};
use super::vec3;
use crate::passes::ordinates::coefficients::{BAND_ASYMMETRY, band_attenuations};
use crate::plan::{CloudScattering, Facts};

/// Lobes that a term has room for: WGSL `TERM_LOBES`.
const TERM_LOBES: usize = 4;

/// WGSL `CloudTerm`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CloudTermBlock {
    pub(super) attenuation: f32,
    pub(super) padding: [f32; 3],
    pub(super) lobes: [PhaseLobeBlock; TERM_LOBES],
}

/// WGSL `CloudMatter`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CloudMatterBlock {
    pub(super) albedo: [f32; 3],
    pub(super) backward: f32,
    pub(super) similarity: f32,
    pub(super) padding: [f32; 3],
}

impl CloudTermBlock {
    /// e^(-attenuation τ) times the sum of phase functions, each with its strength and the factor on its asymmetry.
    fn new(attenuation: f64, phase: &PhaseFunction, parts: &[(f64, f64)]) -> Self {
        let mut lobes = [PhaseLobeBlock::ABSENT; TERM_LOBES];
        let given = parts.iter().flat_map(|&(strength, factor)| {
            scaled_lobes(phase, factor).into_iter().map(move |lobe| lobe.times(strength))
        });
        lobes.iter_mut().zip(given).for_each(|(slot, lobe)| *slot = lobe);
        Self { attenuation: attenuation as f32, padding: [0.0; 3], lobes }
    }
}

/// The directional lights' terms for one phase function.
fn terms_of(phase: &PhaseFunction, scattering: CloudScattering) -> Vec<CloudTermBlock> {
    // Strength, extinction and asymmetry fall by these factors from octave to octave.
    let octaves = |count: i32, [a, b, c]: [f64; 3]| {
        (0..count).map(|i| CloudTermBlock::new(b.powi(i), phase, &[(a.powi(i), c.powi(i))])).collect()
    };
    match scattering {
        CloudScattering::Single => octaves(1, [1.0; 3]),
        CloudScattering::OctavesAsShipped => octaves(8, [0.5; 3]),
        CloudScattering::OctavesFitted => octaves(4, [0.351, 0.310, 0.377]),
        CloudScattering::Ordinates8 | CloudScattering::Ordinates16 => bands(phase),
    }
}

/// The two bands of near-forward light that the ordinates leave out.
fn bands(phase: &PhaseFunction) -> Vec<CloudTermBlock> {
    let [sharp, wide] = band_attenuations(phase, 1.0);
    vec![
        CloudTermBlock::new(sharp, phase, &[(1.0, 1.0), (-1.0, BAND_ASYMMETRY)]),
        CloudTermBlock::new(wide, phase, &[(1.0, BAND_ASYMMETRY)]),
    ]
}

/// Terms of each layer.
pub fn cloud_term_count(facts: &Facts) -> u32 {
    terms_of(&PhaseFunction::Isotropic, facts.cloud_scattering()).len() as u32
}

/// WGSL `array<CloudTerm>`: layer by layer.
pub fn cloud_terms(facts: &Facts) -> Vec<CloudTermBlock> {
    facts.clouds.iter().flat_map(|layer| terms_of(&layer.phase, facts.cloud_scattering())).collect()
}

impl CloudMatterBlock {
    fn new(layer: &CloudLayer) -> Self {
        let [g, f] = [1, 2].map(|degree| layer.phase.legendre_moment(degree));
        let (albedo, backward, similarity) = (vec3(layer.albedo), (1.0 - g) as f32, (1.0 - f) as f32);
        Self { albedo, backward, similarity, padding: [0.0; 3] }
    }
}

/// WGSL `array<CloudMatter>`.
pub fn cloud_matter(facts: &Facts) -> Vec<CloudMatterBlock> {
    facts.clouds.iter().map(|layer| CloudMatterBlock::new(layer)).collect()
}

/// WGSL `array<CloudLayer>`.
pub fn cloud_layers(facts: &Facts) -> Vec<[f32; 32]> {
    facts.clouds.iter().map(|layer| CloudParameters::new(layer, facts.scene.time_s).to_array()).collect()
}
