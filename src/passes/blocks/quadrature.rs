//! Quadrature rules as the shaders read them.

use bytemuck::{Pod, Zeroable};
use welkin_lut::quadrature::{GaussNode, fejer, gauss_legendre};

use crate::plan::{Quadrature, Settings, SourceGrid};

/// WGSL `GaussNode`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GaussNodeBlock {
    pub(super) abscissa: f32,
    pub(super) weight: f32,
    pub(super) descending_abscissa: f32,
    pub(super) descending_weight: f32,
}

impl GaussNodeBlock {
    /// Of a rule that is symmetric about 1/2: a leg walked from its high end only mirrors it.
    fn symmetric(node: GaussNode) -> Self {
        let (abscissa, weight) = (node.abscissa as f32, node.weight as f32);
        Self { abscissa, weight, descending_abscissa: 1.0 - abscissa, descending_weight: weight }
    }
}

fn rule(n: u32) -> impl Iterator<Item = GaussNodeBlock> {
    gauss_legendre(n as usize).into_iter().map(GaussNodeBlock::symmetric)
}

/// Nodes on each leg of a ray.
pub fn gauss_nodes(settings: &Settings) -> Vec<GaussNodeBlock> {
    match settings.quadrature {
        Quadrature::GaussLegendre => rule(settings.nodes_per_leg).collect(),
        Quadrature::EqualSteps => equal_steps(settings.nodes_per_leg).collect(),
    }
}

/// Where a step is sampled.
const SAMPLED_AT: f64 = 0.3;

/// Samples at equal distances, each for the way from the one before; see [`Quadrature::EqualSteps`]. Distance over length
/// is v² on a leg that ascends and 1 - v² on one that descends, so that a sample's share of the length is 2 v times its
/// weight on both.
fn equal_steps(n: u32) -> impl Iterator<Item = GaussNodeBlock> {
    let distance = move |i: u32| (f64::from(i) + SAMPLED_AT) / f64::from(n);
    (0..n).map(move |i| {
        let before = if i == 0 { 0.0 } else { distance(i - 1) };
        let [up, down] = [distance(i).sqrt(), (1.0 - distance(i)).sqrt()];
        let [weight, descending_weight] = [up, down].map(|v| (0.5 * (distance(i) - before) / v) as f32);
        GaussNodeBlock { abscissa: up as f32, weight, descending_abscissa: down as f32, descending_weight }
    })
}

/// Nodes of the three parts of the view sphere, one after the other.
pub fn cosine_nodes(settings: &Settings) -> Vec<GaussNodeBlock> {
    let directions = settings.directions;
    [directions.below, directions.band, directions.above].into_iter().flat_map(rule).collect()
}

/// Nodes of the three parts of the source function's sphere and of its azimuths, one after the other.
pub fn grid_nodes(grid: SourceGrid) -> Vec<GaussNodeBlock> {
    let parts = [grid.ground, grid.low, grid.high, grid.azimuths];
    parts.into_iter().flat_map(|n| fejer(n as usize)).map(GaussNodeBlock::symmetric).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_steps_leave_out_the_end_of_the_ray() {
        let length = |v: f32, weight: f32| 2.0 * f64::from(v) * f64::from(weight);
        let ascending = |node: GaussNodeBlock| length(node.abscissa, node.weight);
        let descending = |node: GaussNodeBlock| length(node.descending_abscissa, node.descending_weight);
        for sum in [equal_steps(16).map(ascending).sum::<f64>(), equal_steps(16).map(descending).sum()] {
            assert!((sum - (1.0 - 0.7 / 16.0)).abs() < 1e-6, "{sum}");
        }
        for sum in [rule(16).map(ascending).sum::<f64>(), rule(16).map(descending).sum()] {
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
    }
}
