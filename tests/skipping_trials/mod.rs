//! Random scenes with and without what the plan leaves out: the quick ones of `tests/skipping.rs`, and hundreds of
//! `examples/skipping_sweep.rs`.

// The test and the example use different parts of it.
#![allow(dead_code)]

use std::path::Path;

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use welkin::frame::Frame;
use welkin::gpu::DeviceRequest;
use welkin::plan::{
    CloudSettings, Decision, Directions, Facts, Outputs, Plan, Quality, Settings, Skipping, SourceGrid,
    elevation_slack_rad,
};
use welkin::probe::Orders;
use welkin::renderer::Renderer;
use welkin::scene::{Effect, Light, Scene};

/// A hundredth of what the darkest night sky sends, W·m⁻²·sr⁻¹·nm⁻¹: 2e-4 cd/m² are some 1e-9.
const DARKNESS: f64 = 1e-11;

/// Half a per cent is what a beam in place of a disc may cost (src/plan/disc.rs); half as much again for places of the sun
/// and altitudes between those that were measured.
pub const LIGHTS_BOUND: f64 = 0.0075;
/// What is out of the picture, and what lags, changes no pixel by more than half a per cent.
pub const BOUND: f64 = 0.005;

/// Two renderers: one that computes everything, and one that leaves out.
pub fn renderers() -> [Renderer; 2] {
    [(); 2].map(|()| Renderer::new(&DeviceRequest::default()).unwrap())
}

/// Rules about lights, each set wrong.
pub const WRONG_ABOUT_LIGHTS: [Skipping; 3] = [
    Skipping { faint_share: 0.3, ..Skipping::USUAL },
    Skipping { beam_above_radii: -5.0, ..Skipping::USUAL },
    Skipping { narrowest_disc_rad: 0.1, ..Skipping::USUAL },
];

/// Rules about what is out of the picture, set wrong, that views of an effect or of air alone must catch.
pub fn wrong_about_views(effect: Option<Effect>) -> Vec<Skipping> {
    let out_of_view = |share: f64| Skipping { out_of_view_share: share, ..Skipping::USUAL };
    let nearly_clear = Skipping { hidden_depth: 0.05, ..Skipping::USUAL };
    match effect {
        None => vec![out_of_view(0.5)],
        Some(Effect::Mountains) => vec![out_of_view(0.1), nearly_clear],
        Some(_) => vec![out_of_view(0.1)],
    }
}

pub const CAPTURE: Outputs = Outputs { capture: true, picture: false };

pub fn scene(name: &str) -> Scene {
    Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"))).unwrap()
}

/// Two lights of any brightness, width and place around the horizon, seen from anywhere between the ground and space.
pub fn random_scene(random: &mut Pcg64Mcg) -> Scene {
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

/// Which scenes are tried, and when enough has been seen.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    pub scenes: usize,
    pub seed: u64,
    /// The first scene that is off by more is the last; infinite to try them all.
    pub enough: f64,
}

/// What a rule does to a sample of scenes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally {
    /// How many were tried.
    pub scenes: usize,
    /// In how many of them the rule changed the plan.
    pub changed: usize,
    /// The largest difference of a pixel that it makes, relative to the pixel.
    pub worst: f64,
    /// In which scene.
    pub worst_scene: usize,
}

impl Sample {
    /// Each scene with and without what a rule leaves out: whether the plans differ, and by how much a pixel does.
    fn tally(self, mut trial: impl FnMut(&mut Pcg64Mcg) -> (bool, f64)) -> Tally {
        let mut random = Pcg64Mcg::seed_from_u64(self.seed);
        let mut tally = Tally::default();
        while tally.scenes < self.scenes && tally.worst <= self.enough {
            let (is_changed, difference) = trial(&mut random);
            if difference > tally.worst {
                (tally.worst, tally.worst_scene) = (difference, tally.scenes);
            }
            tally.changed += usize::from(is_changed);
            tally.scenes += 1;
        }
        tally
    }
}

