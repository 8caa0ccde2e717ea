//! Quadrature rules as the shaders read them.

use std::f64::consts::PI;

use bytemuck::{Pod, Zeroable};
use welkin_lut::quadrature::gauss_legendre;

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
    fn symmetric(abscissa: f64, weight: f64) -> Self {
        let (abscissa, weight) = (abscissa as f32, weight as f32);
        Self { abscissa, weight, descending_abscissa: 1.0 - abscissa, descending_weight: weight }
    }
}

fn rule(n: u32) -> impl Iterator<Item = GaussNodeBlock> {
    gauss_legendre(n as usize).into_iter().map(|node| GaussNodeBlock::symmetric(node.abscissa, node.weight))
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
    [grid.ground, grid.low, grid.high, grid.azimuths].into_iter().flat_map(fejer).collect()
}

/// Fejér's first rule on [0, 1], ascending: nodes sin²(π y / 2) at the midpoints y of equal parts, which polynomials of
/// degree n - 1 are integrated exactly from. (Davis & Rabinowitz 1984, Methods of Numerical Integration, 2.5.5.)
fn fejer(n: u32) -> impl Iterator<Item = GaussNodeBlock> {
    (0..n).map(move |k| {
        let theta = (f64::from(k) + 0.5) * PI / f64::from(n);
        let terms = (1..=n / 2).map(|j| (2.0 * f64::from(j) * theta).cos() / (4.0 * f64::from(j * j) - 1.0));
        GaussNodeBlock::symmetric((0.5 * theta).sin().powi(2), (1.0 - 2.0 * terms.sum::<f64>()) / f64::from(n))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(nodes: u32, degree: i32) -> f64 {
        fejer(nodes).map(|node| f64::from(node.weight) * f64::from(node.abscissa).powi(degree)).sum()
    }

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

    #[test]
    fn fejers_rule_integrates_polynomials_of_a_degree_below_its_nodes() {
        for nodes in [4, 5, 8, 12] {
            for degree in 0..nodes as i32 {
                let exact = 1.0 / f64::from(degree + 1);
                assert!((moment(nodes, degree) - exact).abs() < 1e-6, "{nodes} nodes, degree {degree}");
            }
        }
        // Negative control: two nodes do not see a parabola.
        assert!((moment(2, 2) - 1.0 / 3.0).abs() > 0.01);
    }
}
