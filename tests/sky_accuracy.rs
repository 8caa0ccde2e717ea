//! How far the real-time sky is from tables that other codes made, in linear radiance, through the tables that
//! pictures are made of. The bounds are the project's promises; docs/accuracy.md has the figures themselves.

mod common;
#[path = "reference/sky.rs"]
mod sky;
#[path = "reference/tables.rs"]
mod tables;

use common::with_renderer;
use std::ops::RangeInclusive;

use sky::{Errors, answers, errors, scene};
use tables::Row;
use welkin::plan::{Quality, Settings};
use welkin::probe::{Orders, Ray};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// Bounds in per cent: median and 99th percentile up to a sun of 90°, and the 99th percentile of ranges of lower suns.
struct Bounds<'a> {
    day: [f64; 2],
    night: &'a [(RangeInclusive<f64>, f64)],
}

impl Bounds<'_> {
    fn are_kept_by(&self, name: &str, errors: &Errors) -> bool {
        let (median, p99) = (errors.quantile(0.5, 0.0..=90.0), errors.quantile(0.99, 0.0..=90.0));
        println!("{name}: sun 0-90 median {median:.3} % p99 {p99:.2} %");
        let mut kept = median <= self.day[0] && p99 <= self.day[1];
        for (sun, bound) in self.night {
            let p99 = errors.quantile(0.99, sun.clone());
            println!("  sun {sun:?}: p99 {p99:.2} %");
            kept &= p99 <= *bound;
        }
        kept
    }
}

fn as_it_is(_: &mut Scene) {}

/// The rows of the scene that the engines ship: variant B over a bright ground. A quarter of the work for the dear
/// qualities; `cargo run --release --example validate_sky` takes all rows at all qualities.
fn of_one_scene(rows: Vec<Row>) -> Vec<Row> {
    let belongs = |row: &Row| (!row.has("variant") || row.text("variant") == "B") && row.number("ground_albedo") > 0.0;
    rows.into_iter().filter(belongs).collect()
}

#[test]
fn single_scattering_is_right_from_noon_to_twilight() {
    with_renderer(|renderer| {
        let rows = tables::read("earth_sky.csv");
        let bounds = Bounds { day: [0.3, 1.5], night: &[(92.0..=92.0, 5.0), (94.0..=94.0, 5.0)] };
        let mut keeps = |name, quality, change: fn(&mut Scene)| {
            let found = answers(renderer, &rows, Settings::of(quality), Orders::Single, change);
            bounds.are_kept_by(name, &errors(&rows, &found, "single_quad"))
        };
        // At `medium` too few rows of the sky view lie under the edge of the planet's shadow to hold it by themselves.
        assert!(keeps("single, medium", Quality::Medium, as_it_is));
        assert!(keeps("single, high", Quality::High, as_it_is));
        // Negative control: air that is one per cent denser must be noticed.
        assert!(!keeps("single, denser air", Quality::High, |scene| {
            scene.medium.constituents[0].scattering_per_m.iter_mut().for_each(|b| *b *= 1.01);
        }));
    });
}

/// What a quality promises for both tables, in per cent.
struct Promise {
    quality: Quality,
    /// From 500 m, looking up: by day, at 92° and at 94°.
    sky: ([f64; 2], [f64; 2]),
    /// From the ground to orbit: by day, and from 92 to 102°.
    views: ([f64; 2], f64),
}

const PROMISES: [Promise; 4] = [
    Promise { quality: Quality::Low, sky: ([1.5, 6.0], [10.0, 20.0]), views: ([2.5, 10.0], 40.0) },
    Promise { quality: Quality::Medium, sky: ([1.5, 6.0], [10.0, 20.0]), views: ([2.5, 10.0], 40.0) },
    Promise { quality: Quality::High, sky: ([0.6, 3.0], [6.0, 12.0]), views: ([1.0, 5.0], 25.0) },
    Promise { quality: Quality::Ultra, sky: ([0.3, 1.5], [4.0, 8.0]), views: ([0.5, 3.0], 15.0) },
];

impl Promise {
    fn is_kept_from_500_m(&self, renderer: &mut Renderer, rows: &[Row], change: fn(&mut Scene)) -> bool {
        let (day, [first, second]) = self.sky;
        let bounds = Bounds { day, night: &[(92.0..=92.0, first), (94.0..=94.0, second)] };
        let found = answers(renderer, rows, Settings::of(self.quality), Orders::All, change);
        bounds.are_kept_by(&format!("{} from 500 m", self.quality), &errors(rows, &found, "total_best"))
    }

