//! Quadrature rules as the shaders read them.

use std::f64::consts::PI;

use bytemuck::{Pod, Zeroable};
use welkin_lut::quadrature::gauss_legendre;

use crate::plan::{Quadrature, Settings};

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
    match settings.quadrature {
        Quadrature::GaussLegendre => rule(settings.nodes_per_leg).collect(),
        Quadrature::EqualSteps => equal_steps(settings.nodes_per_leg).collect(),
    }
}

/// Where a step is sampled.
const SAMPLED_AT: f64 = 0.3;

/// Samples at equal distances, each for the way from the one before; see [`Quadrature::EqualSteps`]. Distance over length
/// is v², so that a sample's share of the length is 2 v times its weight.
fn equal_steps(n: u32) -> impl Iterator<Item = GaussNodeBlock> {
    let distance = move |i: u32| (f64::from(i) + SAMPLED_AT) / f64::from(n);
    (0..n).map(move |i| {
        let before = if i == 0 { 0.0 } else { distance(i - 1) };
        let v = distance(i).sqrt();
        GaussNodeBlock { abscissa: v as f32, weight: (0.5 * (distance(i) - before) / v) as f32, padding: [0.0; 2] }
    })
}

/// Nodes of the three parts of the view sphere, one after the other.
pub fn cosine_nodes(settings: &Settings) -> Vec<GaussNodeBlock> {
    let directions = settings.directions;
    [directions.below, directions.band, directions.above].into_iter().flat_map(rule).collect()
}

/// Nodes of the three parts of the source function's sphere and of its azimuths, one after the other.
pub fn grid_nodes(settings: &Settings) -> Vec<GaussNodeBlock> {
    let grid = settings.source_grid;
    [grid.ground, grid.low, grid.high, grid.azimuths].into_iter().flat_map(fejer).collect()
}

/// Fejér's first rule on [0, 1], ascending: nodes sin²(π y / 2) at the midpoints y of equal parts, which polynomials of
/// degree n - 1 are integrated exactly from. (Davis & Rabinowitz 1984, Methods of Numerical Integration, 2.5.5.)
fn fejer(n: u32) -> impl Iterator<Item = GaussNodeBlock> {
    (0..n).map(move |k| {
        let theta = (f64::from(k) + 0.5) * PI / f64::from(n);
        let terms = (1..=n / 2).map(|j| (2.0 * f64::from(j) * theta).cos() / (4.0 * f64::from(j * j) - 1.0));
        GaussNodeBlock {
            abscissa: (0.5 * theta).sin().powi(2) as f32,
            weight: ((1.0 - 2.0 * terms.sum::<f64>()) / f64::from(n)) as f32,
            padding: [0.0; 2],
        }
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
        let length = |node: &GaussNodeBlock| 2.0 * f64::from(node.abscissa) * f64::from(node.weight);
        let sum: f64 = equal_steps(16).map(|node| length(&node)).sum();
        assert!((sum - (1.0 - 0.7 / 16.0)).abs() < 1e-6, "{sum}");
        assert!((rule(16).map(|node| length(&node)).sum::<f64>() - 1.0).abs() < 1e-6);
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
