//! Phase functions against Mie theory: how good a table is, and how far the analytic functions are from it.

mod phase_reference;

use phase_reference::{Band, MieTable, mie_tables, root_mean_square_log_ratio};
use welkin_lut::PhaseFunction;

fn table(name: &str) -> MieTable {
    mie_tables().into_iter().find(|table| table.name == name).unwrap()
}

#[test]
fn a_mie_table_keeps_its_light_and_its_mean_cosine() {
    for table in mie_tables() {
        let phase = table.phase();
        // The forward peak of 10 µm droplets falls to a third within one step of 0.5°.
        let tolerance = if table.name.contains("reff10") { 3e-4 } else { 2e-5 };
        let integral = phase.table_integral();
        assert!((integral - 1.0).abs() < tolerance, "{}: ∫P dω = {integral}", table.name);
        let mean_cosine = table.phase_function().mean_cosine();
        assert!((mean_cosine - table.mean_cosine).abs() < tolerance, "{}: g = {mean_cosine}", table.name);
    }
}

#[test]
fn every_point_of_a_mie_table_is_on_the_curve() {
    for table in mie_tables() {
        let phase = table.phase();
        for (theta_deg, expected) in &table.points {
            let value = phase.value(theta_deg.to_radians().cos()) * phase.table_integral();
            // At 0.5° one rounding of cos θ moves the steep curve by 1e-16 · 600/4e-5 of 400.
            assert!((value / expected - 1.0).abs() < 1e-9, "{} at {theta_deg}°: {value}", table.name);
        }
    }
}

#[test]
fn the_droplet_fit_is_nearer_to_mie_theory_than_one_lobe_with_the_same_mean_cosine() {
    for table in mie_tables().iter().filter(|table| table.name.starts_with("cloud")) {
        let mie = table.phase_function();
        let error = |phase: &PhaseFunction| root_mean_square_log_ratio(phase, &mie, Band::SPHERE);
        let fit =
            error(&PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 2.0 * table.effective_radius_um });
        let lobe = error(&PhaseFunction::HenyeyGreenstein { g: table.mean_cosine });
        assert!(fit < 0.5 * lobe, "{}: {fit} against {lobe}", table.name);
    }
}

#[test]
fn the_error_measure_tells_one_droplet_size_from_another() {
    let (large, small) = (table("cloud_gamma_reff10"), table("cloud_gamma_reff5"));
    let (large, small) = (large.phase_function(), small.phase_function());
    assert_eq!(root_mean_square_log_ratio(&large, &large, Band::SPHERE), 0.0);
    assert!(root_mean_square_log_ratio(&small, &large, Band::SPHERE) > 0.05);
}
