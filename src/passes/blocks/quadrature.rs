//! Quadrature rules as the shaders read them.

use bytemuck::{Pod, Zeroable};
use welkin_lut::quadrature::gauss_legendre;

use crate::plan::Settings;

/// WGSL `GaussNode`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GaussNodeBlock {
    pub(super) abscissa: f32,
    pub(super) weight: f32,
    pub(super) padding: [f32; 2],
}

fn rule(n: u32) -> impl Iterator<Item = GaussNodeBlock> {
    gauss_legendre(n as usize).into_iter().map(|node| GaussNodeBlock {
        abscissa: node.abscissa as f32,
        weight: node.weight as f32,
        padding: [0.0; 2],
    })
}

/// Nodes on each leg of a ray.
pub fn gauss_nodes(settings: &Settings) -> Vec<GaussNodeBlock> {
    rule(settings.nodes_per_leg).collect()
}

/// Nodes of the three parts of the view sphere, one after the other.
pub fn cosine_nodes(settings: &Settings) -> Vec<GaussNodeBlock> {
    let directions = settings.directions;
    [directions.below, directions.band, directions.above].into_iter().flat_map(rule).collect()
}
