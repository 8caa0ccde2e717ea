//! The horizon is a clean edge, and views into the sun, straight up and down, along the horizon and around the top of
//! the air are what the views next to them are.

mod common;
#[path = "continuity/mod.rs"]
mod paths;

use common::with_renderer;
use std::f64::consts::PI;

use paths::scene;
use welkin::plan::{Outputs, Quality, Settings};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::{self, Effort};
use welkin::renderer::Renderer;
use welkin_lut::mapping::SkyViewMapping;

const ALTITUDES_M: [f64; 5] = [2.0, 1_000.0, 10_000.0, 100_000.0, 400_000.0];
const SUNS_DEG: [f64; 3] = [60.0, 3.0, -4.0];

/// Columns of a picture half a degree high whose middle lies on the horizon: for each column and band, from above.
fn columns_across_the_horizon(renderer: &mut Renderer, sun_deg: f64, altitude_m: f64) -> Vec<Vec<f64>> {
    let mut scene = scene(sun_deg, altitude_m);
    let horizon_rad = SkyViewMapping::new(&scene.planet, altitude_m, 2).horizon_rad;
    let camera = &mut scene.camera;
    camera.direction.elevation_rad = 0.5 * PI - horizon_rad;
    camera.vertical_field_of_view_rad = 0.5_f64.to_radians();
    (camera.width, camera.height) = (3, 41);
    let frame = renderer.render(&scene, Settings::of(Quality::Medium), Outputs::default()).unwrap().frame;
    let value = |x: usize, y: usize, band: usize| f64::from(frame.radiance[3 * y + x][band]);
    (0..9).map(|i| (0..41).map(|y| value(i / 3, y, i % 3)).collect()).collect()
}

/// How far a pixel lies, at worst, outside what its neighbours lead to expect, relative: outside the neighbours
/// themselves, and outside the straight continuations of the two above and the two below it, whose distances from it are
/// second differences. An edge lies between its neighbours, the crest of a sky that brightens towards it between the
/// continuations; a line along the horizon lies outside both.
fn seam(column: &[f64]) -> f64 {
    let outside = |value: f64, a: f64, b: f64| (a.min(b) - value).max(value - a.max(b)) / value;
    let excess = |five: &[f64]| {
        let continued = outside(five[2], 2.0 * five[1] - five[0], 2.0 * five[3] - five[4]);
        continued.min(outside(five[2], five[1], five[3]))
    };
    column[12..29].windows(5).map(excess).fold(0.0, f64::max)
}

#[test]
fn no_line_runs_along_the_horizon() {
    with_renderer(|renderer| {
        for altitude_m in ALTITUDES_M {
            for sun_deg in SUNS_DEG {
                let columns = columns_across_the_horizon(renderer, sun_deg, altitude_m);
                let worst = columns.iter().map(|column| seam(column)).fold(0.0, f64::max);
                println!("{altitude_m} m, sun {sun_deg} deg: {worst:.5}");
                // Half a per cent is less than a step of an 8-bit picture.
                assert!(worst < 5e-3, "{altitude_m} m, sun {sun_deg} deg: {worst}");
                // Negative control: a line five per cent brighter, a little above the edge.
                let mut lined = columns[4].clone();
                lined[16] *= 1.05;
                assert!(seam(&lined) > 5e-3, "{altitude_m} m, sun {sun_deg} deg: the control must be noticed");
            }
        }
    });
}

/// A picture across the horizon and up to 14 degrees above it, with so much left to interpolation.
fn picture(renderer: &mut Renderer, sun_deg: f64, altitude_m: f64, lattice_tolerance: f64) -> Vec<[f32; 3]> {
    let mut scene = scene(sun_deg, altitude_m);
    let horizon_rad = SkyViewMapping::new(&scene.planet, altitude_m, 2).horizon_rad;
    let camera = &mut scene.camera;
    camera.direction.elevation_rad = 0.5 * PI - horizon_rad + 4_f64.to_radians();
    camera.vertical_field_of_view_rad = 20_f64.to_radians();
    (camera.width, camera.height) = (120, 120);
    let settings = Settings { lattice_tolerance, ..Settings::of(Quality::Low) };
    renderer.render(&scene, settings, Outputs::default()).unwrap().frame.radiance
}

/// The largest relative difference of pixels, and the share of them that differ at all.
fn differences(found: &[[f32; 3]], exact: &[[f32; 3]]) -> (f64, f64) {
    let relative = |(a, b): (&f32, &f32)| if a == b { 0.0 } else { f64::from((a / b - 1.0).abs()) };
    let pixels = found.iter().zip(exact);
    let errors: Vec<f64> = pixels.map(|(a, b)| a.iter().zip(b).map(relative).fold(0.0, f64::max)).collect();
    let differing = errors.iter().filter(|&&error| error > 0.0).count();
    (errors.iter().copied().fold(0.0, f64::max), differing as f64 / errors.len() as f64)
}

