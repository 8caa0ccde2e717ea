//! The path tracer's sky against tables that other codes made.

#[path = "reference/tables.rs"]
mod tables;

use tables::Row;
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::Effort;
use welkin::reference::probe::probe_world;

fn ray(row: &Row, altitude_m: f64) -> Ray {
    Ray {
        altitude_m,
        view_zenith_rad: row.number("vza_deg").to_radians(),
        view_azimuth_rad: row.number("rel_azimuth_deg").to_radians(),
        sun_zenith_rad: row.number("sza_deg").to_radians(),
        sun_azimuth_rad: 0.0,
    }
}

/// Answers to rows of one table, in their order. Variant and albedo of each row choose the world.
fn answers(rows: &[Row], altitude_m: impl Fn(&Row) -> f64, orders: Orders, effort: Effort) -> Vec<RayRadiance> {
    let answer = |row: &Row| {
        let variant = if row.has("variant") { row.text("variant") } else { "B" };
        let world = tables::earth(variant, row.number("ground_albedo"));
        probe_world(&world, &[ray(row, altitude_m(row))], orders, effort, 7)[0]
    };
    rows.iter().map(answer).collect()
}

fn every(name: &str, step: usize) -> Vec<Row> {
    tables::read(name).into_iter().step_by(step).collect()
}

fn z_scores(rows: &[Row], own: &[RayRadiance], total: &str, error: &str, accuracy: f64) -> Vec<f64> {
    let score = |(row, own): (&Row, &RayRadiance)| {
        let (value, own_error) = (own.radiance[row.band()], own.standard_error[row.band()]);
        let (table, table_error) = (row.number(total), row.number(error));
        let spread = (own_error.powi(2) + table_error.powi(2) + (accuracy * table).powi(2)).sqrt();
        if value == table { 0.0 } else { (value - table) / spread }
    };
    rows.iter().zip(own).map(score).collect()
}

/// The mean square of n independent scores has mean 1 and variance 2/n; rows of one sun share walks, hence the room.
fn assert_scores(scores: &[f64]) {
    let n = scores.len() as f64;
    let mean_square = scores.iter().map(|z| z * z).sum::<f64>() / n;
    assert!(mean_square < 1.0 + 5.0 * (2.0 / n).sqrt(), "mean square of {n} z-scores is {mean_square}");
    // P(|z| > 4.5) is 7e-6 a row.
    assert!(scores.iter().all(|z| z.abs() < 4.5), "{scores:?}");
}

#[test]
fn sky_from_the_ground_matches_the_table_from_noon_to_twilight() {
    let rows = every("earth_sky.csv", 41);
    let own = answers(&rows, |_| 500.0, Orders::All, Effort::RelativeError(0.02));
    let scores = z_scores(&rows, &own, "total_best", "ms_mc_stderr", 0.0);
    assert_scores(&scores);

    // Control: light scattered once only is not the sky.
    let single = answers(&rows, |_| 500.0, Orders::Single, Effort::Walks(0));
    let wrong = z_scores(&rows, &single, "total_best", "ms_mc_stderr", 0.0);
    assert!(wrong.iter().all(|z| *z < -4.5));
}

#[test]
fn views_from_any_altitude_match_the_table() {
    let rows = every("earth_views.csv", 19);
    let own = answers(&rows, |row| row.number("observer_alt_m"), Orders::All, Effort::RelativeError(0.02));
    assert_scores(&z_scores(&rows, &own, "total", "total_stderr", 5e-4));
    for (row, own) in rows.iter().zip(&own) {
        let (table, own) = (row.number("transmittance"), own.transmittance[row.band()]);
        assert!((own - table).abs() <= 2e-9, "transmittance {own} against {table}");
    }
}

#[test]
fn single_scattering_matches_the_tables_quadrature() {
    let rows = every("earth_sky.csv", 7);
    let own = answers(&rows, |_| 500.0, Orders::Single, Effort::Walks(0));
    for (row, own) in rows.iter().zip(&own) {
        let (own, table) = (own.radiance[row.band()], row.number("single_quad"));
        assert!((own - table).abs() <= 1e-5 * table, "sun at {}: {own} against {table}", row.text("sza_deg"));
    }
    // Control: a sun a thousandth of a degree away is told apart where the sky changes fastest.
    let row = rows
        .iter()
        .find(|row| row.text("sza_deg") == "94" && row.number("single_quad") > 0.0)
        .expect("a row in twilight");
    let mut moved = ray(row, 500.0);
    moved.sun_zenith_rad += 1e-3_f64.to_radians();
    let world = tables::earth(row.text("variant"), row.number("ground_albedo"));
    let own = probe_world(&world, &[moved], Orders::Single, Effort::Walks(0), 7)[0];
    assert!((own.radiance[row.band()] / row.number("single_quad") - 1.0).abs() > 1e-5);
}

#[test]
fn answers_do_not_depend_on_the_number_of_threads() {
    let rows = every("earth_sky.csv", 400);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| answers(&rows, |_| 500.0, Orders::All, Effort::Walks(640)))
    };
    assert_eq!(run(1), run(3));
}
