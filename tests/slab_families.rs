//! The course notes' families on slabs, against a discrete-ordinate code of others: how far each is off, and in which order.

#[path = "reference/tables.rs"]
mod tables;

use welkin::reference::slab::Slab;
use welkin::reference::slab::families::{Closure, DiscreteOrdinates, Fluxes, SingleScattering, SlabMethod, TwoStream};
use welkin_lut::PhaseFunction;

fn slabs() -> Vec<(Slab, Fluxes, String)> {
    let of = |row: &tables::Row| {
        let slab = Slab {
            optical_thickness: row.number("tau"),
            albedo: row.number("ssa"),
            phase: tables::phase(row.text("phase")),
            mu0: row.number("mu0"),
            surface_albedo: row.number("surface_albedo"),
        };
        let fluxes = Fluxes { reflectance: row.number("R_diffuse"), diffuse_transmittance: row.number("T_diffuse") };
        (slab, fluxes, row.line())
    };
    tables::read("slab.csv").iter().map(of).collect()
}

/// The larger of both differences, as a fraction of the beam's flux.
fn difference(a: &Fluxes, b: &Fluxes) -> f64 {
    (a.reflectance - b.reflectance).abs().max((a.diffuse_transmittance - b.diffuse_transmittance).abs())
}

/// Root mean square of the differences over every so many rows of the table.
fn error(method: &impl SlabMethod, every: usize) -> f64 {
    let rows = slabs();
    let squares = rows.iter().step_by(every).map(|(slab, truth, _)| difference(&method.fluxes(slab), truth).powi(2));
    let squares: Vec<f64> = squares.collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn thirty_two_ordinates_agree_with_the_other_code() {
    for (slab, truth, line) in slabs().iter().step_by(5) {
        let own = DiscreteOrdinates { streams: 16 }.fluxes(slab);
        assert!(difference(&own, truth) < 1e-4, "{line}: {own:?}");
    }
    // Four would not have done.
    assert!(error(&DiscreteOrdinates { streams: 2 }, 5) > 1e-3);
}

#[test]
fn each_family_is_nearer_to_the_truth_than_the_one_before() {
    let two_stream = |closure, delta| error(&TwoStream { closure, delta }, 1);
    let single = error(&SingleScattering, 1);
    for closure in [Closure::Quadrature, Closure::Eddington] {
        assert!(two_stream(closure, false) < 0.5 * single, "{closure:?}");
        assert!(two_stream(closure, true) < two_stream(closure, false), "{closure:?}");
        assert!(error(&DiscreteOrdinates { streams: 4 }, 3) < 0.2 * two_stream(closure, true), "{closure:?}");
    }
    assert!(error(&DiscreteOrdinates { streams: 8 }, 5) < error(&DiscreteOrdinates { streams: 4 }, 5));
}

#[test]
fn light_that_nothing_absorbs_comes_out() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.85 };
    for optical_thickness in [0.1, 2.0, 64.0] {
        let slab = Slab { optical_thickness, albedo: 1.0, phase: phase.clone(), mu0: 0.6, surface_albedo: 0.0 };
        let balance = |method: &dyn SlabMethod| {
            let fluxes = method.fluxes(&slab);
            fluxes.reflectance + fluxes.diffuse_transmittance + (-optical_thickness / slab.mu0).exp() - 1.0
        };
        for closure in [Closure::Quadrature, Closure::Eddington] {
            for delta in [false, true] {
                // The share of 1e-9 that is absorbed to keep the formulas finite, in 64 optical depths crossed many times.
                let method = TwoStream { closure, delta };
                assert!(balance(&method).abs() < 1e-6, "{} {optical_thickness}: {}", method.name(), balance(&method));
            }
        }
        assert!(balance(&DiscreteOrdinates { streams: 8 }).abs() < 1e-7, "{optical_thickness}");
        // Of one scattering a thick slab loses nearly all.
        assert!(optical_thickness < 1.0 || balance(&SingleScattering) < -0.3);
    }
}

#[test]
fn in_thin_slabs_all_light_is_scattered_once() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.5 };
    let slab = |optical_thickness| Slab {
        optical_thickness,
        albedo: 0.9,
        phase: phase.clone(),
        mu0: 0.7,
        surface_albedo: 0.0,
    };
    let off = |thickness| {
        let (once, all) =
            (SingleScattering.fluxes(&slab(thickness)), DiscreteOrdinates { streams: 16 }.fluxes(&slab(thickness)));
        difference(&once, &all) / all.reflectance
    };
    // Light scattered twice is of the order of the thickness times its logarithm.
    assert!(off(1e-3) < 0.02 && off(1.0) > 0.2, "{} {}", off(1e-3), off(1.0));
}
