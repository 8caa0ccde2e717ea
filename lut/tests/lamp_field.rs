//! Light of a lamp in matter: the solved field against walks that scatter as the phase function says.

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use welkin_lut::PhaseFunction;
use welkin_lut::lamp_field::LampField;

/// Optical depths between which shells lie.
const SHELLS: [f64; 6] = [0.2, 0.4, 0.8, 1.5, 2.5, 3.5];
const RADIUS: f64 = 5.0;
const WALKS: usize = 60_000;

/// Of every shell the moments 0 to 2 of light that is scattered there for a second time or more, with three of their standard
/// errors.
fn walked(phase: &PhaseFunction, albedo: f64) -> Vec<[(f64, f64); 3]> {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let mut uniform = move || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let mut sums = vec![[(0.0, 0.0); 3]; SHELLS.len() - 1];
    for _ in 0..WALKS {
        // By symmetry the distance and the cosine to the radius are all that a walk need know.
        let (mut radius, mut mu, mut weight, mut order) = (0.0_f64, 1.0_f64, 1.0, 0);
        let mut of_walk = vec![[0.0; 3]; SHELLS.len() - 1];
        loop {
            let way = -(1.0 - uniform()).ln();
            let moved = (radius * radius + way * way + 2.0 * radius * way * mu).sqrt();
            mu = if moved > 0.0 { (radius * mu + way) / moved } else { 1.0 };
            radius = moved;
            if radius >= RADIUS || weight < 1e-3 {
                break;
            }
            let cosine = phase.sample(uniform());
            let turn = (std::f64::consts::TAU * uniform()).cos();
            mu = (mu * cosine + ((1.0 - mu * mu).max(0.0) * (1.0 - cosine * cosine).max(0.0)).sqrt() * turn)
                .clamp(-1.0, 1.0);
            order += 1;
            if let (2.., Some(shell)) = (order, SHELLS.windows(2).position(|s| s[0] <= radius && radius < s[1])) {
                for (sum, p) in of_walk[shell].iter_mut().zip([1.0, mu, 1.5 * mu * mu - 0.5]) {
                    *sum += weight * p / (SHELLS[shell + 1] - SHELLS[shell]);
                }
            }
            weight *= albedo;
        }
        for (all, own) in sums.iter_mut().zip(&of_walk) {
            all.iter_mut().zip(own).for_each(|((sum, squares), x)| (*sum, *squares) = (*sum + x, *squares + x * x));
        }
    }
    let n = WALKS as f64;
    let of = |(sum, squares): (f64, f64)| (sum / n, 3.0 * ((squares / n - (sum / n).powi(2)) / n).sqrt());
    sums.into_iter().map(|moments| moments.map(of)).collect()
}

/// The mean of a moment over a shell.
fn mean(field: &LampField, degree: usize, shell: usize) -> f64 {
    let [near, far] = [SHELLS[shell], SHELLS[shell + 1]];
    (0..20).map(|i| field.scattered_moment(degree, near + (far - near) * (i as f64 + 0.5) / 20.0)).sum::<f64>() / 20.0
}

#[test]
fn light_that_is_scattered_again_around_a_lamp_is_what_walks_find() {
    let droplets = PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 16.0 };
    let cases = [
        (PhaseFunction::Isotropic, 1.0),
        (PhaseFunction::Isotropic, 0.5),
        (PhaseFunction::HenyeyGreenstein { g: 0.85 }, 0.9),
        (droplets, 1.0),
    ];
    for (phase, albedo) in cases {
        let field = LampField::new(&phase, albedo, RADIUS);
        let other = LampField::new(&phase, 0.95 * albedo, RADIUS);
        let mut told = false;
        for (shell, moments) in walked(&phase, albedo).into_iter().enumerate() {
            for (degree, (walked, error)) in moments.into_iter().enumerate() {
                // Moments are stated to 2 per cent of the whole.
                let bound = error + 0.02 * moments[0].0;
                let found = mean(&field, degree, shell);
                assert!(
                    (found - walked).abs() < bound,
                    "{phase:?} {albedo} {shell} {degree}: {found}, {walked} ± {error}"
                );
                told |= (mean(&other, degree, shell) - walked).abs() > bound;
            }
        }
        // Negative control: a twentieth less albedo is seen.
        assert!(told, "{phase:?}");
    }
}

#[test]
fn matter_that_absorbs_nothing_lets_all_light_out() {
    let field = LampField::new(&PhaseFunction::HenyeyGreenstein { g: 0.7 }, 1.0, 8.0);
    for depth in [0.1, 0.5, 1.0, 3.0, 7.0_f64] {
        // The unscattered light's flux and the scattered light's are the lamp's.
        let whole = (-depth).exp() + field.flux(depth).outward;
        assert!((whole - 1.0).abs() < 0.01, "{depth}: {whole}");
    }
    let absorbed = LampField::new(&PhaseFunction::HenyeyGreenstein { g: 0.7 }, 0.9, 8.0);
    assert!((-3.0_f64).exp() + absorbed.flux(3.0).outward < 0.9);
}

#[test]
fn the_field_of_matter_that_throws_light_back_is_finite_and_of_the_size_of_the_lamps() {
    for g in [-0.5, -0.9, -0.99, -0.9999] {
        let phase = PhaseFunction::HenyeyGreenstein { g };
        for (albedo, radius) in [(0.9, 0.5), (0.9, 5.0), (1.0, 60.0)] {
            let field = LampField::new(&phase, albedo, radius);
            for depth in [0.02, 0.5, 3.0, 20.0, 60.0] {
                let flux = field.flux(depth);
                // No more can leave than the lamp sends, and the solver is 2 % off walks. It is no solution for g below -0.5: what is
                // thrown back meets again at the lamp, more narrowly than moments tell. There only the size is held.
                let most = if g < -0.5 { 1.25 } else { 1.02 };
                assert!(flux.outward.abs() < most, "g = {g}, {radius} at {depth}: {flux:?}");
                assert!(
                    flux.scalar > 0.0 && flux.scalar < 3.0 * radius * (1.0 + radius),
                    "g = {g} at {depth}: {flux:?}"
                );
                let all = field.scattered_per_sr(depth, &[1.0, 0.3, -1.0]);
                assert!(all.iter().all(|k| k.is_finite()), "g = {g} at {depth}: {all:?}");
            }
        }
    }
}
