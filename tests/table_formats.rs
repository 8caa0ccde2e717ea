//! Tables of half floats beside tables of 32-bit floats.

mod common;

use std::path::Path;

use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Outputs, Quality, Settings, TableFormat};
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// By day, up to the horizon and down to the ground.
fn rays() -> Vec<Ray> {
    let mut rays = Vec::new();
    for altitude_m in [2.0, 20_000.0] {
        for view_zenith_deg in [0.0_f64, 45.0, 80.0, 89.0, 100.0, 140.0] {
            for sun_zenith_deg in [20.0_f64, 75.0] {
                rays.push(Ray {
                    altitude_m,
                    view_zenith_rad: view_zenith_deg.to_radians(),
                    view_azimuth_rad: 1.0,
                    sun_zenith_rad: sun_zenith_deg.to_radians(),
                    sun_azimuth_rad: 0.0,
                    distance_m: f64::INFINITY,
                });
            }
        }
    }
    rays
}

/// The largest relative difference of a band.
fn worst(a: &[RayRadiance], b: &[RayRadiance]) -> f64 {
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.radiance.into_iter().zip(b.radiance));
    pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn half_floats_take_half_the_memory_and_change_daylight_by_less_than_half_a_per_cent() {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/noon.toml");
    let scene = Scene::read(&path).unwrap();
    let wide = Settings::of(Quality::Low);
    let half = Settings { table_format: TableFormat::Float16, ..wide };
    let probe = |renderer: &mut Renderer, settings| renderer.probe(&scene, settings, &rays(), Orders::All).unwrap();
    let exact = probe(&mut renderer, wide);
    let rounded = probe(&mut renderer, half);
    let difference = worst(&rounded, &exact);
    println!("half floats: {:.3} %", 100.0 * difference);
    // Logarithms between -4 and 4 are rounded by up to 2^-10, three tables in a row.
    assert!(difference < 5e-3, "{difference}");
    // Negative control: the formats differ, so the tables are not the same.
    assert!(difference > 1e-5, "{difference}");

    let bytes = |settings| {
        let plan = Renderer::plan(&scene, settings, Outputs::default()).unwrap();
        let table = |name| plan.passes.iter().find(|pass| pass.name == name).unwrap().bytes;
        ["optical_depth", "higher_source", "sky_view"].map(table)
    };
    assert_eq!(bytes(half).map(|bytes| 2 * bytes), bytes(wide));

    // A device that can interpolate nothing wider gets half floats, whatever the settings say.
    renderer.limit_tables(TableFormat::Float16);
    assert_eq!(probe(&mut renderer, wide), rounded);
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
}
