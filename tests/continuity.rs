//! Nothing pops as the camera rises or the sun sinks: the critical stretches of the paths that
//! `cargo run --release --example continuity` walks from end to end, in the same steps.

mod common;
#[path = "continuity/mod.rs"]
mod paths;

use common::with_renderer;
use std::ops::Range;

use paths::{Picture, altitudes_m, evenly, pictures, scene, set_sun, with_pop, worst_of_each_step};
use welkin::plan::{Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

const STEPS: usize = 1000;

/// Pictures on a stretch of a path of a thousand steps.
fn stretch(
    renderer: &mut Renderer,
    scene: &Scene,
    positions: &[f64],
    range: Range<f64>,
    change: fn(&mut Scene, f64),
) -> Vec<Picture> {
    let chosen: Vec<f64> = positions.iter().copied().filter(|position| range.contains(position)).collect();
    assert!(chosen.len() > 12, "{} positions in {range:?}", chosen.len());
    pictures(renderer, Settings::of(Quality::Low), scene, &chosen, change)
}

fn pops(pictures: &[Picture]) -> bool {
    let worst = worst_of_each_step(pictures);
    let largest = worst.iter().max_by(|a, b| a.times.total_cmp(&b.times)).unwrap();
    println!("{largest:?}");
    worst.iter().any(paths::Worst::pops)
}

/// No stretch pops, and each would with one picture and all after it brighter by a share.
fn assert_even(pictures: &[Picture], control: f64, name: &str) {
    assert!(!pops(pictures), "{name}");
    assert!(pops(&with_pop(pictures, pictures.len() / 2, control)), "{name}: the control must be noticed");
}

#[test]
fn nothing_pops_where_the_camera_leaves_the_ground_and_the_air() {
    with_renderer(|renderer| {
        // From 58 to 70 km two kinks of the ozone pass under two nodes of rays to the ground. At 35 km the camera leaves the
        // planet's shadow; at 62 km rows of the sky view pass the limb of the ozone, which light grazes on both ways.
        // There most pixels change by a tenth in each step: only a larger pop would stand out.
        let bottom_and_top_m = [(-3.0..3.0, 0.01), (99_996.0..100_004.0, 0.01)];
        let high_m = [
            (60.0, vec![(58_000.0..70_000.0, 0.01)]),
            (-6.0, vec![(30_000.0..45_000.0, 0.01), (56_000.0..68_000.0, 0.05)]),
        ];
        for (sun_deg, high_m) in high_m {
            let scene = scene(sun_deg, 0.0);
            let positions = altitudes_m(-10.0, 1e6, scene.planet.atmosphere_height_m, STEPS);
            for (range, control) in [high_m.as_slice(), &bottom_and_top_m].concat() {
                let name = format!("sun {sun_deg} deg, {range:?} m");
                let seen = stretch(renderer, &scene, &positions, range, |scene, h| scene.camera.altitude_m = h);
                assert_even(&seen, control, &name);
            }
        }
    });
}

#[test]
fn nothing_pops_as_the_sun_sets_and_twilight_only_darkens() {
    with_renderer(|renderer| {
        let positions = evenly(90.0, -18.0, STEPS);
        // In twilight each step takes a tenth of the light: there only a larger pop would stand out.
        let stretches = [
            (2.0, 40.0..42.0, 0.01),
            (2.0, -1.0..1.0, 0.9),
            (2.0, -17.9..-16.0, 0.9),
            (400_000.0, 53.2..55.2, 0.01),
            // The edge of the planet's shadow comes into view.
            (400_000.0, 18.9..20.7, 0.01),
            (400_000.0, -1.0..1.0, 0.9),
        ];
        for (altitude_m, range, control) in stretches {
            let name = format!("{altitude_m} m, sun {range:?} deg");
            let seen = stretch(renderer, &scene(90.0, altitude_m), &positions, range, set_sun);
            assert_even(&seen, control, &name);
        }
        let twilight =
            pictures(renderer, Settings::of(Quality::Low), &scene(0.0, 2.0), &evenly(0.0, -18.0, 18), set_sun);
        let darkens = |pair: &[Picture]| pair[0].iter().zip(&pair[1]).all(|(before, after)| after < before);
        assert!(twilight.windows(2).all(darkens));
        // Negative control: dawn brightens.
        let dawn: Vec<Picture> = twilight.into_iter().rev().collect();
        assert!(!dawn.windows(2).any(darkens));
    });
}
