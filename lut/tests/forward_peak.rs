//! Light that forward peaks scatter again and again, against walks that do.

use std::f64::consts::{PI, TAU};

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use welkin_lut::PhaseFunction;
use welkin_lut::forward_peak::{ForwardPeak, share};

const WALKS: usize = 200_000;
/// Angles between which light is counted, degrees.
const RINGS: [f64; 6] = [0.0, 4.0, 10.0, 20.0, 40.0, 90.0];

/// Light within each ring that peaks scatter at a depth and have scattered before, with three standard errors: a walk goes on along the
/// beam, and each scattering is one by the peak with the probability of its share.
fn walked(phase: &PhaseFunction, albedo: f64, depth: f64) -> Vec<(f64, f64)> {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut uniform = move || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let ceiling = ForwardPeak::new(phase, 2).ceiling_per_sr();
    let mut counts = vec![0; RINGS.len() - 1];
    for _ in 0..WALKS {
        let (mut at, mut mu, mut order) = (0.0, 1.0_f64, 0);
        loop {
            let ends = {
                at -= (1.0 - uniform()).ln();
                at >= depth
            };
            let cosine = phase.sample(uniform());
            let turn = (TAU * uniform()).cos();
            // The last scattering, at the depth itself, is b's and not the albedo's.
            let lost = !ends && uniform() >= albedo;
            if lost || uniform() >= 1.0 - ceiling / phase.value(cosine) {
                break;
            }
            mu = (mu * cosine + ((1.0 - mu * mu).max(0.0) * (1.0 - cosine * cosine).max(0.0)).sqrt() * turn)
                .clamp(-1.0, 1.0);
            order += 1;
            if ends {
                let angle = mu.acos().to_degrees();
                if let (2.., Some(ring)) = (order, RINGS.windows(2).position(|r| r[0] <= angle && angle < r[1])) {
                    counts[ring] += 1;
                }
                break;
            }
        }
    }
    let of = |count: usize| (count as f64 / WALKS as f64, 3.0 * (count as f64).sqrt() / WALKS as f64);
    counts.into_iter().map(of).collect()
}

/// The same by the series.
fn summed(peak: &ForwardPeak, albedo: f64, depth: f64) -> Vec<f64> {
    let in_ring = |ring: &[f64]| {
        let angles: Vec<f64> =
            (0..100).map(|i| (ring[0] + (ring[1] - ring[0]) * (f64::from(i) + 0.5) / 100.0).to_radians()).collect();
        let cosines: Vec<f64> = angles.iter().map(|angle| angle.cos()).collect();
        let values = peak.scattered_again_per_sr(albedo, depth, &cosines);
        let width = (ring[1] - ring[0]).to_radians() / 100.0;
        values.iter().zip(&angles).map(|(k, angle)| TAU * k * angle.sin() * width).sum()
    };
    RINGS.windows(2).map(in_ring).collect()
}

#[test]
fn light_that_peaks_have_scattered_before_is_what_walks_find() {
    let phases = [
        PhaseFunction::HenyeyGreenstein { g: 0.7 },
        PhaseFunction::HenyeyGreenstein { g: 0.9 },
        PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 16.0 },
    ];
    for phase in phases {
        let peak = ForwardPeak::new(&phase, 2);
        let mut told = false;
        for (albedo, depth) in [(1.0, 0.5), (1.0, 4.0), (0.6, 2.0)] {
            let walks = walked(&phase, albedo, depth);
            let whole: f64 = walks.iter().map(|(count, _)| count).sum();
            let (found, other) = (summed(&peak, albedo, depth), summed(&peak, 0.9 * albedo, depth));
            for (ring, &(count, error)) in walks.iter().enumerate() {
                // Degrees end at 192, so that what lies within a degree is spread over one: 1 per cent of the whole.
                let bound = error + 0.01 * whole;
                assert!(
                    (found[ring] - count).abs() < bound,
                    "{phase:?} {albedo} {depth} {ring}: {} for {count} ± {error}",
                    found[ring]
                );
                told |= (other[ring] - count).abs() > bound;
            }
        }
        // Negative control: a tenth less albedo is seen.
        assert!(told, "{phase:?}");
    }
}

#[test]
fn a_peak_holds_the_share_that_the_similar_medium_leaves_unscattered() {
    for g in [0.3, 0.7, 0.95] {
        let phase = PhaseFunction::HenyeyGreenstein { g };
        let peak = ForwardPeak::new(&phase, 2);
        assert!((peak.moment(0) - g * g).abs() < 1e-6, "{g}: {}", peak.moment(0));
        assert!(peak.ceiling_per_sr() < phase.value(1.0) && peak.ceiling_per_sr() > phase.value(-1.0));
        // Negative control: moments of the whole phase function are others.
        assert!((peak.moment(3) - phase.legendre_moment(3)).abs() > 1e-3);
    }
}

#[test]
fn what_turns_light_back_has_no_forward_peak() {
    for phase in [PhaseFunction::Isotropic, PhaseFunction::Rayleigh, PhaseFunction::HenyeyGreenstein { g: -0.9 }] {
        let peak = ForwardPeak::new(&phase, 2);
        assert_eq!(share(&phase, 2), 0.0);
        assert!(peak.ceiling_per_sr() > phase.value(-1.0));
        assert_eq!(peak.scattered_again_per_sr(1.0, 3.0, &[1.0, 0.0, -1.0]), [0.0; 3]);
    }
    // Negative control.
    assert!(share(&PhaseFunction::HenyeyGreenstein { g: 0.5 }, 2) * 4.0 * PI > 3.0);
}
