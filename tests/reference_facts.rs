//! Facts that every solution of the light transport equation obeys, and agreement of the solvers where they must agree.

#[path = "reference/tables.rs"]
mod tables;

use std::sync::Arc;

use glam::{DVec3, UVec3};
use welkin::probe::Orders;
use welkin::reference::attenuation::diffuse_attenuation;
use welkin::reference::marching::March;
use welkin::reference::path::{Budget, Estimate, FirstOrderBy, View};
use welkin::reference::probe::{direction, run};
use welkin::reference::single::first_order;
use welkin::reference::transport::{opacity, optical_depth};
use welkin::reference::{Body, Effort, Emitter, GridField, Matter, Shape, World};
use welkin_lut::{Bands, Constituent, DensityProfile, PhaseFunction};

const CUBE: Shape = Shape::Box { min_m: DVec3::ZERO, max_m: DVec3::ONE };

/// A cube of one metre filled evenly.
fn even_cube(extinction_per_m: Bands, albedo: f64, phase: PhaseFunction) -> World {
    let constituent = Constituent {
        name: "filling".into(),
        scattering_per_m: extinction_per_m.map(|c| c * albedo),
        absorption_per_m: extinction_per_m.map(|c| c * (1.0 - albedo)),
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Layer { bottom_m: 0.0, top_m: 1.0 },
        phase,
    };
    World::stratified(CUBE, [0.0; 3], &[constituent])
}

/// The same cube filled by a density grid; `sample` gives the density of each voxel by its number.
fn grid_cube(extinction: f64, albedo: f64, phase: PhaseFunction, sample: impl Fn(u32) -> f64) -> World {
    let size = UVec3::new(12, 10, 8);
    let samples = (0..12 * 10 * 8).map(sample).collect();
    let field = Arc::new(GridField::new(DVec3::ZERO, DVec3::ONE, size, samples).expect("a grid"));
    let matter = Matter {
        scattering_per_m: [extinction * albedo; 3],
        extinction_per_m: [extinction; 3],
        emission_per_m: [0.0; 3],
        phase,
    };
    let mut world = World::stratified(CUBE, [0.0; 3], &[]);
    world.bodies = Arc::new([Body { matter: [matter], field }]);
    world
}

fn patchy(voxel: u32) -> f64 {
    f64::from((voxel * 2_654_435) % 97) / 97.0
}

fn sky(world: &mut World) {
    world.lights.push(Emitter::Environment { radiance: [1.0; 3] });
}

fn sun(world: &mut World) {
    let toward = DVec3::new(0.3, -0.5, 0.9).normalize();
    world.lights.push(Emitter::Beam { toward, irradiance: [1.0; 3] });
}

/// A ray from outside through the middle of the cube.
fn through() -> (DVec3, DVec3) {
    let d = DVec3::new(0.8, 0.5, -0.3).normalize();
    (DVec3::new(0.55, 0.5, 0.45) - d * 3.0, d)
}

fn trace(world: &World, by: FirstOrderBy, walks: u64) -> Estimate {
    let (p, d) = through();
    View::new(world, p, d, by).estimate(&budget(walks))
}

fn budget(walks: u64) -> Budget {
    Budget { batches: 64, walks_per_batch: walks.div_ceil(64), seed: 3, stream: 0, first_batch: 0 }
}

fn assert_equal(a: f64, b: f64, standard_error: f64, label: &str) {
    // P(|z| > 4) is 6e-5.
    assert!((a - b).abs() <= 4.0 * standard_error + 1e-9 * b.abs(), "{label}: {a} and {b} ± {standard_error}");
}

#[test]
fn a_white_furnace_shows_nothing_of_what_is_in_it() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.8 };
    for extinction in [1e-3, 0.1, 10.0, 1e3] {
        let mut world = even_cube([extinction; 3], 1.0, phase.clone());
        sky(&mut world);
        let walks = if extinction > 100.0 { 256 } else { 4096 };
        let estimate = trace(&world, FirstOrderBy::Walks, walks);
        assert_equal(estimate.mean.total()[0], 1.0, estimate.total_error[0], &format!("{extinction} per metre"));
        assert!(estimate.total_error[0] < 0.05);
    }
    let mut world = grid_cube(20.0, 1.0, phase.clone(), patchy);
    sky(&mut world);
    let estimate = trace(&world, FirstOrderBy::Walks, 4096);
    assert_equal(estimate.mean.total()[0], 1.0, estimate.total_error[0], "grid");
    // Control: an albedo of 0.99 is seen.
    let mut grey = grid_cube(20.0, 0.99, phase, patchy);
    sky(&mut grey);
    let estimate = trace(&grey, FirstOrderBy::Walks, 4096);
    assert!(1.0 - estimate.mean.total()[0] > 4.0 * estimate.total_error[0]);
}

