//! What the plan leaves out does not show, and what it leaves out is not in the shaders.

mod common;
mod stripped;

use std::f64::consts::PI;
use std::path::Path;

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use welkin::gpu::DeviceRequest;
use welkin::passes::definitions;
use welkin::plan::{CloudSettings, Decision, Directions, Facts, Outputs, Quality, Settings, Skipping, SourceGrid};
use welkin::probe::Orders;
use welkin::reference::World;
use welkin::reference::probe::direction;
use welkin::reference::single::first_order;
use welkin::renderer::Renderer;
use welkin::scene::{Effect, Light, Scene};
use welkin_shaders::{Definition, Shader, Sources};

/// A hundredth of what the darkest night sky sends, W·m⁻²·sr⁻¹·nm⁻¹: 2e-4 cd/m² are some 1e-9.
const DARKNESS: f64 = 1e-11;

const CAPTURE: Outputs = Outputs { capture: true, picture: false };

fn scene(name: &str) -> Scene {
    Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"))).unwrap()
}

/// Two lights of any brightness, width and place around the horizon, seen from anywhere between the ground and space.
fn random_scene(random: &mut Pcg64Mcg) -> Scene {
    let mut uniform = |low: f64, high: f64| low + (high - low) * f64::from(random.next_u32()) * 0.5_f64.powi(32);
    let mut scene = scene("noon");
    (scene.camera.width, scene.camera.height) = (8, 6);
    scene.camera.altitude_m = 10_f64.powf(uniform(0.0, 6.0));
    scene.camera.direction.elevation_rad = uniform(-0.6, 0.6);
    scene.camera.direction.azimuth_rad = uniform(0.0, 6.2);
    let Light::Directional(sun) = scene.lights[0].clone() else { panic!("the sun is directional") };
    scene.lights = ["a", "b"]
        .map(|name| {
            let mut light = sun.clone();
            light.name = name.to_owned();
            light.direction.elevation_rad = uniform(-18.0, 20.0).to_radians();
            light.direction.azimuth_rad = uniform(0.0, 6.2);
            light.angular_radius_rad = uniform(0.0, 0.6).to_radians();
            let brightness = 10_f64.powf(uniform(-7.0, 0.0));
            light.irradiance = light.irradiance.map(|irradiance| irradiance * brightness);
            Light::Directional(light)
        })
        .into();
    scene
}

/// The largest difference of a pixel that leaving out by these rules makes, relative to the pixel, over so many scenes, and
/// how many scenes' plans they change.
fn difference(renderer: &mut Renderer, skipping: Skipping, scenes: usize) -> (f64, usize) {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let (mut worst, mut changed) = (0.0_f64, 0);
    for _ in 0..scenes {
        let scene = random_scene(&mut random);
        let mut with = |skipping| {
            let settings = Settings { skipping, ..Settings::of(Quality::Low) };
            let facts = Facts::new(&scene, settings, Orders::All, CAPTURE).unwrap();
            let widths = facts.lights.iter().filter(|light| facts.is_wide(light)).count();
            let lit = (facts.lights.len(), widths);
            (renderer.render(&scene, settings, CAPTURE).unwrap().frame, lit)
        };
        let ((all, all_lit), (some, some_lit)) = (with(Skipping::NONE), with(skipping));
        changed += usize::from(all_lit != some_lit);
        for (all, some) in all.radiance.as_flattened().iter().zip(some.radiance.as_flattened()) {
            worst = worst.max(f64::from((all - some).abs()) / (f64::from(*all) + DARKNESS));
        }
    }
    (worst, changed)
}

#[test]
fn lights_and_discs_that_are_left_out_do_not_show() {
    let _alone = common::alone();
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
    // Half a per cent is what a beam in place of a disc may cost (src/plan/disc.rs); half as much again for places of the
    // sun and altitudes between those that were measured.
    let (worst, changed) = difference(&mut renderer, Skipping::USUAL, 120);
    assert!(worst < 0.0075 && changed > 50, "{worst} in {changed} scenes");
    // Controls: each rule, set wrong, is caught.
    let wrong = [
        Skipping { faint_share: 0.3, ..Skipping::USUAL },
        Skipping { beam_above_radii: -5.0, ..Skipping::USUAL },
        Skipping { narrowest_disc_rad: 0.1, ..Skipping::USUAL },
    ];
    for rules in wrong {
        let (worst, changed) = difference(&mut renderer, rules, 60);
        assert!(worst > 0.0075, "{rules:?} goes unnoticed: {worst} in {changed} scenes");
    }
}

