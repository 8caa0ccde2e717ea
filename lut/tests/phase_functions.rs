//! The phase functions against values computed with 40 digits, and against what every phase function must obey.

mod phase_reference;

use std::f64::consts::PI;

use phase_reference::{ReferenceFunction, reference_functions};
use welkin_lut::{PhaseError, PhaseFunction};

/// ∫P(cos θ) f(cos θ) dω by Simpson's rule on intervals that halve towards both ends.
///
/// Independent of the crate's own quadrature. On an interval as long as its distance to the singularity the error is
/// about (1/256)⁴ · 60/180 < 1e-10 relative.
fn sphere_integral(phase: &PhaseFunction, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: i32 = 256;
    let g = |gap: f64| {
        let (front, back) = (1.0 - gap, gap - 1.0);
        phase.value(front) * f(front) + phase.value(back) * f(back)
    };
    let panel = |low: f64, high: f64| {
        let h = (high - low) / f64::from(STEPS);
        let weight = |i: i32| if i == 0 || i == STEPS { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
        (0..=STEPS).map(|i| weight(i) * g(low + h * f64::from(i))).sum::<f64>() * h / 3.0
    };
    let inner = 0.5_f64.powi(34);
    2.0 * PI * (panel(0.0, inner) + (0..34).map(|k| panel(0.5_f64.powi(k + 1), 0.5_f64.powi(k))).sum::<f64>())
}

/// The analytic functions up to the steepest that is promised.
fn steep_functions() -> Vec<PhaseFunction> {
    let mut functions = vec![PhaseFunction::Isotropic, PhaseFunction::Rayleigh];
    for g in [0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 0.999, 0.9999] {
        for g in [g, -g] {
            functions.push(PhaseFunction::HenyeyGreenstein { g });
            functions.push(PhaseFunction::Schlick { k: g });
            functions.push(PhaseFunction::CornetteShanks { g });
            functions.push(PhaseFunction::Draine { g, alpha: 30.0 });
            functions.push(PhaseFunction::DoubleHenyeyGreenstein { weight: 0.3, g1: g, g2: -0.4 });
        }
    }
    functions.extend([5.0, 17.3, 50.0].map(|d| PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: d }));
    functions
}