#[test]
fn what_is_interpolated_between_pixels_is_what_each_of_them_would_be() {
    let tolerance = Settings::of(Quality::Low).lattice_tolerance;
    with_renderer(|renderer| {
        let mut worst_control = 0.0_f64;
        for altitude_m in ALTITUDES_M {
            for sun_deg in SUNS_DEG {
                let exact = picture(renderer, sun_deg, altitude_m, 0.0);
                let (worst, share) = differences(&picture(renderer, sun_deg, altitude_m, tolerance), &exact);
                println!("{altitude_m} m, sun {sun_deg} deg: {worst:.5}, {share:.2} of the pixels are interpolated");
                assert!(worst < tolerance, "{altitude_m} m, sun {sun_deg} deg: {worst}");
                // From space most of the picture is black, whatever computes it.
                assert!(share > 0.4 || altitude_m > 50_000.0, "{altitude_m} m, sun {sun_deg} deg: {share}");
                let (loose, _) = differences(&picture(renderer, sun_deg, altitude_m, 0.2), &exact);
                worst_control = worst_control.max(loose);
            }
        }
        // Negative control: cells that are trusted too far show.
        assert!(worst_control > tolerance, "{worst_control}");
    });
}

/// Probes a scene under a sun from an altitude in directions (zenith angle, azimuth from the sun), rad.
fn probe(renderer: &mut Renderer, altitude_m: f64, sun_rad: f64, views: &[[f64; 2]]) -> Vec<RayRadiance> {
    let ray = |&[view_zenith_rad, view_azimuth_rad]: &[f64; 2]| Ray {
        altitude_m,
        view_zenith_rad,
        view_azimuth_rad,
        sun_zenith_rad: sun_rad,
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
    };
    let rays: Vec<Ray> = views.iter().map(ray).collect();
    renderer.probe(&scene(0.0, 0.0), Settings::of(Quality::Low), &rays, Orders::All).unwrap()
}

/// The largest relative difference between radiances, or absolute between transmittances, which go down to 1e-9.
fn difference(a: &RayRadiance, b: &RayRadiance) -> f64 {
    let radiances = a.radiance.iter().zip(&b.radiance);
    let radiance = radiances.map(|(a, b)| if a == b { 0.0 } else { (a / b - 1.0).abs() }).fold(0.0, f64::max);
    a.transmittance.iter().zip(&b.transmittance).map(|(a, b)| (a - b).abs()).fold(radiance, f64::max)
}

fn assert_equal(a: &RayRadiance, b: &RayRadiance, bound: f64, name: &str) {
    let all = a.radiance.iter().chain(&a.transmittance);
    assert!(all.clone().all(|value| value.is_finite() && *value >= 0.0), "{name}: {a:?}");
    assert!(difference(a, b) < bound, "{name}: {a:?} against {b:?}");
}

#[test]
fn special_directions_are_what_their_neighbours_are() {
    with_renderer(|renderer| {
        let sun_rad = 50_f64.to_radians();
        for altitude_m in [0.0, 2.0, 10_000.0, 99_999.0, 400_000.0] {
            let planet = scene(0.0, 0.0).planet;
            let horizon_rad = SkyViewMapping::new(&planet, altitude_m, 2).horizon_rad;
            // What is looked at, how far off its neighbour lies, and how much a ten-thousandth of a radian may change:
            // along the horizon radiance grows as the root of the angle, of which f32 leaves 3e-7 rad or 5e-4.
            let pairs = [
                ("into the sun", [sun_rad, 0.0], [sun_rad + 1e-4, 0.0], 2e-3),
                ("straight up", [0.0, 1.0], [1e-4, 2.0], 1e-3),
                ("straight down", [PI, 1.0], [PI - 1e-4, 2.0], 1e-3),
                ("along the horizon", [horizon_rad, 1.0], [horizon_rad - 1e-6, 1.0], 5e-3),
            ];
            for (name, exact, beside, bound) in pairs {
                let answers = probe(renderer, altitude_m, sun_rad, &[exact, beside]);
                assert_equal(&answers[0], &answers[1], bound, &format!("{name} from {altitude_m} m"));
            }
            // Negative control: a little further from the horizon is another radiance.
            let answers = probe(renderer, altitude_m, sun_rad, &[[horizon_rad - 1e-6, 1.0], [horizon_rad - 0.01, 1.0]]);
            assert!(difference(&answers[0], &answers[1]) > 5e-3);
        }
    });
}