/// Tables so small that a frame costs next to nothing; all passes are the same.
fn tiny(skipping: Skipping) -> Settings {
    let low = Settings::of(Quality::Low);
    Settings {
        nodes_per_leg: 4,
        optical_depth_size: [32, 16],
        multiple_scattering_size: [6, 4],
        directions: Directions { below: 2, band: 2, above: 2, azimuths: 2 },
        source_grid: SourceGrid { ground: 2, low: 2, high: 2, azimuths: 2 },
        source_size: [4, 4],
        source_orders: 3,
        // In haze so dense that it hides mountains, coarse froxels are off by more than the mountains.
        froxel_size: [4, 48, 32],
        clouds: CloudSettings {
            sweeps: 2,
            ordinate_cells: 16,
            grid_size: 16,
            grid_slices: 4,
            max_steps: 96,
            ..low.clouds
        },
        skipping,
        ..low
    }
}

/// A view from anywhere between the ground and space, of mountains, clouds or air that may be out of it, or deep in haze.
fn random_view(random: &mut Pcg64Mcg, effect: Option<Effect>) -> Scene {
    let mut uniform = |low: f64, high: f64| low + (high - low) * f64::from(random.next_u32()) * 0.5_f64.powi(32);
    let mut scene = scene("noon");
    (scene.camera.width, scene.camera.height) = (16, 9);
    scene.camera.vertical_field_of_view_rad = uniform(0.1, 0.9);
    scene.camera.direction.elevation_rad = uniform(-1.2, 1.2);
    scene.camera.altitude_m = match effect {
        Some(_) => 10_f64.powf(uniform(2.5, 4.5)),
        None => 10_f64.powf(uniform(4.8, 6.5)),
    };
    let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
    sun.direction.elevation_rad = uniform(-5.0, 85.0).to_radians();
    if effect == Some(Effect::Mountains) {
        let density = 10_f64.powf(uniform(-1.0, 3.0));
        for constituent in &mut scene.medium.constituents {
            constituent.scattering_per_m = constituent.scattering_per_m.map(|b| b * density);
            constituent.absorption_per_m = constituent.absorption_per_m.map(|a| a * density);
        }
    }
    effect.map_or(scene.clone(), |effect| effect.added_to(&scene))
}

/// As [`difference`], over so many views.
fn difference_in_views(
    renderers: &mut [Renderer; 2],
    effect: Option<Effect>,
    skipping: Skipping,
    views: usize,
) -> (f64, usize) {
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let (mut worst, mut changed) = (0.0_f64, 0);
    for _ in 0..views {
        let scene = random_view(&mut random, effect);
        let [all, some] = [Skipping::NONE, skipping];
        let [forced, left_out] = renderers;
        let all = forced.render(&scene, tiny(all), CAPTURE).unwrap();
        let some = left_out.render(&scene, tiny(some), CAPTURE).unwrap();
        let needed = |plan: &welkin::plan::Plan| plan.passes.iter().filter(|p| p.decision != Decision::Skip).count();
        changed += usize::from(needed(&all.timings.plan) != needed(&some.timings.plan));
        for (all, some) in all.frame.radiance.as_flattened().iter().zip(some.frame.radiance.as_flattened()) {
            worst = worst.max(f64::from((all - some).abs()) / (f64::from(*all) + DARKNESS));
        }
    }
    (worst, changed)
}

