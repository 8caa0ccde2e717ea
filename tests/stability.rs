//! Hard cases stay stable: the quick form of `cargo run --release --example stability -- --long`.

mod common;
mod hard_cases;

use common::with_renderer;
use std::path::Path;

use hard_cases::judge::{Judgement, judge, judge_picture, render};
use hard_cases::{Case, all, furnace, named, truth};
use welkin::frame::Frame;
use welkin::gpu::{DeviceRequest, Gpu};
use welkin::passes::ShaderSources;
use welkin::plan::{MultipleScattering, Quality, Settings};
use welkin::renderer::Renderer;

/// Walks of each compared pixel: a standard error of a few per cent.
const WALKS: u64 = 512;

/// What is wrong, by case.
fn complaints(case: &Case, quality: Quality, found: Judgement) -> Vec<String> {
    println!("{} at {quality}: {found:?}", case.name);
    let all = found.broken.into_iter().chain(found.missed);
    all.map(|words| format!("{} at {quality}: {words}", case.name)).collect()
}

/// What is wrong with one of the few that are held to everything.
fn complaints_of_one(renderer: &mut Renderer, case: &Case, quality: Quality) -> (Vec<String>, Frame) {
    let (found, frame) = judge(renderer, case, quality, truth::of(case, WALKS).as_ref());
    (complaints(case, quality, found), frame)
}

#[test]
fn every_hard_case_keeps_the_laws_and_comes_out_the_same_in_any_company() {
    with_renderer(|renderer| {
        let cases: Vec<_> = all().into_iter().filter(|case| !case.is_long).collect();
        let (mut wrong, mut frames) = (Vec::new(), Vec::new());
        for case in &cases {
            let (complaints, frame) = if case.is_quick {
                complaints_of_one(renderer, case, Quality::Low)
            } else {
                let (found, frame) = judge_picture(renderer, case, Quality::Low);
                (complaints(case, Quality::Low, found), frame)
            };
            wrong.extend(complaints);
            frames.push(frame);
        }
        // The other way round each picture has other neighbours to take stale tables from; the command does it for all.
        for (case, first) in cases.iter().zip(&frames).rev().step_by(3) {
            if render(renderer, case, &case.scene(), Quality::Low) != *first {
                wrong.push(format!("{}: a second picture differs", case.name));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    });
}

#[test]
fn a_few_hard_cases_hold_at_the_default_quality() {
    with_renderer(|renderer| {
        // Shaders of fog take as long to compile as those of all these.
        let few = all().into_iter().filter(|case| case.is_quick && case.scene().volumes.is_empty());
        let wrong: Vec<_> = few.flat_map(|case| complaints_of_one(renderer, &case, Quality::Medium).0).collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    });
}

#[test]
fn in_a_white_furnace_energy_is_neither_made_nor_lost() {
    with_renderer(|renderer| {
        let mut scene = named("scattering only, white ground").scene();
        let medium = Settings::of(Quality::Medium);
        let settings = Settings { multiple_scattering: MultipleScattering::SourceFunction, ..medium };
        for view in furnace::VIEWS_RAD {
            let shares = furnace::energy(renderer, &scene, settings, view);
            println!("{view:?}: {shares:?}");
            // What docs/accuracy.md finds at `medium` at the 99th percentile.
            assert!(shares.iter().all(|share| (share - 1.0).abs() < 0.014), "{view:?}: {shares:?}");
        }
        // Negative control: a ground that keeps a twentieth is noticed.
        scene.planet.ground_albedo = [0.95; 3];
        let share = furnace::energy(renderer, &scene, settings, furnace::VIEWS_RAD[2])[0];
        assert!(share < 1.0 - 0.014, "{share}");
    });
}

/// The shaders with one piece of a file's text replaced.
fn with_bug(file: &str, right: &str, wrong: &str) -> ShaderSources {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/wgsl").join(file);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(right), "'{right}' is not in {file}");
    ShaderSources::embedded().with(file, text.replace(right, wrong))
}

#[test]
fn planted_bugs_are_caught_by_name() {
    let _alone = common::alone();
    let bugs = [
        (
            "r² - R² from radii",
            with_bug(
                "geometry.wgsl",
                "let gap = (altitude_m - shell_m) * (2.0 * radius_m + shell_m + altitude_m);",
                "let gap = (radius_m + altitude_m) * (radius_m + altitude_m) - (radius_m + shell_m) * (radius_m + shell_m);",
            ),
            "camera 2 m up",
            "the ground is",
        ),
        (
            "no floor under a logarithm",
            with_bug("view_integrals.wgsl", "log(max(light, vec3<f32>(DARK)))", "log(light)"),
            "optical depth 1e6 from below",
            "radiance must be finite",
        ),
        (
            "transmittance in 16 bits",
            with_bug(
                "sky.wgsl",
                "return exp(-view_optical_depth(direction));",
                "let t = exp(-view_optical_depth(direction));
                 // Below 2^-14 half floats lie 2^-24 apart.
                 return round(t * 16777216.0) / 16777216.0;",
            ),
            "absorption only, optical depth 13",
            "transmittance is",
        ),
        (
            "a peak taken to lie ahead",
            with_bug(
                "convolution.wgsl",
                "let is_thrown_back = !quadratic && peak_side(c) < 0.0;",
                "let is_thrown_back = false;",
            ),
            "haze, g = -0.9999",
            "radiance is",
        ),
        (
            "columns that no invocation writes",
            with_bug("emission_order.wgsl", "column <= ZONAL_COUNT;", "column < min(COSINE_COUNT, ZONAL_COUNT + 1u);"),
            "air that glows, seven directions",
            "radiance must be finite",
        ),
    ];
    for (bug, shaders, name, complaint) in bugs {
        let case = named(name);
        let truth = truth::trace(&case.scene(), WALKS);
        let complaints = |shaders: ShaderSources| {
            let request = DeviceRequest { poisons_memory: true, ..DeviceRequest::default() };
            let mut renderer = Renderer::with_shaders(Gpu::new(&request).unwrap(), shaders).unwrap();
            let (found, _) = judge(&mut renderer, &case, Quality::Low, Some(&truth));
            [found.broken, found.missed].concat()
        };
        let found = complaints(shaders);
        assert!(found.iter().any(|words| words.contains(complaint)), "{name} does not catch {bug}: {found:?}");
        assert!(complaints(ShaderSources::embedded()).is_empty(), "{name} without {bug}");
    }
}
