//! Directions drawn from the phase functions follow them.

mod phase_reference;

use std::f64::consts::PI;

use phase_reference::{mie_tables, reference_functions};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use welkin_lut::PhaseFunction;

const SAMPLES: usize = 200_000;
const BINS: usize = 50;

/// Share of the light in each of [`BINS`] bins of equal angle, by the midpoint rule.
fn expected_shares(phase: &PhaseFunction) -> [f64; BINS] {
    // So fine that the error, of relative order (angle/width of the peak)², is below 1e-4 of a bin even for g = 0.999.
    const STEPS: usize = 4000;
    std::array::from_fn(|bin| {
        let step = PI / (BINS * STEPS) as f64;
        let angle = |i: usize| ((bin * STEPS + i) as f64 + 0.5) * step;
        (0..STEPS).map(|i| phase.value(angle(i).cos()) * angle(i).sin()).sum::<f64>() * 2.0 * PI * step
    })
}

/// χ² of `SAMPLES` cosines drawn from `drawn` against the shares of `expected`, as a deviate: subtracted mean, divided
/// by standard deviation. Bins that expect fewer than 20 are joined, so that χ² is near its limit.
fn deviate(drawn: &PhaseFunction, expected: &PhaseFunction, seed: u64) -> f64 {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut counts = [0.0; BINS];
    for _ in 0..SAMPLES {
        let u = (random.next_u64() >> 11) as f64 * 0.5_f64.powi(53);
        let theta = drawn.sample(u).acos();
        counts[((theta / PI * BINS as f64) as usize).min(BINS - 1)] += 1.0;
    }
    let (mut chi_square, mut degrees, mut count, mut share) = (0.0, -1.0, 0.0, 0.0);
    let shares = expected_shares(expected);
    for bin in 0..BINS {
        count += counts[bin];
        share += shares[bin] * SAMPLES as f64;
        if share >= 20.0 || bin == BINS - 1 && share > 0.0 {
            chi_square += (count - share) * (count - share) / share;
            degrees += 1.0;
            (count, share) = (0.0, 0.0);
        }
    }
    (chi_square - degrees) / (2.0_f64 * degrees).sqrt()
}

/// A χ² deviate beyond this has a chance below 1e-4 for the degrees of freedom in use; the seeds are fixed.
const LIMIT: f64 = 5.0;

#[test]
fn histograms_of_every_function_pass_a_chi_square_test() {
    for (seed, function) in (1..).zip(reference_functions()) {
        let z = deviate(&function.phase, &function.phase, seed);
        assert!(z.abs() < LIMIT, "{:?}: {z}", function.phase);
    }
}

#[test]
fn histograms_of_the_mie_tables_pass_a_chi_square_test() {
    for (seed, table) in (100..).zip(mie_tables()) {
        let phase = table.phase_function();
        let z = deviate(&phase, &phase, seed);
        assert!(z.abs() < LIMIT, "{}: {z}", table.name);
    }
}

#[test]
fn the_chi_square_test_tells_a_neighbouring_function() {
    let hg = |g| PhaseFunction::HenyeyGreenstein { g };
    let pairs = [
        (hg(0.85), hg(0.84)),
        (hg(0.85), hg(-0.85)),
        (PhaseFunction::Rayleigh, PhaseFunction::Isotropic),
        (PhaseFunction::CornetteShanks { g: 0.85 }, hg(0.85)),
        (PhaseFunction::Draine { g: 0.7, alpha: 10.0 }, PhaseFunction::Draine { g: 0.7, alpha: 8.0 }),
        (
            PhaseFunction::DoubleHenyeyGreenstein { weight: 0.9, g1: 0.85, g2: -0.3 },
            PhaseFunction::DoubleHenyeyGreenstein { weight: 0.88, g1: 0.85, g2: -0.3 },
        ),
    ];
    for (drawn, expected) in pairs {
        let z = deviate(&drawn, &expected, 7);
        assert!(z > 2.0 * LIMIT, "{drawn:?} passes for {expected:?}: {z}");
    }
}

#[test]
fn the_mean_of_drawn_cosines_is_the_mean_cosine() {
    for (seed, function) in (200..).zip(reference_functions()) {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..SAMPLES {
            let c = function.phase.sample((random.next_u64() >> 11) as f64 * 0.5_f64.powi(53));
            sum += c;
            squares += c * c;
        }
        let n = SAMPLES as f64;
        let mean = sum / n;
        let standard_error = ((squares / n - mean * mean) / n).sqrt();
        // 38 functions: 4.5 standard errors are exceeded by chance in 3 of 10000 sets of seeds.
        assert!((mean - function.mean_cosine).abs() < 4.5 * standard_error, "{:?}: {mean}", function.phase);
    }
}