#[test]
fn what_is_out_of_the_picture_does_not_show_in_it() {
    let _alone = common::alone();
    let mut renderers = [(); 2].map(|()| Renderer::new(&DeviceRequest::default()).unwrap());
    let out_of_view = |share: f64| Skipping { out_of_view_share: share, ..Skipping::USUAL };
    let nearly_clear = Skipping { hidden_depth: 0.5, ..Skipping::USUAL };
    // Each effect, or air alone, with how many views are tried, how many must be changed, and rules that are wrong.
    let cases = [
        (None, 40, 10, vec![out_of_view(0.5)]),
        (Some(Effect::Mountains), 40, 7, vec![out_of_view(0.1), nearly_clear]),
        (Some(Effect::Clouds), 24, 3, vec![out_of_view(0.1)]),
    ];
    for (effect, views, at_least, wrong) in cases {
        let (worst, changed) = difference_in_views(&mut renderers, effect, Skipping::USUAL, views);
        assert!(worst < 0.005 && changed >= at_least, "{effect:?}: {worst} in {changed} of {views} views");
        for rules in wrong {
            let (worst, _) = difference_in_views(&mut renderers, effect, rules, views);
            assert!(worst > 0.005, "{effect:?}: {rules:?} goes unnoticed: {worst}");
        }
    }
}

#[test]
fn no_air_in_view_of_a_light_that_counts_as_unseen_is_lit() {
    let mut scene = scene("noon");
    let Light::Directional(sun) = scene.lights[0].clone() else { panic!("the sun is directional") };
    let brightest = |scene: &Scene| {
        let world = World::from_scene(scene);
        let position = glam::DVec3::new(0.0, 0.0, scene.camera.altitude_m);
        // Towards the light and away from it, closely around every horizon.
        let views = (0..50).flat_map(|i| {
            [0.0, PI].map(|turn| direction((70.0 + f64::from(i)).to_radians(), sun.direction.azimuth_rad + turn))
        });
        views.map(|view| first_order(&world, position, view, 1e-3).single.value[2]).fold(0.0, f64::max)
    };
    for altitude_m in [2.0, 10_000.0, 90_000.0, 400_000.0] {
        scene.camera.altitude_m = altitude_m;
        let mut under = |elevation_deg: f64| {
            let mut light = sun.clone();
            (light.angular_radius_rad, light.direction.elevation_rad) = (0.0, elevation_deg.to_radians());
            scene.lights = vec![Light::Directional(light)];
            let facts = Facts::new(&scene, Settings::of(Quality::Low), Orders::All, CAPTURE).unwrap();
            (!facts.lights.is_empty(), brightest(&scene))
        };
        let (mut seen, mut lit) = (Vec::new(), Vec::new());
        for below in (10..80).step_by(2) {
            let (counts, radiance) = under(f64::from(-below));
            assert!(counts || radiance == 0.0, "{altitude_m} m, {below}° down: {radiance}");
            seen.push(counts);
            lit.push(radiance > 0.0);
        }
        // Control: the rule leaves out, and it does so within ten degrees of the last light.
        let last = |list: &[bool]| list.iter().filter(|&&is| is).count();
        assert!(last(&seen) < 30 && last(&seen) < last(&lit) + 6, "{altitude_m} m: {} {}", last(&seen), last(&lit));
    }
}

#[test]
fn an_absent_effect_leaves_no_instruction_and_no_binding() {
    // Each effect with the scene that has it, and the first word of its own files.
    let cases =
        [("CLOUDS", "clouds/fair-cumulus", "cloud"), ("SURFACE", "hills", "aerial"), ("SPHERE", "moonlight", "-")];
    let noon = scene("noon");
    for (flag, with, prefix) in cases {
        let of = |scene: &Scene| {
            let facts = Facts::new(scene, Settings::of(Quality::Medium), Orders::All, CAPTURE).unwrap();
            definitions(&facts)
        };
        let (clear, rich) = (of(&noon), of(&scene(with)));
        assert_eq!((clear[flag], rich[flag]), (Definition::Bool(false), Definition::Bool(true)), "{flag}");
        let absent = stripped::absent(&clear);
        let compile = |sources: &Sources, definitions| Shader::from_sources(sources, "compose", definitions).unwrap();
        let all = compile(&Sources::embedded(), &clear);
        let stripped = compile(&stripped::without(&absent, &[prefix]), &clear);
        assert_eq!(all.spirv, stripped.spirv, "{flag} leaves instructions behind");
        assert_eq!(all.bindings, stripped.bindings, "{flag} leaves bindings behind");
        // Control: where the effect is present the shader is another.
        let present = compile(&Sources::embedded(), &rich);
        assert_ne!(present.spirv, all.spirv, "{flag}");
    }
}