#[test]
fn one_step_of_a_float_around_the_top_of_the_air_changes_nothing() {
    with_renderer(|renderer| {
        let top_m: f64 = 100_000.0;
        let f32_above = f64::from((top_m as f32).next_up());
        let altitudes_m = [top_m.next_down(), top_m, top_m.next_up(), f64::from((top_m as f32).next_down()), f32_above];
        let views = [[0.0, 0.5], [1.0, 0.5], [1.7, 0.5], [1.75, 2.0], [2.0, 0.5], [PI, 0.0]];
        for sun_deg in [40_f64, 92.0] {
            let seen: Vec<_> = altitudes_m.iter().map(|&h| probe(renderer, h, sun_deg.to_radians(), &views)).collect();
            for (altitude_m, answers) in altitudes_m.iter().zip(&seen) {
                for ((answer, at_top), view) in answers.iter().zip(&seen[1]).zip(views) {
                    // Upwards there are at most some millimetres of air, of 4e-6 of the density at the ground.
                    if view[0] < 0.5 * PI {
                        assert!(answer.radiance.iter().all(|&value| value < 1e-12), "{altitude_m}: {answer:?}");
                    } else {
                        assert_equal(answer, at_top, 1e-3, &format!("{view:?} from {altitude_m} m"));
                    }
                }
            }
        }
        // Negative control: a kilometre higher is noticed.
        let higher = probe(renderer, top_m + 1e3, 0.7, &views);
        let at_top = probe(renderer, top_m, 0.7, &views);
        assert!(difference(&higher[2], &at_top[2]) > 1e-3);
    });
}

#[test]
fn the_limb_is_right_where_the_edge_of_the_planets_shadow_runs_across_it() {
    // From just above the air, 6 degrees after sunset, light that grazed the ground is nearly out: it falls by half within a
    // degree of azimuth, and rays some 99.5 degrees from the zenith begin to meet the shadow.
    let scene = scene(-6.0, 105_600.0);
    // Half-way between columns of the table that is too coarse.
    let rays: Vec<Ray> = [56.74, 76.3]
        .into_iter()
        .flat_map(|azimuth_deg: f64| (0..10).map(move |i| (azimuth_deg, 98.6 + 0.12 * f64::from(i))))
        .map(|(azimuth_deg, zenith_deg)| Ray {
            altitude_m: 105_600.0,
            view_zenith_rad: zenith_deg.to_radians(),
            view_azimuth_rad: azimuth_deg.to_radians(),
            sun_zenith_rad: 96_f64.to_radians(),
            sun_azimuth_rad: 0.0,
            distance_m: f64::INFINITY,
        })
        .collect();
    let truth = reference::probe(&scene, &rays, Orders::Single, Effort::Walks(1), 0);
    with_renderer(|renderer| {
        let mut worst = |settings: Settings| {
            let found = renderer.probe(&scene, settings, &rays, Orders::Single).unwrap();
            let pairs =
                found.iter().zip(&truth).flat_map(|(found, truth)| found.radiance.into_iter().zip(truth.radiance));
            pairs.map(|(found, truth)| (found / truth - 1.0).abs()).fold(0.0, f64::max)
        };
        let medium = Settings::of(Quality::Medium);
        let found = worst(medium);
        assert!(found < 0.04, "{found}");
        let [columns, rows] = medium.sky_view_size;
        let coarse = worst(Settings { sky_view_size: [columns / 2, rows], ..medium });
        assert!(coarse > 0.04, "half as many columns, as by day, are too few: {coarse}");
    });
}

#[test]
fn light_that_barely_clears_the_planets_shadow_is_right_to_a_tenth_of_a_suns_width() {
    // Away from a sun 4 degrees down rays leave the shadow within the topmost 25 km of the air, and the next row of the table
    // lies in it to the end: between the two light falls to nothing.
    let views = [84.3, 84.4, 84.45, 84.5].map(|zenith_deg: f64| [zenith_deg.to_radians(), 178.5_f64.to_radians()]);
    let rays = |sun_deg: f64| {
        views.map(|[view_zenith_rad, view_azimuth_rad]| Ray {
            altitude_m: 2.0,
            view_zenith_rad,
            view_azimuth_rad,
            sun_zenith_rad: sun_deg.to_radians(),
            sun_azimuth_rad: 0.0,
            distance_m: f64::INFINITY,
        })
    };
    let scene = scene(-4.0, 2.0);
    let truth = |sun_deg| reference::probe(&scene, &rays(sun_deg), Orders::Single, Effort::Walks(1), 0);
    let (sooner, later) = (truth(93.95), truth(94.05));
    let lies_between = |found: &[RayRadiance]| {
        let all = found.iter().zip(&sooner).zip(&later);
        all.flat_map(|((found, sooner), later)| (0..3).map(move |band| (found, sooner, later, band))).all(
            |(found, sooner, later, band)| {
                later.radiance[band] < found.radiance[band] && found.radiance[band] < sooner.radiance[band]
            },
        )
    };
    with_renderer(|renderer| {
        let mut seen =
            |sun_deg| renderer.probe(&scene, Settings::of(Quality::Medium), &rays(sun_deg), Orders::Single).unwrap();
        assert!(lies_between(&seen(94.0)));
        // Negative control: a sun a fifth of its width lower.
        assert!(!lies_between(&seen(94.1)));
    });
}
