//! Fog and local volumes as the shaders read them.

use bytemuck::{Pod, Zeroable};
use welkin_lut::volume::{Volume, VolumeForm, VolumeParameters};
use welkin_lut::{Bands, PhaseFunction, forward_peak, slab_field};

use super::angular_fields::AngularFields;
use super::atmosphere::{PhaseLobeBlock, scaled_lobes};
use super::local_lists::LocalLists;
use super::vec3;
use crate::plan::Facts;

/// Lobes that a phase function has room for: WGSL `VOLUME_LOBES`.
const VOLUME_LOBES: usize = 2;

/// WGSL `Volume`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct VolumeBlock {
    pub(super) centre_m: [f32; 3],
    pub(super) kind: u32,
    pub(super) half_size_m: [f32; 3],
    pub(super) per_edge: f32,
    pub(super) noise_offset: [f32; 3],
    pub(super) noise_per_m: f32,
    pub(super) scattering_per_m: [f32; 3],
    pub(super) noise_strength: f32,
    pub(super) extinction_per_m: [f32; 3],
    pub(super) detail_m: f32,
    pub(super) emission_per_m: [f32; 3],
    pub(super) per_scale_height: f32,
    pub(super) turn: [f32; 2],
    pub(super) bottom_m: f32,
    pub(super) top_m: f32,
    pub(super) grid_size: [u32; 3],
    pub(super) grid_first: u32,
    pub(super) similar_extinction: [f32; 3],
    pub(super) similarity: f32,
    pub(super) backward: f32,
    pub(super) is_even: u32,
    pub(super) first_block: u32,
    pub(super) lamp_field: u32,
    pub(super) again: [f32; 3],
    pub(super) beam_field: u32,
    pub(super) occluders_first: u32,
    pub(super) occluder_count: u32,
    pub(super) padding: [u32; 2],
}

/// WGSL `VolumePhase`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct VolumePhaseBlock {
    pub(super) lobes: [PhaseLobeBlock; VOLUME_LOBES],
}

/// Mean chord of a local form, 4 V / S (Cauchy), m; that of an ellipsoid for the sphere of its volume.
pub(super) fn mean_chord_m(form: &VolumeForm) -> f64 {
    match *form {
        VolumeForm::Box { size_m: [x, y, z], .. } => 2.0 * x * y * z / (x * y + y * z + z * x),
        VolumeForm::Ellipsoid { size_m: [x, y, z], .. } => 2.0 / 3.0 * (x * y * z).cbrt(),
        VolumeForm::Fog { .. } => 0.0,
    }
}

/// Single-scattering albedo; 0 where there is nothing.
pub(super) fn albedo(volume: &Volume) -> Bands {
    let extinction = volume.extinction_per_m();
    std::array::from_fn(
        |band| if extinction[band] > 0.0 { volume.scattering_per_m[band] / extinction[band] } else { 0.0 },
    )
}

/// Moments of a volume's phase function with which its light is followed once the forward peak has been taken out: as many as
/// slabs are solved with in fog, and in local volumes the two that a mean chord can do with.
pub(super) fn followed_moments(volume: &Volume) -> usize {
    if volume.altitudes_m().is_some() { slab_field::MOMENTS } else { 2 }
}

/// Share of scattered light that counts as unscattered: that of the forward peak.
fn peak_share(volume: &Volume) -> f64 {
    forward_peak::share(&volume.phase, followed_moments(volume))
}

/// The medium without the scattering that hardly turns light from its line (Joseph, Wiscombe & Weinman 1976).
pub(super) struct Similar {
    /// Its extinction over that of the volume, 1 where there is none.
    extinction: Bands,
    /// Its single-scattering albedo.
    pub(super) albedo: Bands,
}

impl Similar {
    pub(super) fn new(volume: &Volume) -> Self {
        let (forward, albedo) = (peak_share(volume), albedo(volume));
        let extinction = albedo.map(|albedo| 1.0 - forward * albedo);
        Self { extinction, albedo: std::array::from_fn(|band| (1.0 - forward) * albedo[band] / extinction[band]) }
    }
}

/// Of light that was scattered once in a volume, what is scattered again and again, over the light: x / (1 + (1 - W) x)
/// with x the mean chord in optical depths of the similar medium and W its albedo.
fn again(volume: &Volume, similar: &Similar) -> Bands {
    let (chord_m, extinction) = (mean_chord_m(&volume.form), volume.extinction_per_m());
    std::array::from_fn(|band| {
        let x = similar.extinction[band] * extinction[band] * chord_m;
        similar.albedo[band] * x / (1.0 + (1.0 - similar.albedo[band]) * x)
    })
}

