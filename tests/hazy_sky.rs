//! How far the real-time sky is off in haze that scatters forward, against the path tracer.

mod common;
#[path = "reference/tables.rs"]
mod tables;

use std::ops::RangeInclusive;
use std::path::Path;

use tables::Row;
use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{MultipleScattering, Quality, Settings};
use welkin::probe::{Orders, Ray};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

fn ray(row: &Row) -> Ray {
    let angle = |column: &str| row.number(column).to_radians();
    Ray {
        altitude_m: row.number("altitude_m"),
        view_zenith_rad: angle("view_zenith_deg"),
        view_azimuth_rad: angle("view_azimuth_deg"),
        sun_zenith_rad: angle("sun_zenith_deg"),
        sun_azimuth_rad: angle("sun_azimuth_deg"),
        distance_m: f64::INFINITY,
    }
}

/// Zenith angles of the sun, degrees.
const DAY: RangeInclusive<f64> = 0.0..=90.0;
const TWILIGHT: RangeInclusive<f64> = 90.1..=180.0;
const HIGH_SUN: RangeInclusive<f64> = 1.0..=25.0;

/// Relative errors in per cent of a scene's rows, in ascending order.
fn errors(renderer: &mut Renderer, name: &str, settings: Settings, suns: RangeInclusive<f64>) -> Vec<f64> {
    let scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"))).unwrap();
    let belongs = |row: &Row| row.text("scene") == name && suns.contains(&row.number("sun_zenith_deg"));
    let rows: Vec<Row> = tables::read("hazy_sky.csv").into_iter().filter(belongs).collect();
    let rays: Vec<Ray> = rows.iter().map(ray).collect();
    let answers = renderer.probe(&scene, settings, &rays, Orders::All).unwrap();
    let mut errors = Vec::new();
    for (row, answer) in rows.iter().zip(answers) {
        for (found, column) in answer.radiance.iter().zip(["radiance_r", "radiance_g", "radiance_b"]) {
            errors.push(100.0 * (found / row.number(column) - 1.0).abs());
        }
    }
    errors.sort_by(f64::total_cmp);
    errors
}

/// Median and 99th percentile, %.
const HIGH_SUN_BOUNDS: [f64; 2] = [1.0, 3.5];

fn quantile(errors: &[f64], q: f64) -> f64 {
    errors[((errors.len() - 1) as f64 * q).round() as usize]
}

/// Whether median and 99th percentile stay within bounds, %.
fn within(name: &str, errors: &[f64], [median, p99]: [f64; 2]) -> bool {
    let found = [quantile(errors, 0.5), quantile(errors, 0.99)];
    println!("{name}: median {:.2} % p99 {:.2} %", found[0], found[1]);
    found[0] <= median && found[1] <= p99
}

#[test]
fn the_sky_is_right_in_haze_and_dust_by_day_and_in_twilight() {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let high = Settings::of(Quality::High);
    // By day haze is no worse than clear air may be. Dust of optical depth 0.5 is allowed five times as much: its
    // diffraction peak is as narrow as the spacing of directions.
    let hazy_day = errors(&mut renderer, "noon", high, DAY);
    assert!(within("noon, high", &hazy_day, [0.6, 3.0]));
    let hazy_twilight = errors(&mut renderer, "noon", high, TWILIGHT);
    assert!(within("noon, high, sun at 92°", &hazy_twilight, [1.0, 6.0]));
    let medium_day = errors(&mut renderer, "noon", Settings::of(Quality::Medium), DAY);
    assert!(within("noon, medium", &medium_day, [1.5, 6.0]));
    let dusty_day = errors(&mut renderer, "mars", high, DAY);
    assert!(within("mars, high", &dusty_day, [3.0, 15.0]));
    // Forward scattered light follows a sun near the zenith by the degree.
    let high_sun = errors(&mut renderer, "mars", high, HIGH_SUN);
    assert!(within("mars, high, sun near the zenith", &high_sun, HIGH_SUN_BOUNDS));
    // Negative controls: a table with few places for the sun must not do;
    let few_suns = Settings { source_size: [12, 24], ..high };
    let blurred = errors(&mut renderer, "mars", few_suns, HIGH_SUN);
    assert!(!within("mars, few suns, sun near the zenith", &blurred, HIGH_SUN_BOUNDS));
    // spherical harmonics must not do either, neither in haze nor in dust.
    let harmonics = Settings { multiple_scattering: MultipleScattering::Harmonics, ..high };
    let ringing = errors(&mut renderer, "noon", harmonics, DAY);
    assert!(!within("noon, harmonics", &ringing, [0.6, 3.0]));
    let ringing = errors(&mut renderer, "mars", harmonics, DAY);
    assert!(!within("mars, harmonics", &ringing, [3.0, 15.0]));
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
}