/// Largest relative error of `phase` over the angles of a reference function.
fn worst_error(phase: &PhaseFunction, reference: &ReferenceFunction) -> f64 {
    reference.points.iter().map(|&(c, expected)| (phase.value(c) / expected - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn every_value_of_the_reference_table_is_met_to_1e_10() {
    let functions = reference_functions();
    assert_eq!(functions.iter().map(|f| f.points.len()).sum::<usize>(), 1406);
    for function in &functions {
        let error = worst_error(&function.phase, function);
        assert!(error < 1e-10, "{:?}: relative error {error:e}", function.phase);
    }
}

#[test]
fn the_table_tells_a_wrong_parameter_and_a_swapped_sign() {
    for function in reference_functions() {
        let wrong = match function.phase {
            PhaseFunction::HenyeyGreenstein { g } if g != 0.0 => PhaseFunction::HenyeyGreenstein { g: -g },
            PhaseFunction::Schlick { k } if k != 0.0 => PhaseFunction::Schlick { k: -k },
            PhaseFunction::CornetteShanks { g } => PhaseFunction::CornetteShanks { g: g + 1e-8 },
            PhaseFunction::DoubleHenyeyGreenstein { weight, g1, g2 } => {
                PhaseFunction::DoubleHenyeyGreenstein { weight, g1: g2, g2: g1 }
            }
            PhaseFunction::Draine { g, alpha } => PhaseFunction::Draine { g, alpha: alpha * (1.0 + 1e-8) },
            PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: d } => {
                PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: d + 1e-6 }
            }
            PhaseFunction::Isotropic => PhaseFunction::Rayleigh,
            PhaseFunction::Rayleigh => PhaseFunction::Isotropic,
            _ => continue,
        };
        // Where both lobes weigh the same, swapping them changes nothing.
        let same = matches!(function.phase, PhaseFunction::DoubleHenyeyGreenstein { weight: 0.5, .. });
        assert_eq!(worst_error(&wrong, &function) < 1e-10, same, "{wrong:?} passes for {:?}", function.phase);
    }
}

#[test]
fn light_is_neither_made_nor_lost() {
    for phase in steep_functions() {
        let integral = sphere_integral(&phase, |_| 1.0);
        assert!((integral - 1.0).abs() < 1e-8, "{phase:?}: ∫P dω - 1 = {:e}", integral - 1.0);
    }
}

#[test]
fn the_mean_cosine_is_that_of_the_reference_table() {
    for function in reference_functions() {
        let error = function.phase.mean_cosine() - function.mean_cosine;
        assert!(error.abs() < 1e-12, "{:?}: {error:e}", function.phase);
    }
}

#[test]
fn legendre_moments_are_the_integrals_they_claim_to_be() {
    let legendre = |l: usize, x: f64| match l {
        0 => 1.0,
        1 => x,
        2 => 1.5 * x * x - 0.5,
        3 => (2.5 * x * x - 1.5) * x,
        _ => ((35.0 * x * x - 30.0) * x * x + 3.0) / 8.0,
    };
    for phase in steep_functions() {
        for l in 0..=4 {
            let (moment, integral) = (phase.legendre_moment(l), sphere_integral(&phase, |c| legendre(l, c)));
            assert!((moment - integral).abs() < 1e-8, "{phase:?}, l = {l}: {moment} against {integral}");
        }
    }
}

#[test]
fn schlicks_mean_cosine_has_a_closed_form() {
    for k in [-0.99_f64, -0.5, 0.2, 0.5, 0.9, 0.9999] {
        let expected = 1.0 / k - (1.0 - k * k) / (2.0 * k * k) * ((1.0 + k) / (1.0 - k)).ln();
        assert!((PhaseFunction::Schlick { k }.mean_cosine() - expected).abs() < 1e-13);
    }
}

#[test]
fn sampling_inverts_the_share_of_light_further_back() {
    // One lobe rises with u; two lobes share u, and are tested by their histograms.
    for phase in steep_functions() {
        if matches!(phase, PhaseFunction::DoubleHenyeyGreenstein { .. } | PhaseFunction::HenyeyGreensteinDraine { .. })
        {
            continue;
        }
        let mut previous = phase.sample(0.0);
        assert!((-1.0..-1.0 + 4.0 * f64::EPSILON).contains(&previous), "{phase:?}: {previous}");
        for i in 1..=64 {
            let u = f64::from(i) / 64.0;
            let c = phase.sample(u);
            assert!(c <= 1.0 && c > previous, "{phase:?} at u = {u}: {c} after {previous}");
            // Between two samples lies 1/64 of the light: P at the middle bounds nothing, its integral does.
            let share = interval_integral(&phase, previous, c);
            assert!((share - 1.0 / 64.0).abs() < 3e-7, "{phase:?} at u = {u}: {share}");
            previous = c;
        }
    }
}

/// ∫P dω between two cosines by Simpson's rule on 20000 steps, graded towards both ends of the interval.
fn interval_integral(phase: &PhaseFunction, low: f64, high: f64) -> f64 {
    const STEPS: i32 = 20_000;
    let h = 1.0 / f64::from(STEPS);
    // cos θ = low + (high - low) s³(10 - 15 s + 6 s²) crowds the points where a peak may stand.
    let integrand = |i: i32| {
        let s = h * f64::from(i);
        let c = low + (high - low) * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        phase.value(c.clamp(-1.0, 1.0)) * 30.0 * s * s * (1.0 - s) * (1.0 - s)
    };
    let weight = |i: i32| if i == 0 || i == STEPS { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    2.0 * PI * (high - low) * (0..=STEPS).map(|i| weight(i) * integrand(i)).sum::<f64>() * h / 3.0
}

#[test]
fn an_impossible_parameter_is_refused_by_name() {
    let refused = [
        (PhaseFunction::HenyeyGreenstein { g: 1.0 }, "g is 1; it must lie in ]-1, 1["),
        (PhaseFunction::CornetteShanks { g: f64::NAN }, "g is NaN"),
        (PhaseFunction::Schlick { k: -1.0 }, "k is -1"),
        (PhaseFunction::DoubleHenyeyGreenstein { weight: 1.1, g1: 0.5, g2: 0.5 }, "weight is 1.1"),
        (PhaseFunction::DoubleHenyeyGreenstein { weight: 0.5, g1: 0.5, g2: 2.0 }, "g2 is 2"),
        (PhaseFunction::Draine { g: 0.5, alpha: -0.1 }, "alpha is -0.1"),
        (PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 4.9 }, "droplet_diameter_um is 4.9"),
    ];
    for (phase, message) in refused {
        let error = phase.validate().unwrap_err();
        assert!(matches!(error, PhaseError::Domain { .. }) && error.to_string().contains(message), "{error}");
    }
    for phase in steep_functions() {
        phase.validate().unwrap();
    }
}