#[test]
fn walks_that_look_for_the_sun_find_the_light_of_sharp_forward_scattering_with_less_noise() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.95 };
    // Walks in stratified matter wait for chance to bring them near the sun.
    let (mut blind, mut looking) =
        (even_cube([4.0; 3], 1.0, phase.clone()), grid_cube(4.0, 1.0, phase.clone(), |_| 1.0));
    let mut grey = grid_cube(4.0, 0.97, phase, |_| 1.0);
    for world in [&mut blind, &mut looking, &mut grey] {
        sun(world);
    }
    let [blind, looking, grey] = [&blind, &looking, &grey].map(|world| trace(world, FirstOrderBy::Walks, 1 << 16));
    let error = blind.total_error[0].hypot(looking.total_error[0]);
    assert_equal(looking.mean.total()[0], blind.mean.total()[0], error, "one light, two ways");
    assert!(looking.total_error[0] < 0.5 * blind.total_error[0], "{looking:?} {blind:?}");
    // Control: a little absorption is seen.
    let error = grey.total_error[0].hypot(looking.total_error[0]);
    assert!(looking.mean.total()[0] - grey.mean.total()[0] > 4.0 * error, "{grey:?}");
}

#[test]
fn a_planet_that_absorbs_nothing_is_invisible_in_uniform_light() {
    let mut world = tables::earth("B", 1.0);
    let air = Constituent {
        name: "air".into(),
        scattering_per_m: [5.802e-6, 13.558e-6, 33.1e-6],
        absorption_per_m: [0.0; 3],
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Exponential { scale_height_m: 8000.0 },
        phase: PhaseFunction::Rayleigh,
    };
    world = World::stratified(world.shape, [1.0; 3], &[air]);
    sky(&mut world);
    for (altitude_m, zenith_deg) in [(0.0, 30.0), (2.0, 89.9), (500.0, 95.0), (50_000.0, 97.0), (400_000.0, 109.0)] {
        let position = DVec3::new(0.0, 0.0, altitude_m);
        let view = View::new(&world, position, direction(f64::to_radians(zenith_deg), 0.4), FirstOrderBy::Quadrature);
        let estimate = run(&view, Effort::Walks(4096), Orders::All, 1, 0);
        for band in 0..3 {
            let label = format!("from {altitude_m} m at {zenith_deg}°");
            assert_equal(estimate.mean.total()[band], 1.0, estimate.total_error[band], &label);
        }
    }
    // Control: with haze and ozone it is seen.
    let mut hazy = tables::earth("B", 1.0);
    hazy.lights.clear();
    sky(&mut hazy);
    let view = View::new(&hazy, DVec3::new(0.0, 0.0, 2.0), direction(1.5, 0.4), FirstOrderBy::Quadrature);
    let estimate = run(&view, Effort::Walks(4096), Orders::All, 1, 0);
    assert!(1.0 - estimate.mean.total()[1] > 4.0 * estimate.total_error[1]);
}

#[test]
fn a_grid_without_scattering_obeys_beers_law() {
    let mut world = grid_cube(3.0, 0.0, PhaseFunction::Isotropic, patchy);
    sky(&mut world);
    let (p, d) = through();
    let depth = optical_depth(&world, p, d, f64::INFINITY, 1e-8).value;
    let estimate = trace(&world, FirstOrderBy::Walks, 65_536);
    assert_equal(1.0 - estimate.mean.total()[0], opacity(depth)[0], estimate.total_error[0], "opacity");
    assert!((1.0 - estimate.mean.total()[0] - opacity([1.05 * depth[0]; 3])[0]).abs() > 4.0 * estimate.total_error[0]);
}

#[test]
fn an_even_grid_scatters_like_an_even_filling() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.6 };
    let (mut even, mut grid) = (even_cube([4.0; 3], 0.95, phase.clone()), grid_cube(4.0, 0.95, phase, |_| 1.0));
    sun(&mut even);
    sun(&mut grid);
    let (a, b) = (trace(&even, FirstOrderBy::Quadrature, 65_536), trace(&grid, FirstOrderBy::Walks, 65_536));
    let error = a.total_error[0].hypot(b.total_error[0]);
    assert_equal(a.mean.total()[0], b.mean.total()[0], error, "all orders");
    assert!(error < 0.02 * a.mean.total()[0]);
    // Control: a filling that absorbs a tenth more is told apart.
    let mut darker = grid_cube(4.0, 0.85, PhaseFunction::HenyeyGreenstein { g: 0.6 }, |_| 1.0);
    sun(&mut darker);
    let c = trace(&darker, FirstOrderBy::Walks, 65_536);
    assert!((a.mean.total()[0] - c.mean.total()[0]).abs() > 4.0 * a.total_error[0].hypot(c.total_error[0]));
}

