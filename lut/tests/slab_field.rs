//! Light in a slab: the tables against laws of energy and against walks that scatter as the phase function says.

use std::f64::consts::{PI, TAU};

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use welkin_lut::PhaseFunction;
use welkin_lut::forward_peak::{moments_of_rest, share};
use welkin_lut::slab_field::{
    AZIMUTHS, DEPTHS, ELEVATIONS, MOMENTS, SlabField, SlabLight, SlabMatter, Slabs, node_azimuth_rad, node_depth,
    node_elevation_rad,
};

const WALKS: usize = 200_000;

fn at(table: &[SlabField], above: usize, below: usize) -> &SlabField {
    &table[above * DEPTHS + below]
}

/// The similar matter of one that scatters so.
fn similar(phase: &PhaseFunction, albedo: f64, ground_albedo: f64) -> SlabMatter {
    let f = share(phase, MOMENTS);
    let similar_albedo = albedo * (1.0 - f) / (1.0 - albedo * f);
    SlabMatter { albedo: similar_albedo, moments: moments_of_rest(phase), ground_albedo }
}

#[test]
fn matter_that_absorbs_takes_light() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.3 };
    let of = |albedo| Slabs::new(similar(&phase, albedo, 0.0)).table(SlabLight::Beam(0.6));
    let whole = |albedo| {
        let table = of(albedo);
        at(&table, 0, 12).upward + at(&table, 12, 0).downward
    };
    // What passes unscattered; with g = 0.3 nothing is a peak.
    let left = 1.0 - (-node_depth(12) / 0.6).exp();
    assert!((whole(1.0) - left).abs() < 1e-6 && whole(0.9) < 0.9 * left && whole(0.0) == 0.0);
}

#[test]
fn light_that_matter_and_ground_do_not_take_comes_back() {
    for (g, ground_albedo) in [(0.0, 0.0), (0.85, 0.0), (0.6, 1.0)] {
        let slabs = Slabs::new(similar(&PhaseFunction::HenyeyGreenstein { g }, 1.0, ground_albedo));
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
                assert!((balance - 1.0).abs() < 1e-6, "{light:?} {g} {ground_albedo} {node}: {balance}");
            }
        }
    }
}

/// Directions of the tables in which walks look.
const LOOKS: [(usize, usize); 5] = [(10, 1), (9, 4), (13, 0), (4, 2), (6, 9)];

/// What matter in the middle of a slab scatters into the directions of [`LOOKS`], of light of a beam that has been scattered before, per
/// scattering coefficient, with standard errors; then the fluxes down and up there. By walks that start in the beam and scatter as the phase
/// function says.
fn walked(phase: &PhaseFunction, albedo: f64, ground_albedo: f64, mu: f64, above: f64, below: f64) -> Vec<(f64, f64)> {
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let mut uniform = move || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let whole = above + below;
    let looks = LOOKS.map(|(elevation, azimuth)| {
        let (elevation, azimuth) = (node_elevation_rad(elevation), node_azimuth_rad(azimuth));
        [-elevation.sin(), elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin()]
    });
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut sums = vec![(0.0, 0.0); LOOKS.len() + 2];
    for _ in 0..WALKS {
        // Of a direction the parts downwards and along the beam's azimuth, and across.
        let mut direction = [mu, (1.0 - mu * mu).sqrt(), 0.0];
        let (mut depth, mut weight, mut scattered) = (0.0, 1.0, false);
        let mut own = vec![0.0; sums.len()];
        while weight > 1e-3 {
            let next = depth - (1.0 - uniform()).ln() * direction[0];
            let crosses = (depth < above) != (next < above);
            if crosses && scattered {
                // A crossing counts 1 / |cosine| for radiance; both sides of the plane of the beam are alike.
                for (own, look) in own.iter_mut().zip(&looks) {
                    let mirrored = [look[0], look[1], -look[2]];
                    let both = [*look, mirrored].map(|look| phase.value(dot(look, direction)));
                    *own += weight * 0.5 * (both[0] + both[1]) / f64::abs(direction[0]);
                }
                own[LOOKS.len() + usize::from(direction[0] < 0.0)] += weight;
            }
            depth = next;
            if depth < 0.0 {
                break;
            }
            if depth > whole {
                (depth, weight, scattered) = (whole, weight * ground_albedo, true);
                let (cosine, azimuth) = (uniform().sqrt(), TAU * uniform());
                let sine = (1.0 - cosine * cosine).sqrt();
                direction = [-cosine, sine * azimuth.cos(), sine * azimuth.sin()];
                continue;
            }
            (weight, scattered) = (weight * albedo, true);
            let (cosine, azimuth) = (phase.sample(uniform()), TAU * uniform());
            direction = turned(direction, cosine, azimuth);
        }
        for ((sum, squares), x) in sums.iter_mut().zip(own) {
            (*sum, *squares) = (*sum + x, *squares + x * x);
        }
    }
    let n = WALKS as f64;
    sums.into_iter().map(|(sum, squares)| (sum / n, ((squares / n - (sum / n).powi(2)) / n).sqrt())).collect()
}