impl VolumeBlock {
    fn new(facts: &Facts, index: usize, lists: &LocalLists, fields: &AngularFields, grid_first: u32) -> Self {
        let volume = facts.volumes[index];
        let p = VolumeParameters::new(volume, facts.scene.time_s);
        let similar = Similar::new(volume);
        let fog = facts.fog_count() as usize;
        let levels = facts.settings.volumes.fog_levels as usize;
        // One that is not seen has no block; nothing asks for it.
        let local_block = facts.seen_volumes.iter().position(|&seen| seen == index).unwrap_or(0);
        let first_block = if index < fog { index * levels } else { fog * levels + local_block };
        let is_even = volume.edge == 0.0 && p.noise_strength == 0.0 && volume.grid.is_none() && index >= fog;
        let occluders = lists.of_volume(index);
        Self {
            centre_m: p.centre_m,
            kind: p.kind as u32,
            half_size_m: p.half_size_m,
            per_edge: p.per_edge,
            noise_offset: p.noise_offset,
            noise_per_m: p.noise_per_m,
            scattering_per_m: vec3(volume.scattering_per_m),
            noise_strength: p.noise_strength,
            extinction_per_m: vec3(volume.extinction_per_m()),
            detail_m: volume.detail_m() as f32,
            emission_per_m: vec3(volume.emission_per_m),
            per_scale_height: p.per_scale_height,
            turn: p.turn,
            bottom_m: p.bottom_m,
            top_m: p.top_m,
            grid_size: volume.grid.as_ref().map_or([0; 3], |grid| grid.size().map(|n| n as u32)),
            grid_first,
            similar_extinction: vec3(similar.extinction),
            similarity: (1.0 - peak_share(volume)) as f32,
            backward: (1.0 - volume.phase.mean_cosine()) as f32,
            is_even: u32::from(is_even),
            again: vec3(again(volume, &similar)),
            first_block: first_block as u32,
            occluders_first: occluders.start as u32,
            occluder_count: occluders.len() as u32,
            lamp_field: fields.around_lamp(volume),
            beam_field: fields.in_beam(volume),
            padding: [0; 2],
        }
    }
}

/// WGSL `array<Volume>`, with one that is nothing where there is none. Behind the volumes stand the layers of clouds, of which only
/// the table of lamps' light is filled in: to a lamp they are one more kind of matter.
pub fn volume_blocks(facts: &Facts, lists: &LocalLists, fields: &AngularFields) -> Vec<VolumeBlock> {
    let mut first = 0;
    let mut blocks = Vec::with_capacity(facts.volumes.len().max(1));
    for (index, volume) in facts.volumes.iter().enumerate() {
        blocks.push(VolumeBlock::new(facts, index, lists, fields, first));
        first += volume.grid.as_ref().map_or(0, |grid| grid.samples().len() as u32);
    }
    let of_clouds = |layer| VolumeBlock { lamp_field: fields.of_clouds(layer), ..VolumeBlock::zeroed() };
    blocks.extend(facts.clouds.iter().map(|layer| of_clouds(layer)));
    blocks.resize(blocks.len().max(1), VolumeBlock::zeroed());
    blocks
}

/// Samples of all grids, one volume after the other.
pub fn volume_samples(facts: &Facts) -> Vec<f32> {
    let grids = facts.volumes.iter().filter_map(|volume| volume.grid.as_ref());
    let mut samples: Vec<f32> = grids.flat_map(|grid| grid.samples().iter().copied()).collect();
    samples.resize(samples.len().max(1), 0.0);
    samples
}

impl VolumePhaseBlock {
    fn new(phase: &PhaseFunction) -> Self {
        let mut lobes = [PhaseLobeBlock::ABSENT; VOLUME_LOBES];
        lobes.iter_mut().zip(scaled_lobes(phase, 1.0)).for_each(|(slot, lobe)| *slot = lobe);
        Self { lobes }
    }
}

/// WGSL `array<VolumePhase>`: of each volume, and behind them of layers of clouds, for light of lamps.
pub fn volume_phases(facts: &Facts) -> Vec<VolumePhaseBlock> {
    let of_volume = |volume: &Volume| {
        VolumePhaseBlock::new(if volume.scatters() { &volume.phase } else { &PhaseFunction::Isotropic })
    };
    let volumes = facts.volumes.iter().map(|volume| of_volume(volume));
    let mut all: Vec<_> = volumes.chain(facts.clouds.iter().map(|layer| VolumePhaseBlock::new(&layer.phase))).collect();
    all.resize(all.len().max(1), VolumePhaseBlock::zeroed());
    all
}
