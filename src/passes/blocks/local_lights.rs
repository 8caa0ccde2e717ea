//! Point and spot lights, and glowing volumes as lights of what is around them, as the shaders read them.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use welkin_lut::cloud::CloudLayer;
use welkin_lut::volume::{Volume, VolumeField, VolumeParameters};
use welkin_lut::{BAND_COUNT, Bands};

use super::angular_fields::{AngularFields, NO_FIELD};
use super::glow::{Glow, is_glowing};
use super::local_lists::LocalLists;
use super::vec3;
use crate::plan::Facts;
use crate::scene::Cone;

/// WGSL `LocalLight`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LocalLightBlock {
    pub(super) position_m: [f32; 3],
    pub(super) reach_m: f32,
    pub(super) intensity: [f32; 3],
    pub(super) size_squared: f32,
    pub(super) axis: [f32; 3],
    pub(super) inner_cosine: f32,
    pub(super) outer_cosine: f32,
    pub(super) solid_share: f32,
    pub(super) core_reach_m: f32,
    pub(super) field: u32,
    pub(super) lists_first: u32,
    pub(super) list_count: u32,
    pub(super) backward: f32,
    pub(super) padding: f32,
}

/// What shines from a place, and how far that counts.
pub struct Lamp {
    /// Where, m.
    pub position_m: DVec3,
    /// Farther away it is left out, m.
    pub reach_m: f64,
    /// Farther away the core of the glow around it may be blurred, m.
    core_reach_m: f64,
    intensity: Bands,
    cone: Option<Cone>,
    /// Radius of what shines, m.
    size_m: f64,
    /// The volume that shines, whose intensity is what leaves it.
    pub(super) own_volume: Option<usize>,
}

/// Matter where a lamp stands, without billows.
struct Surroundings {
    scattering_per_m: Bands,
    absorption_per_m: Bands,
    /// The share of scattering that turns light back.
    backward: f64,
    /// The volume that scatters most there.
    densest: Option<usize>,
}

/// Farthest that a light in clear air reaches, in distances to its neighbour where that is all that limits it, m.
const LONGEST_REACH_M: f64 = 1e5;

/// How much more of its light a lamp brings where the core of its glow is found pixel by pixel.
const CORE_SHARE: f64 = 10.0;

/// Lights and glowing volumes of a scene.
pub fn lamps(facts: &Facts) -> Vec<Lamp> {
    let lights = facts.local_lights.iter().map(|light| Lamp {
        position_m: light.position_m,
        reach_m: LONGEST_REACH_M,
        core_reach_m: LONGEST_REACH_M,
        intensity: light.intensity,
        cone: light.cone,
        size_m: 0.0,
        own_volume: None,
    });
    let glowing = facts.volumes.iter().enumerate().filter_map(|(index, volume)| {
        Glow::of(volume).map(|glow| Lamp {
            position_m: DVec3::from_array(glow.centre_m),
            reach_m: LONGEST_REACH_M,
            core_reach_m: LONGEST_REACH_M,
            intensity: glow.intensity,
            cone: None,
            size_m: glow.radius_m,
            own_volume: Some(index),
        })
    });
    let mut all: Vec<_> = lights.chain(glowing).collect();
    let positions: Vec<_> = all.iter().map(|lamp| lamp.position_m).collect();
    for (index, lamp) in all.iter_mut().enumerate() {
        let others = positions.iter().enumerate().filter(|(other, _)| *other != index);
        let nearest_m = others.map(|(_, other)| other.distance(lamp.position_m)).fold(f64::INFINITY, f64::min);
        let around = surroundings(facts, lamp);
        let share = f64::from(facts.settings.volumes.lamp_share);
        lamp.reach_m = reach_m(nearest_m.max(1.0), &around, share);
        lamp.core_reach_m = reach_m(nearest_m.max(1.0), &around, share / CORE_SHARE);
    }
    all
}

