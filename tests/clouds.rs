//! Clouds in scene files, and as the reference sees them.

use std::path::Path;

use glam::DVec3;
use welkin::reference::path::{Budget, FirstOrderBy, View};
use welkin::reference::{World, transport};
use welkin::scene::{EnvironmentLight, Light, Scene, SceneError};
use welkin_lut::cloud::{CloudKind, CloudLayer};

const CLEAR: &str = "
preset = \"earth\"
sun = { elevation_deg = 40, azimuth_deg = 100 }
camera = { altitude_m = 2, elevation_deg = 10, azimuth_deg = 0, width = 8, height = 8 }
";

fn parse(clouds: &str) -> Result<Scene, SceneError> {
    Scene::parse(&format!("{CLEAR}{clouds}"), Path::new("clouds.toml"))
}

fn refusal(clouds: &str) -> String {
    parse(clouds).unwrap_err().to_string()
}

#[test]
fn a_kind_alone_is_a_whole_layer_and_every_field_can_be_changed() {
    let scene = parse("[[clouds]]\nkind = \"cumulus\"\n").unwrap();
    assert_eq!(scene.clouds, [CloudLayer::of_kind(CloudKind::Cumulus)]);
    let text = "[[clouds]]\nname = \"low\"\nkind = \"stratus\"\nbase_m = 200\ntop_m = 450\ncoverage = 1\n\
        water_g_per_m3 = 0.4\neffective_radius_um = 6\nalbedo = 0.9\nphase.henyey_greenstein.g = 0.8\n\
        wind_m_per_s = [5, -2]\nevolution_m_per_s = 0.5\nseed = 7\n";
    let scene = parse(text).unwrap();
    let layer = &scene.clouds[0];
    assert_eq!((layer.base_m, layer.top_m, layer.coverage, layer.seed), (200.0, 450.0, 1.0, 7));
    // 3 LWC / (2 rho r) by hand.
    assert!((layer.extinction_per_m() - 0.1).abs() < 1e-12);
    // A base that is moved alone takes the thickness with it.
    let raised = &parse("[[clouds]]\nkind = \"cumulus\"\nbase_m = 3000\n").unwrap().clouds[0];
    let typical = CloudLayer::of_kind(CloudKind::Cumulus);
    assert_eq!(raised.top_m - 3000.0, typical.top_m - typical.base_m);
}

#[test]
fn impossible_layers_are_refused_where_they_stand() {
    let upside_down = refusal("[[clouds]]\nkind = \"cumulus\"\nbase_m = 2000\ntop_m = 1500\n");
    assert!(upside_down.contains("clouds.toml:8:9: clouds[0].top_m") && upside_down.contains("1500"), "{upside_down}");
    assert!(refusal("[[clouds]]\nkind = \"fluffy\"\n").contains("unknown variant `fluffy`"));
    assert!(refusal("[[clouds]]\nkind = \"cirrus\"\nbase_m = 2e5\n").contains("the air's top"));
    let twice = refusal("[[clouds]]\nkind = \"cirrus\"\n[[clouds]]\nkind = \"cirrus\"\n");
    assert!(twice.contains("clouds[1].kind") && twice.contains("expected a name that no other"), "{twice}");
    // A layer without thickness is possible, and empty.
    assert!(parse("[[clouds]]\nkind = \"cirrus\"\nbase_m = 9000\ntop_m = 9000\n").unwrap().clouds[0].is_empty());
}

/// Clouds of one kind in vacuum under a sky of radiance 1.
fn under_uniform_sky(kind: CloudKind, dilution: f64, albedo: f64, ground_albedo: f64) -> World {
    let mut scene = parse(&format!("[[clouds]]\nkind = \"{}\"\n", kind.name())).unwrap();
    scene.clouds[0].albedo = [albedo; 3];
    scene.clouds[0].water_g_per_m3 *= dilution;
    scene.medium.constituents.clear();
    scene.planet.ground_albedo = [ground_albedo; 3];
    scene.lights = vec![Light::Environment(EnvironmentLight { radiance: [1.0; 3] })];
    World::from_scene(&scene)
}

/// Mean and standard error of one band over some rays that leave upwards.
fn seen(world: &World, directions: &[DVec3]) -> Vec<[f64; 2]> {
    let budget = |stream| Budget { batches: 16, walks_per_batch: 64, seed: 1, stream, first_batch: 0 };
    let estimate = |(i, d): (usize, &DVec3)| {
        let view = View::new(world, DVec3::new(0.0, 0.0, 2.0), *d, FirstOrderBy::Walks);
        let found = view.estimate(&budget(i as u64));
        [found.mean.total()[1], found.total_error[1]]
    };
    directions.iter().enumerate().map(estimate).collect()
}

fn upward(count: usize) -> Vec<DVec3> {
    let angle = |i: usize| (0.3 + 1.1 * i as f64 / count as f64, 2.4 * i as f64);
    (0..count)
        .map(angle)
        .map(|(zenith, turn)| DVec3::new(zenith.sin() * turn.cos(), zenith.sin() * turn.sin(), zenith.cos()))
        .collect()
}

#[test]
fn walks_through_clouds_that_only_absorb_find_the_transmittance_that_quadrature_finds() {
    // Diluted until many walks pass, or enriched until many do not.
    for (kind, dilution) in [(CloudKind::Stratocumulus, 0.1), (CloudKind::Cirrus, 50.0)] {
        let world = under_uniform_sky(kind, dilution, 0.0, 0.0);
        let directions = upward(12);
        let (mut worst, mut darkest) = (0.0_f64, 1.0_f64);
        for (d, [mean, error]) in directions.iter().zip(seen(&world, &directions)) {
            let transmittance = transport::transmittance(&world, DVec3::new(0.0, 0.0, 2.0), *d)[1];
            darkest = darkest.min(transmittance);
            worst = worst.max((mean - transmittance).abs() - 4.0 * error);
        }
        // Four standard errors over a dozen rays; a ray that no walk left has none.
        assert!(worst <= 5e-3, "{kind:?}: off by {worst} beyond four standard errors");
        assert!(darkest < 0.9, "{kind:?}: no ray meets a cloud");
    }
}

#[test]
fn in_a_white_furnace_clouds_are_invisible() {
    let directions = upward(4);
    let white = seen(&under_uniform_sky(CloudKind::Stratocumulus, 0.1, 1.0, 1.0), &directions);
    assert!(white.iter().all(|[mean, error]| (mean - 1.0).abs() <= 4.0 * error + 1e-9), "{white:?}");
    // Negative control: droplets that absorb a twentieth are seen.
    let grey = seen(&under_uniform_sky(CloudKind::Stratocumulus, 0.1, 0.95, 1.0), &directions);
    assert!(grey.iter().any(|[mean, error]| 1.0 - mean > 4.0 * error), "{grey:?}");
}
