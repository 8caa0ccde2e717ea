//! The spherical harmonics' equations around a point light, as a band of linear equations.
//!
//! Even moments are known at nodes of ln τ, odd ones halfway between, so that every derivative is a difference of neighbours.

use super::SOLVED;
use super::banded::Banded;
use crate::quadrature::gauss_legendre;

/// Nodes from the light to the surface of the ball.
const NODES: usize = 80;
/// Optical depth of the first node, where light scattered once is all there is; less in a small ball.
const FIRST_DEPTH: f64 = 0.02;
const HALF: usize = SOLVED / 2;
/// Moments above those solved for that count where light leaves the ball.
const LEAVING: usize = 16;

pub struct Problem<'a> {
    pub albedo: f64,
    /// χ_l.
    pub phase: &'a [f64],
    /// A_l.
    pub first: &'a [f64],
    /// Of the ball, in optical depths.
    pub radius: f64,
}

/// f_l of light that keeps close to its line: no moment falls more slowly than that of light which is not turned at all, as matter that
/// throws light back would have it (A_l grows without bound as all that comes back meets again at the light).
pub fn nearly_straight(albedo: f64, first: f64, depth: f64) -> f64 {
    ((albedo * first.min(1.0) - 1.0) * depth).exp() - (-depth).exp()
}

/// f_l beside the light. It grows as W A_l τ up to what has come back: W/2 where everything is thrown back, ∫ W e^(-2 τ) dτ.
fn beside_light(albedo: f64, first: f64, depth: f64) -> f64 {
    (albedo * first * depth).min(0.5 * albedo) * (-depth).exp()
}

/// Number of an even moment at a node.
fn even(node: usize, degree: usize) -> usize {
    node * SOLVED + degree / 2
}

/// Number of an odd moment after a node.
fn odd(node: usize, degree: usize) -> usize {
    node * SOLVED + HALF + degree / 2
}

/// ∫ over incoming directions of P_l P_k.
fn incoming(l: usize, k: usize) -> f64 {
    let product = |mu: f64| {
        let values: Vec<f64> = super::legendre(l.max(k) + 1, mu).collect();
        values[l] * values[k]
    };
    gauss_legendre(24).iter().map(|node| node.weight * product(-node.abscissa)).sum()
}

impl Problem<'_> {
    /// Optical depths of the nodes, and f_0, f_1, ... there.
    pub fn solve(&self) -> (Vec<f64>, Vec<[f64; SOLVED]>) {
        let start = FIRST_DEPTH.min(0.1 * self.radius).ln();
        let step = (self.radius.ln() - start) / NODES as f64;
        let depth = |place: f64| (start + place * step).exp();
        let mut equations = Banded::new((NODES + 1) * SOLVED, SOLVED);
        for node in 0..=NODES {
            for degree in (0..SOLVED).step_by(2) {
                let row = even(node, degree);
                match node {
                    0 => {
                        equations.add(row, row, 1.0);
                        equations.add_right(row, beside_light(self.albedo, self.first[degree], depth(0.0)));
                    }
                    NODES => self.let_out(&mut equations, degree),
                    _ => self.balance(
                        &mut equations,
                        row,
                        degree,
                        depth(node as f64),
                        step,
                        [odd(node - 1, 0), odd(node, 0)],
                    ),
                }
            }
            for degree in (1..SOLVED).step_by(2) {
                let row = odd(node, degree);
                if node == NODES {
                    // Beyond the ball nothing is asked for.
                    equations.add(row, row, 1.0);
                    continue;
                }
                let here = depth(node as f64 + 0.5);
                self.balance(&mut equations, row, degree, here, step, [even(node, 0), even(node + 1, 0)]);
            }
        }
        let values = equations.solve();
        let at = |node: usize, degree: usize| match degree % 2 {
            0 => values[even(node, degree)],
            _ if node == 0 => beside_light(self.albedo, self.first[degree], depth(0.0)),
            _ if node == NODES => values[odd(NODES - 1, degree)],
            _ => 0.5 * (values[odd(node - 1, degree)] + values[odd(node, degree)]),
        };
        let moments = (0..=NODES).map(|node| std::array::from_fn(|degree| at(node, degree))).collect();
        ((0..=NODES).map(|node| depth(node as f64)).collect(), moments)
    }

    /// What scattering, the curvature of shells and the neighbouring degrees do to one degree, times τ. `sides` number the
    /// first moment of the other parity on either side.
    fn balance(&self, equations: &mut Banded, row: usize, degree: usize, depth: f64, step: f64, sides: [usize; 2]) {
        let l = degree as f64;
        let up = (l + 1.0) / (2.0 * l + 1.0);
        let down = l / (2.0 * l + 1.0);
        for (side, sign) in sides.into_iter().zip([-1.0, 1.0]) {
            if degree + 1 < SOLVED {
                equations.add(row, side + degree.div_ceil(2), up * (sign / step + 0.5 * l));
            }
            if degree > 0 {
                equations.add(row, side + (degree - 1) / 2, down * (sign / step - 0.5 * (l + 1.0)));
            }
        }
        equations.add(row, row, depth * (1.0 - self.albedo * self.phase[degree]));
        equations.add_right(row, self.albedo * self.phase[degree] * depth * (-depth).exp());
        if degree + 1 == SOLVED {
            let above = |depth: f64| nearly_straight(self.albedo, self.first[SOLVED], depth);
            let slope = (above(depth * (0.5 * step).exp()) - above(depth * (-0.5 * step).exp())) / step;
            equations.add_right(row, -up * (slope + l * above(depth)));
        }
    }

    /// Marshak's condition at the surface: of the incoming light no odd moment is left.
    fn let_out(&self, equations: &mut Banded, degree: usize) {
        let row = even(NODES, degree);
        for k in 0..SOLVED + LEAVING {
            let share = (2 * k + 1) as f64 / 2.0 * incoming(degree + 1, k);
            match k {
                k if k >= SOLVED => {
                    equations.add_right(row, -share * nearly_straight(self.albedo, self.first[k], self.radius));
                }
                k if k % 2 == 0 => equations.add(row, even(NODES, k), share),
                k => equations.add(row, odd(NODES - 1, k), share),
            }
        }
    }
}
