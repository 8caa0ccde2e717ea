//! Scattered light for every altitude, sun and direction, as engines read it. Not part of a frame.

use bytemuck::{Pod, Zeroable};
use welkin_lut::bake::ScatteringSize;

use super::{Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};

/// WGSL `ScatteringLayout`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ScatteringLayoutBlock {
    azimuth_count: u32,
    sun_count: u32,
    altitude_count: u32,
    padding: u32,
}

/// Records the dispatch; `optical_depth_table` and `multiple_scattering_table` must have been made.
pub fn record(recording: &mut Recording, size: &ScatteringSize) -> Result<(), RenderError> {
    let &ScatteringSize { azimuths, suns, elevations, altitudes } = size;
    let layers = 1 + recording.facts.groups.scatterer_count;
    let [width, depth] = [azimuths * suns, 2 * layers * altitudes];
    let shape = ImageShape::D3(width, elevations, depth);
    recording.resources.image("scattering_table", shape, ImageFormat::Rgba32Float)?;
    let block =
        ScatteringLayoutBlock { azimuth_count: azimuths, sun_count: suns, altitude_count: altitudes, padding: 0 };
    recording.insert_parameters("scattering_layout", &block);
    recording.dispatch("scattering_table", &[], &[], Work::Invocations([width, elevations, 2 * altitudes]))
}