/// What is about a lamp, but for the volume that is the lamp.
fn surroundings(facts: &Facts, lamp: &Lamp) -> Surroundings {
    let at = lamp.position_m;
    let mut all = Surroundings {
        scattering_per_m: [0.0; BAND_COUNT],
        absorption_per_m: [0.0; BAND_COUNT],
        backward: 1.0,
        densest: None,
    };
    let (mut turned, mut scattered, mut most) = (0.0, 0.0, 0.0);
    for (index, volume) in facts.volumes.iter().enumerate().filter(|(index, _)| Some(*index) != lamp.own_volume) {
        let even = Volume { noise: None, ..(*volume).clone() };
        let density =
            VolumeField::new(&even, VolumeParameters::new(&even, 0.0)).density(at.to_array(), [at.x, at.y], at.z)
                * volume.noise.map_or(1.0, |noise| 1.0 - 0.4 * noise.strength);
        let backward = 1.0 - volume.phase.mean_cosine();
        for band in 0..BAND_COUNT {
            all.scattering_per_m[band] += density * volume.scattering_per_m[band];
            all.absorption_per_m[band] += density * volume.absorption_per_m[band];
        }
        let mean = density * volume.scattering_per_m.iter().sum::<f64>() / BAND_COUNT as f64;
        scattered += mean;
        turned += mean * backward;
        if mean > most {
            (most, all.densest) = (mean, Some(index));
        }
    }
    if scattered > 0.0 {
        all.backward = turned / scattered;
    }
    all
}

/// The layer of clouds between whose altitudes a lamp hangs. Whether there is a cloud about it does not matter: without one there is
/// no depth between it and any place.
fn clouds_around<'a>(facts: &'a Facts, at: DVec3) -> Option<&'a CloudLayer> {
    let radius_m = facts.scene.planet.radius_m;
    let altitude_m = (at + DVec3::Z * radius_m).length() - radius_m;
    facts.clouds.iter().copied().find(|layer| (layer.base_m..=layer.top_m).contains(&altitude_m))
}

/// Where a lamp brings one in `share` of what it brings to its neighbour: e^(-c d) / d² falls that far.
fn reach_m(neighbour_m: f64, around: &Surroundings, share: f64) -> f64 {
    let extinction = (0..BAND_COUNT)
        .map(|band| around.absorption_per_m[band] + around.backward * around.scattering_per_m[band])
        .fold(f64::INFINITY, f64::min);
    let falls = |d: f64| extinction * (d - neighbour_m) + 2.0 * (d / neighbour_m).ln() >= share.ln();
    let (mut near, mut far) = (neighbour_m.min(LONGEST_REACH_M), LONGEST_REACH_M);
    for _ in 0..60 {
        let middle = 0.5 * (near + far);
        if falls(middle) { far = middle } else { near = middle }
    }
    far
}

impl LocalLightBlock {
    fn new(facts: &Facts, lamp: &Lamp, fields: &AngularFields, list: std::ops::Range<usize>) -> Self {
        let around = surroundings(facts, lamp);
        let (axis, inner, outer) = match lamp.cone {
            Some(cone) => (cone.axis.to_vector(), cone.inner_cosine, cone.outer_cosine),
            None => (DVec3::Z, 0.0, -2.0),
        };
        let solid_share = if lamp.cone.is_some() { 0.5 * (1.0 - 0.5 * (inner + outer)) } else { 1.0 };
        Self {
            position_m: lamp.position_m.as_vec3().to_array(),
            reach_m: lamp.reach_m as f32,
            intensity: vec3(lamp.intensity),
            size_squared: (lamp.size_m * lamp.size_m) as f32,
            axis: axis.as_vec3().to_array(),
            inner_cosine: inner as f32,
            outer_cosine: outer as f32,
            solid_share: solid_share as f32,
            core_reach_m: lamp.core_reach_m as f32,
            field: match (around.densest, clouds_around(facts, lamp.position_m)) {
                (Some(index), _) => fields.around_lamp(facts.volumes[index]),
                (None, Some(layer)) => fields.of_clouds(layer),
                (None, None) => NO_FIELD,
            },
            lists_first: list.start as u32,
            list_count: list.len() as u32,
            backward: match (around.densest, clouds_around(facts, lamp.position_m)) {
                (None, Some(layer)) => (1.0 - layer.phase.mean_cosine()) as f32,
                _ => around.backward as f32,
            },
            padding: 0.0,
        }
    }
}

/// WGSL `array<LocalLight>`; one that does not shine where there is none.
pub fn local_light_blocks(
    facts: &Facts,
    lamps: &[Lamp],
    lists: &LocalLists,
    fields: &AngularFields,
) -> Vec<LocalLightBlock> {
    let numbered = lamps.iter().enumerate();
    let mut blocks: Vec<_> =
        numbered.map(|(index, lamp)| LocalLightBlock::new(facts, lamp, fields, lists.of_light(index))).collect();
    blocks.resize(blocks.len().max(1), LocalLightBlock::zeroed());
    blocks
}

/// How many lights there are for shaders to loop over.
pub fn local_light_count(facts: &Facts) -> u32 {
    (facts.local_lights.len() + facts.volumes.iter().filter(|volume| is_glowing(volume)).count()) as u32
}
