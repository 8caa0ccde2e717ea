//! Homogeneous slabs: fluxes and radiances against a discrete-ordinate code, and facts that need no table.

#[path = "reference/tables.rs"]
mod tables;

use tables::Row;
use welkin::probe::Orders;
use welkin::reference::Effort;
use welkin::reference::path::{FirstOrderBy, View};
use welkin::reference::probe::run;
use welkin::reference::slab::{Exit, Side, Slab, SlabFluxes};
use welkin_lut::PhaseFunction;

fn slab(row: &Row) -> Slab {
    Slab {
        optical_thickness: row.number("tau"),
        albedo: row.number("ssa"),
        phase: tables::phase(row.text("phase")),
        mu0: row.number("mu0"),
        surface_albedo: row.number("surface_albedo"),
    }
}

/// Largest of the z-scores of reflectance, diffuse transmittance and absorption; the table is exact to 1e-7.
fn worst_score(row: &Row, own: &SlabFluxes) -> f64 {
    let score =
        |value: f64, error: f64, column: &str| (value - row.number(column)).abs() / (error.powi(2) + 1e-14).sqrt();
    [
        score(own.reflectance.value, own.reflectance.standard_error, "R_diffuse"),
        score(own.diffuse_transmittance.value, own.diffuse_transmittance.standard_error, "T_diffuse"),
        score(own.upward_at_bottom.value, own.upward_at_bottom.standard_error, "F_up_bottom"),
        score(own.absorbed.value, own.absorbed.standard_error, "absorbed"),
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

#[test]
fn fluxes_match_the_discrete_ordinate_table() {
    for row in tables::read("slab.csv").iter().step_by(9) {
        let slab = slab(row);
        let own = slab.fluxes(8_192, 3);
        let label = format!("{slab:?}: {own:?}");
        assert!((own.direct_transmittance - row.number("T_direct")).abs() <= 1e-8, "{label}");
        // P(|z| > 4.5) is 7e-6, four numbers a row.
        assert!(worst_score(row, &own) < 4.5, "{label}");
        assert!(own.reflectance.standard_error < 0.006, "{label}");
    }
}

#[test]
fn transmittance_of_thick_slabs_is_resolved_however_little_comes_through() {
    // Rows from 0.4 down to 1e-6 of the light, and two where the table's eight decimals show nothing.
    let thick = |r: &Row| r.number("tau") > 10.0;
    for row in tables::read("slab.csv").iter().filter(|r| thick(r)).step_by(7) {
        let own = slab(row).fluxes(8_192, 3).diffuse_transmittance;
        let spread = (own.standard_error.powi(2) + 1e-16).sqrt();
        let label = format!("{}: {own:?}", row.line());
        assert!((own.value - row.number("T_diffuse")).abs() < 4.5 * spread, "{label}");
        assert!(own.value > 0.0 && own.standard_error < 0.03 * own.value, "{label}");
    }
}

#[test]
fn light_deep_in_an_absorbing_slab_falls_by_the_diffusion_length() {
    // Twelve more optical depths cost e^(-12 κ), with the κ of isotropic scattering of albedo 0.9 from Case & Zweifel
    // 1967: 1 = (W / 2κ) ln((1 + κ) / (1 - κ)).
    let transmittance = |optical_thickness, albedo| {
        let slab = Slab { optical_thickness, albedo, phase: PhaseFunction::Isotropic, mu0: 1.0, surface_albedo: 0.0 };
        slab.fluxes(32_768, 1).diffuse_transmittance
    };
    let (thin, thick) = (transmittance(40.0, 0.9), transmittance(52.0, 0.9));
    assert!(thick.value < 1e-11 && thick.standard_error < 0.01 * thick.value, "{thick:?}");
    let kappa = (thin.value / thick.value).ln() / 12.0;
    let error = (thin.standard_error / thin.value).hypot(thick.standard_error / thick.value) / 12.0;
    assert!((kappa - 0.525_429_513).abs() < 4.0 * error, "{kappa} ± {error}");
    // Control: albedo 0.91 falls more slowly.
    let other = transmittance(52.0, 0.91);
    assert!(((thin.value / other.value).ln() / 12.0 - 0.525_429_513).abs() > 4.0 * error);
}

#[test]
fn an_error_asked_for_is_reached() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.85 };
    for (optical_thickness, surface_albedo) in [(0.1, 0.0), (16.0, 0.3)] {
        let slab = Slab { optical_thickness, albedo: 0.9, phase: phase.clone(), mu0: 0.5, surface_albedo };
        let own = slab.fluxes_to(0.01, 5);
        for m in [own.reflectance, own.diffuse_transmittance] {
            // The error is itself known to 9 %.
            assert!(m.standard_error < 1.3 * 0.01 * m.value, "{slab:?}: {m:?}");
        }
    }
}

