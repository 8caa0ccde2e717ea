//! The path tracer's sky against tables that other codes made.

#[path = "reference/tables.rs"]
mod tables;

use tables::Row;
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::Effort;
use welkin::reference::probe::{direction, probe_world};
use welkin::reference::single::first_order;
use welkin::reference::transport::optical_depth;

fn ray(row: &Row, altitude_m: f64) -> Ray {
    Ray {
        altitude_m,
        view_zenith_rad: row.number("vza_deg").to_radians(),
        view_azimuth_rad: row.number("rel_azimuth_deg").to_radians(),
        sun_zenith_rad: row.number("sza_deg").to_radians(),
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
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
fn the_ground_at_ones_feet_is_seen_in_twilight() {
    // From altitude 0 the ray has no length: it starts on the ground that it hits.
    let world = tables::earth("B", 0.3);
    let down = |altitude_m| {
        let sun_zenith_rad = 95_f64.to_radians();
        let ray = Ray {
            altitude_m,
            view_zenith_rad: 3.0,
            view_azimuth_rad: 0.0,
            sun_zenith_rad,
            sun_azimuth_rad: 0.0,
            distance_m: f64::INFINITY,
        };
        probe_world(&world, &[ray], Orders::All, Effort::RelativeError(0.02), 7)[0]
    };
    let (at_feet, above) = (down(0.0), down(0.01));
    assert_eq!(at_feet.transmittance, [1.0; 3]);
    for band in 0..3 {
        let error = at_feet.standard_error[band].hypot(above.standard_error[band]);
        assert!(at_feet.radiance[band] > 0.0);
        assert!((at_feet.radiance[band] - above.radiance[band]).abs() < 4.0 * error, "{at_feet:?} {above:?}");
    }
}

#[test]
fn optical_depth_matches_the_table_and_keeps_its_error_bound() {
    for row in tables::read("transmittance.csv") {
        let world = tables::earth(row.text("variant"), 0.0);
        let position = glam::DVec3::new(0.0, 0.0, row.number("observer_alt_m"));
        let toward = direction(row.number("view_zenith_deg").to_radians(), 0.0);
        let depth = optical_depth(&world, position, toward, f64::INFINITY, 1e-10);
        let (own, bound, table) = (depth.value[row.band()], depth.error[row.band()], row.number("optical_depth"));
        // The table's angles have 12 digits, which near the horizon moves a ray by up to 1e-9 of its depth.
        let label = format!("{} m at {}°: {own} ± {bound}, table {table}", position.z, row.text("view_zenith_deg"));
        assert!((own - table).abs() <= bound + 2e-8 * table, "{label}");
        assert!(bound <= 1e-10 * own, "{label}");
        // The rules that the walks use, without adaptation, keep their own promise.
        let fast = first_order(&world, position, toward, 0.1).transmittance[row.band()];
        assert!((fast - (-own).exp()).abs() <= 2e-7, "{label}: transmittance {fast}");
    }
    // Control: a metre of altitude is seen.
    let (world, down) = (tables::earth("B", 0.0), direction(2.0, 0.0));
    let depth = |h| optical_depth(&world, glam::DVec3::new(0.0, 0.0, h), down, f64::INFINITY, 1e-10).value[0];
    assert!((depth(500.0) / depth(501.0) - 1.0).abs() > 1e-4);
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