#[test]
fn order_one_of_the_walks_is_what_quadrature_finds() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.6 };
    let mut lamp = grid_cube(6.0, 0.9, phase.clone(), patchy);
    lamp.lights.push(Emitter::Point { position_m: DVec3::new(0.2, 1.6, 1.2), intensity: [1.0; 3], cone: None });
    let mut beam = grid_cube(6.0, 0.9, phase, patchy);
    sun(&mut beam);
    let (p, d) = through();
    for world in [lamp, beam] {
        let exact = first_order(&world, p, d, 1e-5);
        let walked = trace(&world, FirstOrderBy::Walks, 65_536);
        assert_equal(walked.mean.single[0], exact.single.value[0], walked.single_error[0], "grid");
        assert!(walked.single_error[0] < 0.02 * exact.single.value[0]);
        // Control: all orders together are not order 1.
        assert!(walked.mean.total()[0] - exact.single.value[0] > 4.0 * walked.total_error[0]);
    }
    let earth = tables::earth("A", 0.3).with_sun(direction(1.4, 0.0));
    let position = DVec3::new(0.0, 0.0, 500.0);
    let view = View::new(&earth, position, direction(1.2, 0.5), FirstOrderBy::Walks);
    let walked = run(&view, Effort::Walks(131_072), Orders::Single, 1, 0);
    let exact = first_order(&earth, position, direction(1.2, 0.5), 1e-7);
    for band in 0..3 {
        assert_equal(walked.mean.single[band], exact.single.value[band], walked.single_error[band], "sky");
        assert!(walked.single_error[band] < 0.02 * exact.single.value[band]);
    }
}

#[test]
fn a_small_disc_lights_like_a_beam() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.6 };
    let mut beam = even_cube([4.0; 3], 0.95, phase.clone());
    sun(&mut beam);
    let toward = beam.sun().expect("a sun");
    for limb_exponent in [[0.0; 3], [0.41, 0.51, 0.64]] {
        let mut disc = even_cube([4.0; 3], 0.95, phase.clone());
        disc.lights.push(Emitter::Disc { toward, irradiance: [1.0; 3], radius_rad: 0.01, limb_exponent, sphere: None });
        let (a, b) = (trace(&beam, FirstOrderBy::Walks, 65_536), trace(&disc, FirstOrderBy::Walks, 65_536));
        let error = a.total_error[0].hypot(b.total_error[0]);
        assert_equal(a.mean.total()[0], b.mean.total()[0], error, "disc");
        assert!(error < 0.02 * a.mean.total()[0]);
        // Control: a disc that stands elsewhere lights otherwise.
        let turned = disc.with_sun(DVec3::new(0.8, -0.5, 0.3).normalize());
        let c = trace(&turned, FirstOrderBy::Walks, 65_536);
        assert!((a.mean.total()[0] - c.mean.total()[0]).abs() > 4.0 * a.total_error[0].hypot(c.total_error[0]));
    }
}

#[test]
fn bands_that_share_walks_keep_their_own_radiance_however_different_they_are() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.4 };
    let extinctions = [0.1, 2.0, 50.0];
    let world = |extinction| {
        let mut world = even_cube(extinction, 0.9, phase.clone());
        sun(&mut world);
        world
    };
    let together = trace(&world(extinctions), FirstOrderBy::Walks, 65_536);
    for (band, extinction) in extinctions.into_iter().enumerate() {
        let alone = trace(&world([extinction; 3]), FirstOrderBy::Walks, 65_536);
        let error = together.total_error[band].hypot(alone.total_error[band]);
        assert_equal(together.mean.total()[band], alone.mean.total()[band], error, &format!("{extinction} per metre"));
        assert!(error < 0.1 * alone.mean.total()[band]);
        // Control: the next band's radiance is another one.
        let next = (band + 1) % 3;
        let difference = (together.mean.total()[next] - alone.mean.total()[band]).abs();
        assert!(difference > 4.0 * together.total_error[next].hypot(alone.total_error[band]));
    }
}