#[test]
fn a_slab_that_absorbs_one_per_cent_more_is_told_apart() {
    let rows = tables::read("slab.csv");
    let row =
        rows.iter().find(|r| r.text("tau") == "4" && r.text("ssa") == "0.9" && r.text("mu0") == "1").expect("a row");
    let mut wrong = slab(row);
    wrong.albedo *= 0.99;
    assert!(worst_score(row, &wrong.fluxes(200_000, 3)) > 4.5);
}

#[test]
fn van_de_hulsts_slab_reflects_and_transmits_what_his_tables_say() {
    // Multiple Light Scattering (1980): τ 2, albedo 0.9, g 0.75, perpendicular light, black surface.
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.75 };
    let slab = Slab { optical_thickness: 2.0, albedo: 0.9, phase, mu0: 1.0, surface_albedo: 0.0 };
    let own = slab.fluxes(400_000, 1);
    let transmitted = own.diffuse_transmittance.value + own.direct_transmittance;
    assert!((own.reflectance.value - 0.09739).abs() < 3.0 * own.reflectance.standard_error + 5e-6, "{own:?}");
    assert!((transmitted - 0.66096).abs() < 3.0 * own.diffuse_transmittance.standard_error + 5e-6, "{own:?}");
    assert!(own.reflectance.standard_error < 2e-4);
}

#[test]
fn light_is_neither_lost_nor_made() {
    for tau in [1e-3, 0.3, 1.0, 100.0] {
        for albedo in [0.0, 0.5, 0.99, 1.0] {
            for surface_albedo in [0.0, 0.6, 1.0] {
                let phase = PhaseFunction::HenyeyGreenstein { g: 0.6 };
                let slab = Slab { optical_thickness: tau, albedo, phase, mu0: 0.4, surface_albedo };
                let fluxes = slab.fluxes(2_000, 9);
                let balance = fluxes.balance;
                assert!((balance.value - 1.0).abs() <= 4.0 * balance.standard_error + 1e-12, "{slab:?}: {balance:?}");
                // Control: what the slab absorbs is missed where it absorbs.
                if tau > 0.1 && albedo < 0.9 {
                    let without = balance.value - fluxes.absorbed.value;
                    assert!((without - 1.0).abs() > 4.0 * balance.standard_error, "{slab:?}: {without}");
                }
            }
        }
    }
}

#[test]
fn a_purely_absorbing_slab_obeys_beers_law() {
    let slab = |tau| Slab {
        optical_thickness: tau,
        albedo: 0.0,
        phase: PhaseFunction::Isotropic,
        mu0: 0.7,
        surface_albedo: 0.0,
    };
    for tau in [1e-3, 1.0, 30.0] {
        let own = slab(tau).fluxes(64, 1);
        assert_eq!((own.reflectance.value, own.diffuse_transmittance.value), (0.0, 0.0));
        assert!((own.absorbed.value - (1.0 - (-tau / 0.7).exp())).abs() < 1e-14);
        let thicker = slab(1.0001 * tau).fluxes(64, 1);
        assert!(tau > 10.0 || (own.absorbed.value - thicker.absorbed.value).abs() > 1e-14, "a hair thicker is seen");
    }
}

