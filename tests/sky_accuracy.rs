//! How far the real-time sky is from tables that other codes made, in linear radiance, through the tables that
//! pictures are made of. The bounds are the project's promises; docs/accuracy.md has the figures themselves.

mod common;
#[path = "reference/tables.rs"]
mod tables;

use std::path::Path;

use tables::Row;
use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Quality, Settings};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// Relative errors in per cent with the sun's zenith angle of each, in degrees.
struct Errors(Vec<(f64, f64)>);

impl Errors {
    fn quantile(&self, q: f64, sun: std::ops::RangeInclusive<f64>) -> f64 {
        let mut errors: Vec<f64> =
            self.0.iter().filter(|(sza, _)| sun.contains(sza)).map(|(_, error)| *error).collect();
        errors.sort_by(f64::total_cmp);
        errors[((errors.len() - 1) as f64 * q).round() as usize]
    }

    /// Whether median and 99th percentile up to a sun of 90°, and the 99th percentile at each lower sun, keep a bound.
    fn keep(&self, name: &str, day: [f64; 2], night: &[(std::ops::RangeInclusive<f64>, f64)]) -> bool {
        let (median, p99) = (self.quantile(0.5, 0.0..=90.0), self.quantile(0.99, 0.0..=90.0));
        println!("{name}: sun 0-90 median {median:.3} % p99 {p99:.2} %");
        let mut kept = median <= day[0] && p99 <= day[1];
        for (sun, bound) in night {
            let p99 = self.quantile(0.99, sun.clone());
            println!("  sun {sun:?}: p99 {p99:.2} %");
            kept &= p99 <= *bound;
        }
        kept
    }
}

fn scene(variant: &str, ground_albedo: &str) -> Scene {
    let file = format!("scenes/reference/earth-{}-{ground_albedo}.toml", variant.to_lowercase());
    Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap()
}

fn renderer() -> Renderer {
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    Renderer::new(&request).unwrap()
}

fn ray(row: &Row) -> Ray {
    Ray {
        altitude_m: if row.has("observer_alt_m") { row.number("observer_alt_m") } else { 500.0 },
        view_zenith_rad: row.number("vza_deg").to_radians(),
        view_azimuth_rad: row.number("rel_azimuth_deg").to_radians(),
        sun_zenith_rad: row.number("sza_deg").to_radians(),
        sun_azimuth_rad: 0.0,
    }
}

/// Answers to all rows of a table, after a change to each scene.
fn answers(rows: &[Row], quality: Quality, orders: Orders, change: impl Fn(&mut Scene)) -> Vec<RayRadiance> {
    let mut renderer = renderer();
    let mut answers: Vec<Option<RayRadiance>> = vec![None; rows.len()];
    for variant in ["A", "B"] {
        for albedo in ["0", "0.3"] {
            let belongs = |row: &Row| {
                let row_variant = if row.has("variant") { row.text("variant") } else { "B" };
                row_variant == variant && row.number("ground_albedo") == albedo.parse::<f64>().unwrap()
            };
            let indices: Vec<usize> = (0..rows.len()).filter(|&i| belongs(&rows[i])).collect();
            if indices.is_empty() {
                continue;
            }
            let rays: Vec<Ray> = indices.iter().map(|&i| ray(&rows[i])).collect();
            let mut scene = scene(variant, albedo);
            change(&mut scene);
            let found = renderer.probe(&scene, Settings::of(quality), &rays, orders).unwrap();
            indices.into_iter().zip(found).for_each(|(i, answer)| answers[i] = Some(answer));
        }
    }
    let log = renderer.gpu().validation_log();
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    answers.into_iter().map(|answer| answer.expect("every row belongs to one scene")).collect()
}

/// Errors against a column; rows in which nothing shines are left out.
fn errors(rows: &[Row], answers: &[RayRadiance], column: &str) -> Errors {
    let error = |(row, answer): (&Row, &RayRadiance)| {
        let truth = row.number(column);
        let error = 100.0 * (answer.radiance[row.band()] / truth - 1.0).abs();
        (truth > 0.0).then_some((row.number("sza_deg"), error))
    };
    Errors(rows.iter().zip(answers).filter_map(error).collect())
}

const TWILIGHT: [std::ops::RangeInclusive<f64>; 2] = [92.0..=92.0, 94.0..=94.0];

#[test]
fn single_scattering_is_right_from_noon_to_twilight() {
    let _alone = common::alone();
    let rows = tables::read("earth_sky.csv");
    let bounds = |errors: Errors| {
        errors.keep("single, high", [0.3, 1.5], &[(TWILIGHT[0].clone(), 5.0), (TWILIGHT[1].clone(), 5.0)])
    };
    let single = |change: fn(&mut Scene)| answers(&rows, Quality::High, Orders::Single, change);
    assert!(bounds(errors(&rows, &single(|_| {}), "single_quad")));
    // Negative control: air that is one per cent denser must be noticed.
    let denser = single(|scene| scene.medium.constituents[0].scattering_per_m.iter_mut().for_each(|b| *b *= 1.01));
    assert!(!bounds(errors(&rows, &denser, "single_quad")));
}