/// A direction turned by an angle of this cosine.
fn turned(from: [f64; 3], cosine: f64, azimuth: f64) -> [f64; 3] {
    let across = (1.0 - from[0] * from[0]).max(1e-12).sqrt();
    let [x, y, z] = from;
    let first = [-across, x * y / across, x * z / across];
    let second = [0.0, -z / across, y / across];
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    std::array::from_fn(|i| cosine * from[i] + sine * (azimuth.cos() * first[i] + azimuth.sin() * second[i]))
}

#[test]
fn what_a_slab_scatters_is_what_walks_find() {
    let cases = [
        (PhaseFunction::Isotropic, 1.0, 0.0, 0.57, 7, 12),
        (PhaseFunction::HenyeyGreenstein { g: 0.6 }, 0.7, 0.3, 0.25, 5, 9),
        (PhaseFunction::HenyeyGreenstein { g: 0.75 }, 0.95, 0.8, 0.95, 10, 5),
    ];
    for (phase, albedo, ground_albedo, mu, above, below) in cases {
        let f = share(&phase, MOMENTS);
        let matter = similar(&phase, albedo, ground_albedo);
        let table = Slabs::new(matter).table(SlabLight::Beam(mu));
        // The similar medium is thinner than the matter.
        let [walk_above, walk_below] = [above, below].map(|node| node_depth(node) / (1.0 - albedo * f));
        let walks = walked(&phase, albedo, ground_albedo, mu, walk_above, walk_below);
        let misses = |field: &SlabField| {
            let looks =
                LOOKS.map(|(elevation, azimuth)| (1.0 - f) * field.scattered_per_sr[elevation * AZIMUTHS + azimuth]);
            let ours = looks.into_iter().chain([field.downward, field.upward]);
            // Grazing crossings make distributions long-tailed: 1.5 % besides three standard errors.
            ours.zip(&walks)
                .filter(|(ours, (mean, error))| (ours - mean).abs() > 3.0 * error + 0.015 * mean.abs())
                .count()
        };
        assert_eq!(misses(at(&table, above, below)), 0, "{phase:?}: {:?} against {walks:?}", at(&table, above, below));
        let other = at(&table, above + 1, below);
        assert!(misses(other) > 0, "the control: another depth is told apart, {phase:?}");
    }
}

#[test]
fn directions_of_a_table_end_at_the_vertical_and_at_the_opposite_azimuth() {
    let ends = [
        node_elevation_rad(0),
        node_elevation_rad(ELEVATIONS - 1),
        node_azimuth_rad(0),
        node_azimuth_rad(AZIMUTHS - 1),
    ];
    assert!(ends.iter().zip([-0.5 * PI, 0.5 * PI, 0.0, PI]).all(|(end, exact)| (end - exact).abs() < 1e-12));
}