    fn is_kept_from_everywhere(&self, renderer: &mut Renderer, rows: &[Row], change: fn(&mut Scene)) -> bool {
        let (day, night) = self.views;
        let bounds = Bounds { day, night: &[(92.0..=102.0, night)] };
        let found = answers(renderer, rows, Settings::of(self.quality), Orders::All, change);
        bounds.are_kept_by(&format!("{} from everywhere", self.quality), &errors(rows, &found, "total"))
    }
}

#[test]
fn light_of_all_orders_is_right_from_noon_to_twilight_and_from_the_ground_to_orbit() {
    with_renderer(|renderer| {
        let (sky_rows, view_rows) = (tables::read("earth_sky.csv"), tables::read("earth_views.csv"));
        for promise in &PROMISES[..2] {
            assert!(promise.is_kept_from_500_m(renderer, &sky_rows, as_it_is), "{}", promise.quality);
            assert!(promise.is_kept_from_everywhere(renderer, &view_rows, as_it_is), "{}", promise.quality);
        }
        let (sky_rows, view_rows) = (of_one_scene(sky_rows), of_one_scene(view_rows));
        for promise in &PROMISES[2..] {
            assert!(promise.is_kept_from_500_m(renderer, &sky_rows, as_it_is), "{}", promise.quality);
            assert!(promise.is_kept_from_everywhere(renderer, &view_rows, as_it_is), "{}", promise.quality);
        }
        // Negative controls, of the loosest bounds: a ground that reflects a tenth more must be noticed, and haze that reaches
        // a quarter higher.
        let brighter = |scene: &mut Scene| scene.planet.ground_albedo.iter_mut().for_each(|albedo| *albedo += 0.1);
        assert!(!PROMISES[0].is_kept_from_500_m(renderer, &sky_rows, brighter));
        let deeper = |scene: &mut Scene| {
            scene.medium.constituents[1].profile = welkin_lut::DensityProfile::Exponential { scale_height_m: 1500.0 };
        };
        assert!(!PROMISES[0].is_kept_from_everywhere(renderer, &view_rows, deeper));
    });
}

/// The worst relative error of the optical depth along rays of `transmittance.csv`, where the transmittance is above
/// 1e-6. A transmittance next to 1 is an f32 that cannot tell optical depths closer than its resolution apart.
fn worst_optical_depth(renderer: &mut Renderer, rows: &[Row], change: fn(&mut Scene)) -> f64 {
    let ray = |row: &Row| Ray {
        altitude_m: row.number("observer_alt_m"),
        view_zenith_rad: row.number("view_zenith_deg").to_radians(),
        view_azimuth_rad: 0.0,
        sun_zenith_rad: 0.0,
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
    };
    let rays: Vec<Ray> = rows.iter().map(ray).collect();
    let mut worst: f64 = 0.0;
    for variant in ["A", "B"] {
        let mut scene = scene(variant, false);
        change(&mut scene);
        let found = renderer.probe(&scene, Settings::of(Quality::High), &rays, Orders::Single).unwrap();
        for (row, answer) in rows.iter().zip(found).filter(|(row, _)| row.text("variant") == variant) {
            let truth = row.number("optical_depth");
            if truth < -1e-6_f64.ln() {
                let error = (-answer.transmittance[row.band()].ln() / truth - 1.0).abs();
                worst = worst.max(error - f64::from(f32::EPSILON) / truth);
            }
        }
    }
    println!("worst optical depth: {:.3} %", 100.0 * worst);
    worst
}

#[test]
fn optical_depth_is_right_to_a_fifth_of_a_per_cent_horizon_included() {
    with_renderer(|renderer| {
        let rows = tables::read("transmittance.csv");
        assert!(worst_optical_depth(renderer, &rows, as_it_is) <= 2e-3);
        // Negative control: one per cent more ozone must be noticed.
        let more_ozone = worst_optical_depth(renderer, &rows, |scene| {
            scene.medium.constituents[2].absorption_per_m.iter_mut().for_each(|a| *a *= 1.01);
        });
        assert!(more_ozone > 2e-3);
    });
}