#[test]
fn ray_marching_tends_to_the_path_tracers_orders() {
    let mut world = even_cube([0.8; 3], 0.9, PhaseFunction::HenyeyGreenstein { g: 0.3 });
    sun(&mut world);
    let (p, d) = through();
    let march = |depth, fewest_steps, repeats| {
        let march = March { directions: 4, depth, step_optical_depth: 0.2, fewest_steps };
        march.radiance(&world, p, d, repeats, 1)
    };
    let orders = trace(&world, FirstOrderBy::Quadrature, 65_536);
    let first = march(0, 40, 2).radiance[0];
    assert!((first / orders.mean.orders[1][0] - 1.0).abs() < 1e-3, "order 1");
    assert!((march(0, 4, 2).radiance[0] - first).abs() > 1e-4 * first, "coarse steps are told from fine ones");
    let second = march(1, 12, 64);
    let expected = orders.mean.orders[1][0] + orders.mean.orders[2][0];
    // Twelve steps leave an error of the steps beside the noise.
    let spread = second.standard_error[0].hypot(orders.total_error[0]) + 1e-3 * expected;
    assert_equal(second.radiance[0], expected, spread, "orders 1 and 2");
    assert!(second.radiance[0] - first > 4.0 * spread, "the second order is seen");
}

#[test]
fn what_glows_and_weakens_nothing_is_found_by_walks() {
    // A cube that glows, seen through its middle: emission times length.
    let emission = 0.3;
    let mut world = grid_cube(0.0, 0.0, PhaseFunction::Isotropic, |_| 1.0);
    let matter = world.bodies[0].matter[0].clone();
    let field = world.bodies[0].field.clone();
    world.bodies = Arc::new([Body { matter: [Matter { emission_per_m: [emission; 3], ..matter }], field }]);
    let (position, direction) = (DVec3::new(0.5, 0.5, -1.0), DVec3::Z);
    let seen = View::new(&world, position, direction, FirstOrderBy::Walks).estimate(&budget(20_000));
    assert_equal(seen.mean.total()[1], emission, seen.total_error[1], "through a cube");
    // A shell over ground of albedo A: along each direction the ground sees emission times the length between two spheres.
    let (radius_m, albedo, shell_m) = (6.36e6, 0.4, [5e4, 5.1e4]);
    let layer = Constituent {
        name: "glow".into(),
        scattering_per_m: [0.0; 3],
        absorption_per_m: [0.0; 3],
        emission_per_m: [emission; 3],
        profile: DensityProfile::Layer { bottom_m: shell_m[0], top_m: shell_m[1] },
        phase: PhaseFunction::Isotropic,
    };
    let world = World::stratified(Shape::Sphere { radius_m, height_m: 1e5 }, [albedo; 3], &[layer]);
    let (position, direction) = (DVec3::new(0.0, 0.0, 1.0), -DVec3::Z);
    let ground = View::new(&world, position, direction, FirstOrderBy::Walks).estimate(&budget(40_000));
    // The integral of cos times the length to a shell at h over cosines: ((R + h)^3 - (h (2 R + h))^1.5) / (3 R^2).
    let below = |h: f64| ((radius_m + h).powi(3) - (h * (2.0 * radius_m + h)).powf(1.5)) / (3.0 * radius_m * radius_m);
    let truth = 2.0 * albedo * emission * (below(shell_m[1]) - below(shell_m[0]));
    assert!(ground.total_error[1] < 0.02 * truth, "{truth} ± {}", ground.total_error[1]);
    assert_equal(ground.mean.total()[1], truth, ground.total_error[1], "the ground");
}

#[test]
fn diffuse_attenuation_is_beers_law_in_absorbers_and_the_diffusion_length_in_deep_scatterers() {
    let layer = |albedo| {
        let mut world = tables::slab_world(30.0, albedo, PhaseFunction::Isotropic, 0.6, 0.0);
        world.shape = Shape::Plane { height_m: 1.0 };
        world
    };
    let absorbing = diffuse_attenuation(&layer(0.0), 0.9, 0.8, 64, 1);
    assert!((absorbing.per_m[0] - 30.0 / 0.6).abs() < 1e-6, "{absorbing:?}");
    // The asymptotic κ of isotropic scattering solves 1 = (W / 2κ) ln((1 + κ) / (1 - κ)): 0.52543 for W = 0.9
    // (Case & Zweifel 1967), in units of c.
    let deep = diffuse_attenuation(&layer(0.9), 0.8, 0.7, 65_536, 1);
    let expected = 30.0 * 0.525_43;
    assert!((deep.per_m[0] - expected).abs() < 4.0 * deep.standard_error[0], "{deep:?} against {expected}");
    assert!(deep.standard_error[0] < 0.05 * expected);
}
