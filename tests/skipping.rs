//! What the plan leaves out does not show, and what it leaves out is not in the shaders.

mod common;
mod skipping_trials;
mod stripped;

use std::f64::consts::PI;

use welkin::gpu::DeviceRequest;
use welkin::passes::definitions;
use welkin::plan::{Facts, Quality, Settings, Skipping};
use welkin::probe::Orders;
use welkin::reference::World;
use welkin::reference::probe::direction;
use welkin::reference::single::first_order;
use welkin::renderer::Renderer;
use welkin::scene::{Effect, Light, Scene};
use welkin_shaders::{Definition, Shader, Sources};

use skipping_trials::{
    BOUND, CAPTURE, LIGHTS_BOUND, Sample, WRONG_ABOUT_LIGHTS, difference, difference_in_thin_air, difference_in_views,
    difference_of_lag, renderers, scene, wrong_about_views,
};

/// The first difference above the bound ends it: for a rule the test has failed then, and a wrong one is caught.
fn up_to(scenes: usize, seed: u64, bound: f64) -> Sample {
    Sample { scenes, seed, enough: bound }
}

#[test]
fn lights_and_discs_that_are_left_out_do_not_show() {
    let _alone = common::alone();
    let mut renderer = Renderer::new(&DeviceRequest::default()).unwrap();
    let tally = difference(&mut renderer, Skipping::USUAL, up_to(120, 7, LIGHTS_BOUND));
    assert!(tally.worst < LIGHTS_BOUND && tally.changed > 50, "{tally:?}");
    // Controls: each rule, set wrong, is caught.
    for rules in WRONG_ABOUT_LIGHTS {
        let tally = difference(&mut renderer, rules, up_to(60, 7, LIGHTS_BOUND));
        assert!(tally.worst > LIGHTS_BOUND, "{rules:?} goes unnoticed: {tally:?}");
    }
}

#[test]
fn what_is_out_of_the_picture_does_not_show_in_it() {
    let _alone = common::alone();
    let mut renderers = renderers();
    // Each effect, or air alone, with how many views are tried, and how many must be changed.
    let cases = [(None, 40, 10), (Some(Effect::Mountains), 40, 7), (Some(Effect::Clouds), 24, 3)];
    for (effect, views, at_least) in cases {
        let sample = up_to(views, 11, BOUND);
        let tally = difference_in_views(&mut renderers, effect, Skipping::USUAL, sample);
        assert!(tally.worst < BOUND && tally.changed >= at_least, "{effect:?}: {tally:?}");
        for rules in wrong_about_views(effect) {
            let tally = difference_in_views(&mut renderers, effect, rules, sample);
            assert!(tally.worst > BOUND, "{effect:?}: {rules:?} goes unnoticed: {tally:?}");
        }
    }
}

#[test]
fn light_scattered_more_than_once_does_not_show_in_thin_air_over_dark_ground() {
    let _alone = common::alone();
    let mut renderers = renderers();
    let sample = up_to(40, 5, BOUND);
    let tally = difference_in_thin_air(&mut renderers, Skipping::USUAL, sample);
    assert!(tally.worst < BOUND && tally.changed >= 10, "{tally:?}");
    let wrong = Skipping { thin_share: 1.0, ..Skipping::USUAL };
    let tally = difference_in_thin_air(&mut renderers, wrong, sample);
    assert!(tally.worst > BOUND, "a wrong rule goes unnoticed: {tally:?}");
}

#[test]
fn tables_that_lag_behind_the_sun_by_all_that_they_may_do_not_show_it() {
    let _alone = common::alone();
    let mut renderers = renderers();
    let sample = up_to(20, 3, BOUND);
    let tally = difference_of_lag(&mut renderers, Skipping::IN_SEQUENCE, sample);
    assert!(tally.worst < BOUND && tally.changed >= 10, "{tally:?}");
    let careless = Skipping { lag_share: 20.0 * BOUND, ..Skipping::IN_SEQUENCE };
    let tally = difference_of_lag(&mut renderers, careless, sample);
    assert!(tally.worst > BOUND, "a lag of twenty times as much goes unnoticed: {tally:?}");
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
    let cases = [
        ("CLOUDS", "clouds/fair-cumulus", "cloud"),
        ("LOCAL_MEDIA", "fog/valley-morning", "volume"),
        ("SURFACE", "hills", "aerial"),
        ("EMISSION", "moonlight", "emission"),
        ("SPHERE", "moonlight", "-"),
    ];
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
