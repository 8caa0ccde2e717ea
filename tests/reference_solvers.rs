//! The solvers by name, on the command line and in the library, and single scattering under discs.

#[path = "reference/tables.rs"]
mod tables;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use glam::DVec3;
use tempfile::TempDir;
use welkin::output::read_exr_with_header;
use welkin::probe::Orders;
use welkin::reference::disc::first_order_with_discs;
use welkin::reference::marching::March;
use welkin::reference::path::{FirstOrderBy, View};
use welkin::reference::probe::{direction, run};
use welkin::reference::single::first_order;
use welkin::reference::{Effort, Emitter, World};
use welkin::scene::Scene;
use welkin_lut::{Constituent, DensityProfile, PhaseFunction};

const SCENE: &str = "preset = \"earth\"\n[sun]\nelevation_deg = 10\nazimuth_deg = 90\n\
                     [camera]\naltitude_m = 2\nelevation_deg = 5\nazimuth_deg = 70\nwidth = 6\nheight = 4\n";
const RAYS: &str = "altitude_m,view_zenith_deg,view_azimuth_deg,sun_zenith_deg,sun_azimuth_deg\n\
                    500,30,0,60,0\n500,80,0,88,120\n";

fn desk() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::write(folder.path().join("rays.csv"), RAYS).unwrap();
    folder
}

