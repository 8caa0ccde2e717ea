//! Light in a slab: the tables against laws of energy and against walks that scatter as the phase function says.

use std::f64::consts::{PI, TAU};

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use welkin_lut::slab_field::{DEPTHS, SlabField, SlabLight, SlabMatter, Slabs, node_depth};

const WALKS: usize = 200_000;

fn at(table: &[SlabField], above: usize, below: usize) -> SlabField {
    table[above * DEPTHS + below]
}

#[test]
fn matter_that_absorbs_takes_light() {
    let of =
        |albedo| Slabs::new(SlabMatter { albedo, mean_cosine: 0.3, ground_albedo: 0.0 }).table(SlabLight::Beam(0.6));
    let whole = |albedo| {
        let table = of(albedo);
        at(&table, 0, 12).upward + at(&table, 12, 0).downward
    };
    let left = 1.0 - (-node_depth(12) / 0.6).exp();
    assert!((whole(1.0) - left).abs() < 1e-6 && whole(0.9) < 0.9 * left && whole(0.0) == 0.0);
}

#[test]
fn light_that_matter_and_ground_do_not_take_comes_back() {
    for (mean_cosine, ground_albedo) in [(0.0, 0.0), (0.45, 0.0), (0.3, 1.0)] {
        let slabs = Slabs::new(SlabMatter { albedo: 1.0, mean_cosine, ground_albedo });
        for light in [SlabLight::Beam(0.05), SlabLight::Beam(0.6), SlabLight::Sky] {
            let table = slabs.table(light);
            let straight = |depth: f64| match light {
                SlabLight::Beam(mu) => (-depth / mu).exp(),
                SlabLight::Sky => 0.0,
            };
            for node in [1, 8, 16, DEPTHS - 1] {
                let (top, bottom) = (at(&table, 0, node), at(&table, node, 0));
                let arriving = straight(node_depth(node)) + bottom.downward;
                let balance = top.upward + (1.0 - ground_albedo) * arriving;
                assert!((balance - 1.0).abs() < 1e-6, "{light:?} {mean_cosine} {ground_albedo} {node}: {balance}");
            }
        }
    }
}

/// Mean radiance, fluxes down, up and along of diffuse light in the middle of a slab, with standard errors, by walks that start in
/// the beam.
fn walked(matter: SlabMatter, mu: f64, above: f64, below: f64) -> [(f64, f64); 4] {
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let mut uniform = move || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let whole = above + below;
    let mut sums = [(0.0, 0.0); 4];
    for _ in 0..WALKS {
        // Of a direction the parts downwards and along the beam's azimuth, and across.
        let mut direction = [mu, (1.0 - mu * mu).sqrt(), 0.0];
        let (mut depth, mut weight, mut scattered) = (0.0, 1.0, false);
        let mut own = [0.0; 4];
        while weight > 1e-3 {
            let next = depth - (1.0 - uniform()).ln() * direction[0];
            let crosses = (depth < above) != (next < above);
            if crosses && scattered {
                // A crossing counts 1 / |cosine| for the mean radiance over the sphere, 4 pi sr.
                let cosine = f64::abs(direction[0]);
                own[0] += weight / (4.0 * PI * cosine);
                own[if direction[0] > 0.0 { 1 } else { 2 }] += weight;
                own[3] += weight * direction[1] / cosine;
            }
            depth = next;
            if depth < 0.0 {
                break;
            }
            if depth > whole {
                (depth, weight, scattered) = (whole, weight * matter.ground_albedo, true);
                let (cosine, azimuth) = (uniform().sqrt(), TAU * uniform());
                let sine = (1.0 - cosine * cosine).sqrt();
                direction = [-cosine, sine * azimuth.cos(), sine * azimuth.sin()];
                continue;
            }
            (weight, scattered) = (weight * matter.albedo, true);
            // P of two moments by rejection.
            direction = loop {
                let (cosine, azimuth) = (2.0 * uniform() - 1.0, TAU * uniform());
                let sine = (1.0 - cosine * cosine).sqrt();
                let trial = [cosine, sine * azimuth.cos(), sine * azimuth.sin()];
                let turn: f64 = trial.iter().zip(direction).map(|(a, b)| a * b).sum();
                if uniform() * (1.0 + 3.0 * matter.mean_cosine.abs()) < 1.0 + 3.0 * matter.mean_cosine * turn {
                    break trial;
                }
            };
        }
        for ((sum, squares), x) in sums.iter_mut().zip(own) {
            (*sum, *squares) = (*sum + x, *squares + x * x);
        }
    }
    let n = WALKS as f64;
    sums.map(|(sum, squares)| (sum / n, ((squares / n - (sum / n).powi(2)) / n).sqrt()))
}

#[test]
fn the_field_is_what_walks_find() {
    let cases = [
        (SlabMatter { albedo: 1.0, mean_cosine: 0.0, ground_albedo: 0.0 }, 0.57, 7, 12),
        (SlabMatter { albedo: 0.7, mean_cosine: 0.33, ground_albedo: 0.3 }, 0.25, 5, 9),
        (SlabMatter { albedo: 0.95, mean_cosine: 0.33, ground_albedo: 0.8 }, 0.95, 10, 5),
    ];
    for (matter, mu, above, below) in cases {
        let table = Slabs::new(matter).table(SlabLight::Beam(mu));
        let found = at(&table, above, below);
        let other = at(&table, above + 1, below);
        let walks = walked(matter, mu, node_depth(above), node_depth(below));
        let misses = |field: SlabField| {
            let ours = [field.mean_radiance, field.downward, field.upward, field.along];
            // Grazing crossings make distributions long-tailed: 1 % besides three standard errors.
            ours.iter().zip(walks).any(|(ours, (mean, error))| (ours - mean).abs() > 3.0 * error + 0.01 * mean.abs())
        };
        assert!(!misses(found), "{matter:?}: {found:?} against {walks:?}");
        assert!(misses(other), "the control: another depth is told apart, {matter:?}: {other:?} against {walks:?}");
    }
}