#[test]
fn light_of_all_orders_is_right_from_noon_to_twilight_at_every_quality() {
    let _alone = common::alone();
    let rows = tables::read("earth_sky.csv");
    let total =
        |quality, change: fn(&mut Scene)| errors(&rows, &answers(&rows, quality, Orders::All, change), "total_best");
    let night = |first, second| [(TWILIGHT[0].clone(), first), (TWILIGHT[1].clone(), second)];
    assert!(total(Quality::Low, |_| {}).keep("low", [1.0, 6.0], &night(10.0, 20.0)));
    assert!(total(Quality::Medium, |_| {}).keep("medium", [1.5, 6.0], &night(10.0, 20.0)));
    assert!(total(Quality::High, |_| {}).keep("high", [0.6, 3.0], &night(6.0, 12.0)));
    assert!(total(Quality::Ultra, |_| {}).keep("ultra", [0.3, 1.5], &night(4.0, 8.0)));
    // Negative control: a ground that reflects a tenth more must be noticed at the quality that promises most.
    let brighter =
        total(Quality::Ultra, |scene| scene.planet.ground_albedo.iter_mut().for_each(|albedo| *albedo += 0.1));
    assert!(!brighter.keep("ultra, brighter ground", [0.3, 1.5], &night(4.0, 8.0)));
}

#[test]
fn every_altitude_and_direction_is_right_from_the_ground_to_orbit() {
    let _alone = common::alone();
    let rows = tables::read("earth_views.csv");
    let total = |quality, change: fn(&mut Scene)| errors(&rows, &answers(&rows, quality, Orders::All, change), "total");
    let night = |bound| [(92.0..=102.0, bound)];
    assert!(total(Quality::Medium, |_| {}).keep("medium", [2.5, 10.0], &night(40.0)));
    assert!(total(Quality::High, |_| {}).keep("high", [1.0, 5.0], &night(25.0)));
    assert!(total(Quality::Ultra, |_| {}).keep("ultra", [0.5, 3.0], &night(15.0)));
    // Negative control: haze that reaches a tenth higher must be noticed.
    let higher = total(Quality::Ultra, |scene| {
        scene.medium.constituents[1].profile = welkin_lut::DensityProfile::Exponential { scale_height_m: 1320.0 };
    });
    assert!(!higher.keep("ultra, higher haze", [0.5, 3.0], &night(15.0)));
}

#[test]
fn optical_depth_is_right_to_a_fifth_of_a_per_cent_horizon_included() {
    let _alone = common::alone();
    let rows = tables::read("transmittance.csv");
    let rays: Vec<Ray> = rows
        .iter()
        .map(|row| Ray {
            altitude_m: row.number("observer_alt_m"),
            view_zenith_rad: row.number("view_zenith_deg").to_radians(),
            view_azimuth_rad: 0.0,
            sun_zenith_rad: 0.0,
            sun_azimuth_rad: 0.0,
        })
        .collect();
    let mut renderer = renderer();
    let mut worst = |change: fn(&mut Scene)| -> f64 {
        let mut worst: f64 = 0.0;
        for variant in ["A", "B"] {
            let mut scene = scene(variant, "0");
            change(&mut scene);
            let answers = renderer.probe(&scene, Settings::of(Quality::High), &rays, Orders::Single).unwrap();
            for (row, answer) in rows.iter().zip(answers).filter(|(row, _)| row.text("variant") == variant) {
                let truth = row.number("optical_depth");
                if truth > -1e-6_f64.ln() {
                    continue;
                }
                let error = (-answer.transmittance[row.band()].ln() / truth - 1.0).abs();
                // A transmittance next to 1 is an f32 that cannot tell optical depths closer than this apart.
                let resolution = f64::from(f32::EPSILON) / truth;
                if error - resolution > worst {
                    worst = error - resolution;
                    println!(
                        "{variant}: {} m, {}°: {:.4} %",
                        row.text("observer_alt_m"),
                        row.text("view_zenith_deg"),
                        100.0 * error
                    );
                }
            }
        }
        worst
    };
    assert!(worst(|_| {}) <= 2e-3);
    // Negative control: half a per cent more ozone must be noticed.
    assert!(worst(|scene| scene.medium.constituents[2].absorption_per_m.iter_mut().for_each(|a| *a *= 1.05)) > 2e-3);
}