#[test]
fn radiances_by_the_path_tracer_match_the_discrete_ordinate_table() {
    let rows: Vec<Row> = tables::read("slab_radiance.csv").into_iter().filter(|r| r.number("tau") < 10.0).collect();
    let mean_square = |albedo_factor: f64| {
        let scores = radiance_scores(&rows, albedo_factor);
        (scores.iter().map(|z| z * z).sum::<f64>() / scores.len() as f64, scores)
    };
    let (own, scores) = mean_square(1.0);
    let most = 1.0 + 5.0 * (2.0 / scores.len() as f64).sqrt();
    assert!(own < most, "{own}: {scores:?}");
    assert!(scores.iter().all(|z| z.abs() < 4.5), "{scores:?}");
    // Control: slabs that absorb a tenth more are told apart.
    assert!(mean_square(0.9).0 > most);
}

#[test]
fn radiances_of_thick_slabs_match_the_discrete_ordinate_table_at_both_sides() {
    let rows: Vec<Row> = tables::read("slab_radiance.csv").into_iter().filter(|r| r.number("tau") > 10.0).collect();
    let scores = |albedo_factor: f64| -> Vec<f64> {
        let spread = rows.iter().enumerate().step_by(47);
        let score = |(i, row): (usize, &Row)| {
            let slab = Slab {
                optical_thickness: row.number("tau"),
                albedo: albedo_factor * row.number("ssa"),
                phase: tables::phase(row.text("phase")),
                mu0: row.number("mu0"),
                surface_albedo: 0.0,
            };
            let side = if row.text("side") == "top_up" { Side::Top } else { Side::Bottom };
            let azimuth_rad = row.number("rel_azimuth_deg").to_radians();
            let own =
                slab.radiance_to(&Exit { side, mu: row.number("mu_view"), azimuth_rad }, 0.02, 5 << 32 | i as u64);
            let table = row.number("radiance");
            assert!(own.standard_error < 0.03 * own.value, "{slab:?} {side:?}: {own:?}");
            (own.value - table) / (own.standard_error.powi(2) + (1e-3 * table).powi(2)).sqrt()
        };
        spread.map(score).collect()
    };
    let own = scores(1.0);
    assert!(own.iter().all(|z| z.abs() < 4.5), "{own:?}");
    // Control: what gets through tells of an albedo that is a hundredth smaller.
    assert!(scores(0.99).iter().any(|z| z.abs() > 4.5));
}

fn radiance_scores(rows: &[Row], albedo_factor: f64) -> Vec<f64> {
    let mut scores = Vec::new();
    for (i, row) in rows.iter().enumerate().step_by(31) {
        let phase = tables::phase(row.text("phase"));
        let world =
            tables::slab_world(row.number("tau"), albedo_factor * row.number("ssa"), phase, row.number("mu0"), 0.0);
        let (position, direction) = tables::slab_ray(row);
        let view = View::new(&world, position, direction, FirstOrderBy::Quadrature);
        let estimate = run(&view, Effort::Walks(8_192), Orders::All, 5, i as u64);
        let table = row.number("radiance");
        // 1e-3 at worst is what the table claims.
        let spread = (estimate.total_error[0].powi(2) + (1e-3 * table).powi(2)).sqrt();
        scores.push((estimate.mean.total()[0] - table) / spread);
    }
    scores
}

#[test]
fn reflected_radiance_is_reciprocal() {
    // Swapping the directions of light and view leaves radiance over the light's flux through the top unchanged.
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.7 };
    let reflected = |mu0: f64, mu_view: f64| {
        let world = tables::slab_world(3.0, 0.95, phase.clone(), mu0, 0.4);
        let direction = glam::DVec3::new(0.0, -(1.0 - mu_view * mu_view).sqrt(), -mu_view);
        let view = View::new(&world, glam::DVec3::new(0.0, 0.0, 1.0), direction, FirstOrderBy::Quadrature);
        let estimate = run(&view, Effort::Walks(65_536), Orders::All, 5, 0);
        (estimate.mean.total()[0] / mu0, estimate.total_error[0] / mu0)
    };
    let ((one, one_error), (other, other_error)) = (reflected(0.3, 0.9), reflected(0.9, 0.3));
    let spread = (one_error * one_error + other_error * other_error).sqrt();
    assert!((one - other).abs() < 4.0 * spread, "{one} and {other} ± {spread}");
    // Control: without the fluxes' cosines the two are far apart.
    assert!((0.3 * one - 0.9 * other).abs() > 20.0 * spread);
}