fn welkin(folder: &TempDir, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_welkin"));
    command.current_dir(folder.path()).args(arguments.split_whitespace()).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Green radiance and its standard error for each ray, and what the program says.
fn probe(folder: &TempDir, options: &str) -> (Vec<(f64, f64)>, String) {
    let command = "probe scene.toml --rays rays.csv --out out.csv --backend reference";
    let output = welkin(folder, &format!("{command} {options}"));
    assert!(output.status.success(), "{options}: {}", stderr(&output));
    let text = fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let cell = |line: &str, at: usize| line.split(',').nth(at).unwrap().parse().unwrap();
    let rows = text.lines().skip(1).map(|line| (cell(line, 6), cell(line, 12))).collect();
    (rows, stderr(&output))
}

#[test]
fn each_solver_answers_under_its_name_and_they_agree_where_they_must() {
    let folder = desk();
    fs::write(
        folder.path().join("scene.toml"),
        SCENE.replace("azimuth_deg = 90", "azimuth_deg = 90\nangular_radius_deg = 0"),
    )
    .unwrap();
    let (path, said) = probe(&folder, "--samples 16384");
    assert!(said.contains("solver: path: unbiased path tracer"), "{said}");
    let (order_one, _) = probe(&folder, "--orders single");
    let (single, said) = probe(&folder, "--solver single");
    assert!(said.contains("solver: single: quadrature"), "{said}");
    let (marching, said) =
        probe(&folder, "--solver marching --march-depth 0 --march-steps 400 --march-step-depth 0.05 --samples 4");
    assert!(said.contains("depth 0, steps of optical depth 0.05 and at least 400 of them"), "{said}");
    let (deeper, _) = probe(&folder, "--solver marching --march-directions 8 --samples 32");
    for ray in 0..2 {
        // Both rays go to space, so that order 1 is all that arrives after one event, in every solver.
        assert_eq!(single[ray], (order_one[ray].0, 0.0));
        let (marched, noise) = marching[ray];
        assert!((marched / single[ray].0 - 1.0).abs() < 2e-3, "{marched} ± {noise} and {}", single[ray].0);
        // Control: the second order is light too, and all orders are more than two.
        let (two, noise) = deeper[ray];
        assert!(two > single[ray].0 + 4.0 * noise && two < path[ray].0 + 4.0 * noise, "{two} ± {noise}");
        assert!(path[ray].0 - single[ray].0 > 20.0 * path[ray].1);
    }
}

#[test]
fn options_that_make_no_sense_for_a_solver_are_refused() {
    let folder = desk();
    let glow = "[medium.airglow]\nemission_per_m = 1e-9\n";
    fs::write(folder.path().join("glow.toml"), format!("{SCENE}{glow}")).unwrap();
    let all_around = "[light.environment]\nradiance = 0.1\n";
    fs::write(folder.path().join("open.toml"), format!("{SCENE}{all_around}")).unwrap();
    let probe = "probe scene.toml --rays rays.csv --out out.csv";
    let cases = [
        (format!("{probe} --solver single"), "--solver says nothing to the gpu backend"),
        (format!("{probe} --backend reference --march-depth 2"), "--march-depth says nothing to the path solver"),
        (
            format!("{probe} --backend reference --solver single --samples 9"),
            "--samples says nothing to the single solver",
        ),
        (format!("{probe} --backend reference --solver marching --orders single"), "does not tell orders apart"),
        (format!("{probe} --backend reference --solver quick"), "single, marching, path"),
        (format!("{probe} --backend reference --solver marching --march-step-depth 0"), "]0, ∞["),
        (
            "reference scene.toml -o out.exr --solver single --max-error 0.1".into(),
            "--max-error says nothing to the single solver",
        ),
        ("reference open.toml -o out.exr --solver single".into(), "light 2 of the scene shines from all around"),
        ("reference glow.toml -o out.exr --solver single".into(), "gives off light"),
    ];
    for (arguments, said) in cases {
        let output = welkin(&folder, &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments}: {}", stderr(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4, "something was left behind");
}

#[test]
fn a_picture_says_which_solver_made_it_and_parts_of_two_solvers_do_not_merge() {
    let folder = desk();
    let parts = [("one.exr", "1/2", "--solver single"), ("two.exr", "2/2", "--solver single"), ("path.exr", "2/2", "")];
    for (file, shard, solver) in parts {
        let output = welkin(&folder, &format!("reference scene.toml -o {file} --shard {shard} {solver}"));
        assert!(output.status.success(), "{}", stderr(&output));
        let name = if solver.is_empty() { "path: " } else { "single: " };
        let (_, header) = read_exr_with_header(&folder.path().join(file)).unwrap();
        assert!(header.text("solver").unwrap().starts_with(name));
        assert!(stderr(&output).contains(&format!("solver: {name}")));
    }
    let mixed = welkin(&folder, "merge one.exr path.exr -o out.exr");
    assert_eq!(mixed.status.code(), Some(2));
    assert!(stderr(&mixed).contains("it is of solver path"), "{}", stderr(&mixed));
    let whole = welkin(&folder, "merge two.exr one.exr -o out.exr");
    assert!(whole.status.success(), "{}", stderr(&whole));
    let (frame, _) = read_exr_with_header(&folder.path().join("out.exr")).unwrap();
    assert!(frame.standard_error.unwrap().iter().flatten().all(|&error| error == 0.0), "quadrature draws nothing");
    assert!(frame.radiance.iter().flatten().all(|&radiance| radiance > 0.0));
}

fn earth_under(sun: Emitter) -> World {
    let mut world = tables::earth("B", 0.3);
    world.lights = vec![sun];
    world
}

fn disc(toward: DVec3, radius_rad: f64) -> Emitter {
    Emitter::Disc { toward, irradiance: [1.0; 3], radius_rad, limb_exponent: [0.3, 0.5, 0.7], sphere: None }
}

#[test]
fn single_scattering_under_a_disc_by_quadrature_is_what_walks_find() {
    // Sun's zenith angle, view's zenith angle and azimuth from it, angular radius: beside the disc, before a sun that is
    // half set, in twilight, towards the ground.
    let cases = [(60.0, 57.0, 0.0, 0.04), (90.0, 85.0, 10.0, 0.03), (94.0, 80.0, 0.0, 0.03), (70.0, 100.0, 60.0, 0.03)];
    for (sun_deg, view_deg, azimuth_deg, radius_rad) in cases {
        let at = |zenith: f64, azimuth: f64| direction(zenith.to_radians(), azimuth.to_radians());
        let (position, view) = (DVec3::new(0.0, 0.0, 500.0), at(view_deg, azimuth_deg));
        let world = earth_under(disc(at(sun_deg, 0.0), radius_rad));
        let exact = first_order_with_discs(&world, position, view, 1e-5).single;
        let ray = View::new(&world, position, view, FirstOrderBy::Quadrature);
        let walked = run(&ray, Effort::Walks(65_536), Orders::Single, 1, 0);
        let beside = earth_under(disc(at(sun_deg + 1.0, 0.0), radius_rad));
        let beside = first_order_with_discs(&beside, position, view, 1e-5).single;
        for band in 0..3 {
            let (value, noise) = (walked.mean.single[band], walked.single_error[band]);
            let label = format!("sun {sun_deg}°, view {view_deg}°, band {band}: {exact:?} and {value} ± {noise}");
            assert!((exact.value[band] - value).abs() < 4.0 * noise + exact.error[band], "{label}");
            assert!(noise < 0.02 * value && exact.error[band] < 1e-3 * value, "{label}");
            // Control: a disc one degree away is told apart.
            assert!((beside.value[band] - value).abs() > 4.0 * noise, "{label}");
        }
    }
}

#[test]
fn single_scattering_through_a_cloud_by_quadrature_is_what_walks_find() {
    let scene = |albedo: f64| {
        let text = format!(
            "preset = \"earth\"\n[[clouds]]\nkind = \"cumulus\"\nalbedo = {albedo}\n\
             [sun]\nelevation_deg = 50\nazimuth_deg = 60\nangular_radius_deg = 0\n\
             [camera]\naltitude_m = 2\nelevation_deg = 0\nazimuth_deg = 0\n"
        );
        World::from_scene(&Scene::parse(&text, Path::new("cloud.toml")).unwrap())
    };
    let (cloudy, darker) = (scene(1.0), scene(0.3));
    // Through a thin edge and into a bright side.
    for (zenith_deg, azimuth_deg) in [(40.0, 0.0), (50.0, 0.0)] {
        let position = DVec3::new(0.0, 0.0, 2.0);
        let view = direction(f64::to_radians(zenith_deg), f64::to_radians(azimuth_deg));
        let exact = first_order(&cloudy, position, view, 1e-3).single;
        let other = first_order(&darker, position, view, 1e-3).single;
        let ray = View::new(&cloudy, position, view, FirstOrderBy::Walks);
        let walked = run(&ray, Effort::Walks(8192), Orders::Single, 1, 0);
        for band in 0..3 {
            let (value, noise) = (walked.mean.single[band], walked.single_error[band]);
            let label = format!("{zenith_deg}°, band {band}: {exact:?} and {value} ± {noise}");
            assert!((exact.value[band] - value).abs() < 4.0 * noise + exact.error[band], "{label}");
            assert!(noise < 0.03 * value && exact.error[band] < 5e-3 * value, "{label}");
            // Control: water that absorbs most of it is told apart.
            assert!((other.value[band] - value).abs() > 4.0 * noise + other.error[band], "{label}");
        }
    }
}

#[test]
fn a_disc_tends_to_a_beam_with_the_square_of_its_radius() {
    let toward = direction(1.0, 0.0);
    let (position, view) = (DVec3::new(0.0, 0.0, 500.0), direction(0.8, 0.3));
    let beam = earth_under(Emitter::Beam { toward, irradiance: [1.0; 3] });
    let beam = first_order(&beam, position, view, 1e-10).single.value[1];
    let off = |radius| first_order_with_discs(&earth_under(disc(toward, radius)), position, view, 1e-10);
    let off = |radius| off(radius).single.value[1] / beam - 1.0;
    let ratio = off(0.02) / off(0.01);
    assert!((ratio - 4.0).abs() < 0.05, "{ratio}");
}

#[test]
fn ray_marching_gathers_the_light_of_surroundings_and_of_matter_at_every_order() {
    // In a thin slab, with a depth of 1.
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.3 };
    let mut open = tables::slab_world(0.5, 0.9, phase.clone(), 0.5, 0.0);
    open.lights = vec![Emitter::Environment { radiance: [1.0; 3] }];
    let glowing = Constituent {
        name: "slab".into(),
        scattering_per_m: [0.45; 3],
        absorption_per_m: [0.05; 3],
        emission_per_m: [0.2; 3],
        profile: DensityProfile::Layer { bottom_m: 0.0, top_m: 1.0 },
        phase,
    };
    // A lamp's light is scattered once more than the depth, for its first scattering takes no direction; emitted light is not.
    marching_has_the_orders_of_walks(&open, 2);
    marching_has_the_orders_of_walks(&World::stratified(open.shape, [0.0; 3], &[glowing]), 1);
}

fn marching_has_the_orders_of_walks(world: &World, last: usize) {
    let (p, d) = (DVec3::new(0.0, 0.0, 0.0), DVec3::new(0.6, 0.0, 0.8));
    let march = March { directions: 8, depth: 1, step_optical_depth: 0.05, fewest_steps: 16 };
    let marched = march.estimate(world, p, d, Effort::Walks(64), (1, 0));
    let walked = run(&View::new(world, p, d, FirstOrderBy::Quadrature), Effort::Walks(65_536), Orders::All, 1, 0);
    let expected: f64 = (0..=last).map(|order| walked.mean.orders[order][0]).sum();
    let spread = marched.standard_error[0].hypot(walked.total_error[0]) + 2e-3 * expected;
    assert!((marched.radiance[0] - expected).abs() < 4.0 * spread, "{marched:?} and {expected} ± {spread}");
    // Control: without the last order it would be another number.
    assert!(walked.mean.orders[last][0] > 4.0 * spread);
}
