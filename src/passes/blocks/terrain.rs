//! The height field as the shaders read it.

use bytemuck::{Pod, Zeroable};
use welkin_lut::height_field::Octave;

use super::vec3;
use crate::scene::Terrain;

/// WGSL `HeightField` up to its array of octaves.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct HeightFieldHeader {
    pub(super) albedo: [f32; 3],
    pub(super) height_m: f32,
    pub(super) snow_albedo: [f32; 3],
    pub(super) wavelength_m: f32,
    pub(super) snow_line_m: f32,
    pub(super) steepest_slope: f32,
    pub(super) octave_count: u32,
    pub(super) padding: f32,
}

/// WGSL `Octave`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub(super) struct OctaveBlock {
    pub(super) to_cells: [f32; 4],
    pub(super) fraction: [f32; 2],
    pub(super) cell: [i32; 2],
    pub(super) wavelength_m: f32,
    pub(super) share: f32,
    pub(super) key: u32,
    pub(super) padding: f32,
}

impl OctaveBlock {
    fn new(octave: &Octave) -> Self {
        Self {
            to_cells: octave.to_cells.map(|entry| entry as f32),
            fraction: octave.fraction.map(|share| share as f32),
            cell: octave.cell,
            wavelength_m: octave.wavelength_m as f32,
            share: octave.share as f32,
            key: octave.key,
            padding: 0.0,
        }
    }
}

/// Above every mountain, and finite, m.
const NO_SNOW_M: f64 = 1e9;

/// WGSL `HeightField`.
pub fn height_field_block(terrain: &Terrain) -> Vec<u8> {
    let field = &terrain.field;
    let header = HeightFieldHeader {
        albedo: vec3(terrain.albedo),
        height_m: field.height_m as f32,
        snow_albedo: vec3(terrain.snow_albedo),
        wavelength_m: field.wavelength_m as f32,
        snow_line_m: terrain.snow_line_m.min(NO_SNOW_M) as f32,
        steepest_slope: field.steepest_slope() as f32,
        octave_count: field.octaves.len() as u32,
        padding: 0.0,
    };
    let octaves: Vec<_> = field.octaves.iter().map(OctaveBlock::new).collect();
    [bytemuck::bytes_of(&header), bytemuck::cast_slice(&octaves)].concat()
}