/// What leaving out by these rules does to scenes with two lights.
pub fn difference(renderer: &mut Renderer, skipping: Skipping, sample: Sample) -> Tally {
    sample.tally(|random| {
        let scene = random_scene(random);
        let mut with = |skipping| {
            let settings = Settings { skipping, ..Settings::of(Quality::Low) };
            let facts = Facts::new(&scene, settings, Orders::All, CAPTURE).unwrap();
            let widths = facts.lights.iter().filter(|light| facts.is_wide(light)).count();
            let lit = (facts.lights.len(), widths);
            (renderer.render(&scene, settings, CAPTURE).unwrap().frame, lit)
        };
        let ((all, all_lit), (some, some_lit)) = (with(Skipping::NONE), with(skipping));
        (all_lit != some_lit, largest_difference(&all, &some))
    })
}

/// Tables so small that a frame costs next to nothing; all passes are the same.
pub fn tiny(skipping: Skipping) -> Settings {
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
pub fn random_view(random: &mut Pcg64Mcg, effect: Option<Effect>) -> Scene {
    let mut uniform = |low: f64, high: f64| low + (high - low) * f64::from(random.next_u32()) * 0.5_f64.powi(32);
    let mut scene = scene("noon");
    (scene.camera.width, scene.camera.height) = (16, 9);
    scene.camera.vertical_field_of_view_rad = uniform(0.1, 0.9);
    scene.camera.direction.elevation_rad = uniform(-1.2, 1.2);
    scene.camera.altitude_m = match effect {
        // Clouds light all air above them.
        Some(Effect::Clouds) => 10_f64.powf(uniform(2.5, 6.5)),
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

/// Nodes a leg that resolve air dense enough to hide mountains: where a leg is hundreds of optical depths deep, its light comes
/// from its last kilometres, and most nodes lie at its low end. In scene 74 of the sweep, ozone 300 times as dense seen from
/// inside it, frames with and without mountains differ by a factor of 5358 with 4 nodes, 2.9 with 16, 0.08 with 32 and
/// 0.0014 with 64, as both come closer to what is there; slices of froxels change nothing.
const NODES_IN_DENSE_AIR: u32 = 64;

/// As [`difference`], of views of an effect or of air alone.
pub fn difference_in_views(
    renderers: &mut [Renderer; 2],
    effect: Option<Effect>,
    skipping: Skipping,
    sample: Sample,
) -> Tally {
    let [forced, left_out] = renderers;
    let settings = |skipping| match effect {
        Some(Effect::Mountains) => Settings { nodes_per_leg: NODES_IN_DENSE_AIR, ..tiny(skipping) },
        _ => tiny(skipping),
    };
    sample.tally(|random| {
        let scene = random_view(random, effect);
        let all = forced.render(&scene, settings(Skipping::NONE), CAPTURE).unwrap();
        let some = left_out.render(&scene, settings(skipping), CAPTURE).unwrap();
        let needed = |plan: &Plan| plan.passes.iter().filter(|p| p.decision != Decision::Skip).count();
        let is_changed = needed(&all.timings.plan) != needed(&some.timings.plan);
        (is_changed, largest_difference(&all.frame, &some.frame))
    })
}

/// As [`difference`], of scenes whose sun has moved by as much as tables may lag behind it: by how much a frame is off whose
/// tables lag, and in how many scenes one did.
pub fn difference_of_lag(renderers: &mut [Renderer; 2], skipping: Skipping, sample: Sample) -> Tally {
    let [exact, lagging] = renderers;
    sample.tally(|random| {
        let mut scene = random_hills(random);
        lagging.forget();
        lagging.render(&scene, tiny(skipping), CAPTURE).unwrap();
        let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
        // Just within: a table beyond it would be computed anew.
        sun.direction.elevation_rad -= 0.98 * elevation_slack_rad(sun, skipping.lag_share);
        let late = lagging.render(&scene, tiny(skipping), CAPTURE).unwrap();
        let now = exact.render(&scene, tiny(Skipping::USUAL), CAPTURE).unwrap();
        let has_lagged = late.timings.plan.passes.iter().any(|pass| pass.reason.contains("lags behind"));
        (has_lagged, largest_difference(&now.frame, &late.frame))
    })
}

/// Hills under a sun of any height, from the ground to the summits and above, in air from clear to hazy.
fn random_hills(random: &mut Pcg64Mcg) -> Scene {
    let mut uniform = |low: f64, high: f64| low + (high - low) * f64::from(random.next_u32()) * 0.5_f64.powi(32);
    let mut scene = scene("hills");
    (scene.camera.width, scene.camera.height) = (16, 9);
    scene.camera.altitude_m = 10_f64.powf(uniform(2.5, 4.0));
    scene.camera.direction.elevation_rad = uniform(-0.5, 0.8);
    scene.camera.direction.azimuth_rad = uniform(0.0, 6.2);
    let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
    sun.direction.elevation_rad = uniform(0.5, 85.0).to_radians();
    let density = 10_f64.powf(uniform(-0.5, 0.7));
    for constituent in &mut scene.medium.constituents {
        constituent.scattering_per_m = constituent.scattering_per_m.map(|b| b * density);
        constituent.absorption_per_m = constituent.absorption_per_m.map(|a| a * density);
    }
    scene
}

/// As [`difference`], of scenes of thin air over black ground.
pub fn difference_in_thin_air(renderers: &mut [Renderer; 2], skipping: Skipping, sample: Sample) -> Tally {
    let [forced, left_out] = renderers;
    sample.tally(|random| {
        let scene = random_thin_air(random);
        let all = forced.render(&scene, tiny(Skipping::NONE), CAPTURE).unwrap();
        let some = left_out.render(&scene, tiny(skipping), CAPTURE).unwrap();
        let is_changed = some.timings.plan.passes.iter().any(|pass| pass.reason.contains("the air is thin"));
        (is_changed, largest_difference(&all.frame, &some.frame))
    })
}

/// Air of a thousandth to a twentieth of the Earth's density, over ground that is black or nearly so, by day.
fn random_thin_air(random: &mut Pcg64Mcg) -> Scene {
    let mut uniform = |low: f64, high: f64| low + (high - low) * f64::from(random.next_u32()) * 0.5_f64.powi(32);
    let mut scene = scene("noon");
    (scene.camera.width, scene.camera.height) = (16, 9);
    scene.camera.altitude_m = 10_f64.powf(uniform(0.0, 4.5));
    scene.camera.direction.elevation_rad = uniform(-0.8, 1.2);
    scene.camera.direction.azimuth_rad = uniform(0.0, 6.2);
    let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
    sun.direction.elevation_rad = uniform(5.0, 85.0).to_radians();
    scene.planet.ground_albedo = [10_f64.powf(uniform(-6.0, -3.0)); 3];
    let density = 10_f64.powf(uniform(-4.0, -1.3));
    // Haze sends so little light back that the bound for it never holds.
    scene.medium.constituents.retain(|constituent| constituent.name != "aerosol");
    for constituent in &mut scene.medium.constituents {
        constituent.scattering_per_m = constituent.scattering_per_m.map(|b| b * density);
        constituent.absorption_per_m = constituent.absorption_per_m.map(|a| a * density);
    }
    scene
}

/// Of a pixel and a band, relative; infinite where light is negative, which no two frames may agree on.
pub fn largest_difference(all: &Frame, some: &Frame) -> f64 {
    let pixels = all.radiance.as_flattened().iter().zip(some.radiance.as_flattened());
    let difference = |(all, some): (&f32, &f32)| match all.min(*some) {
        least if least >= 0.0 => f64::from((all - some).abs()) / (f64::from(*all) + DARKNESS),
        _ => f64::INFINITY,
    };
    pixels.map(difference).fold(0.0, f64::max)
}
