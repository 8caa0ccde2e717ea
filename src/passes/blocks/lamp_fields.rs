//! Light of lamps that matter around them has scattered, as tables for the shaders: one for each kind of matter.

use std::f64::consts::PI;

use welkin_lut::cloud::CloudLayer;
use welkin_lut::lamp_field::LampField;
use welkin_lut::volume::{Volume, VolumeParameters};
use welkin_lut::{BAND_COUNT, Bands, PhaseFunction};

use super::volumes::mean_chord_m;
use crate::plan::Facts;

/// Depths of a table: WGSL `DEPTHS`.
const DEPTHS: usize = 32;
/// Angles of a table: WGSL `ANGLES`.
const ANGLES: usize = 48;
/// The first depth, and the last.
const RANGE: [f64; 2] = [0.02, 60.0];
/// WGSL `NO_FIELD`.
pub(super) const NO_FIELD: u32 = u32::MAX;

/// What a table depends on.
#[derive(Debug, Clone, PartialEq)]
struct Matter {
    phase: PhaseFunction,
    albedo: Bands,
    /// Of the ball that stands for its form, in optical depths.
    radius: Bands,
}

/// Tables of a scene's kinds of matter; those that are there already are not made anew.
#[derive(Debug, Default)]
pub struct LampFields {
    matter: Vec<Matter>,
    texels: Vec<Vec<[f32; 4]>>,
}

/// Optical depth across matter, from the middle of its form to its surface: of fog that of its height, of a local volume that of the
/// ball with as long a mean chord.
fn radius(volume: &Volume) -> Bands {
    let extent_m = volume.altitudes_m().map_or(0.75 * mean_chord_m(&volume.form), |[bottom_m, top_m]| {
        let scale_m = f64::from(VolumeParameters::new(volume, 0.0).per_scale_height).recip();
        if scale_m.is_finite() { 2.0 * scale_m } else { top_m - bottom_m }
    });
    volume.extinction_per_m().map(|extinction| extinction * extent_m)
}

/// Mean density of a cloud's inside, relative to the densest. The edge of a ball of it is that far off in optical depths: what lies
/// between a place and a lamp is looked at for itself.
const DENSITY_IN_CLOUDS: f64 = 0.5;

/// Of a layer of clouds: a cloud is taken to be as wide as the layer is thick.
fn matter_of_clouds(layer: &CloudLayer) -> Matter {
    let radius = 0.5 * DENSITY_IN_CLOUDS * layer.extinction_per_m() * (layer.top_m - layer.base_m);
    Matter { phase: layer.phase.clone(), albedo: layer.albedo, radius: [radius; BAND_COUNT] }
}

fn matter(volume: &Volume) -> Matter {
    let extinction = volume.extinction_per_m();
    let albedo = std::array::from_fn(|band| {
        if extinction[band] > 0.0 { volume.scattering_per_m[band] / extinction[band] } else { 0.0 }
    });
    Matter { phase: volume.phase.clone(), albedo, radius: radius(volume) }
}

/// A table's rows, one after the other.
fn texels(matter: &Matter) -> Vec<[f32; 4]> {
    let cosines: Vec<f64> = (0..ANGLES).map(|i| (PI * (i as f64 / (ANGLES - 1) as f64).powi(2)).cos()).collect();
    let mut texels = vec![[0.0; 4]; DEPTHS * (ANGLES + 2)];
    for band in 0..BAND_COUNT {
        let same =
            (0..band).find(|&b| matter.albedo[b] == matter.albedo[band] && matter.radius[b] == matter.radius[band]);
        if let Some(other) = same {
            texels.iter_mut().for_each(|texel| texel[band] = texel[other]);
            continue;
        }
        let field = LampField::new(&matter.phase, matter.albedo[band], matter.radius[band]);
        for (row, of_depth) in texels.chunks_exact_mut(ANGLES + 2).enumerate() {
            let depth = RANGE[0] * (RANGE[1] / RANGE[0]).powf(row as f64 / (DEPTHS - 1) as f64);
            let flux = field.flux(depth);
            let values = field.scattered_per_sr(depth, &cosines).into_iter().chain([flux.outward, flux.scalar]);
            let opacity = -(-depth).exp_m1();
            of_depth.iter_mut().zip(values).for_each(|(texel, value)| texel[band] = (value / opacity) as f32);
        }
    }
    texels
}

impl LampFields {
    /// Makes the tables that a scene calls for, and forgets others.
    pub fn prepare(&mut self, facts: &Facts) {
        let mut wanted: Vec<Matter> = Vec::new();
        if super::local_light_count(facts) > 0 {
            let volumes = facts.volumes.iter().filter(|volume| volume.scatters()).map(|volume| matter(volume));
            for matter in volumes.chain(facts.clouds.iter().map(|layer| matter_of_clouds(layer))) {
                if !wanted.contains(&matter) {
                    wanted.push(matter);
                }
            }
        }
        if wanted == self.matter {
            return;
        }
        let kept = |matter: &Matter| self.matter.iter().position(|other| other == matter);
        let texels = wanted.iter().map(|m| kept(m).map_or_else(|| texels(m), |old| self.texels[old].clone()));
        self.texels = texels.collect();
        self.matter = wanted;
    }

    /// The number of a volume's table.
    pub(super) fn of_volume(&self, volume: &Volume) -> u32 {
        self.of(&matter(volume))
    }

    /// The number of the table of a layer of clouds.
    pub(super) fn of_clouds(&self, layer: &CloudLayer) -> u32 {
        self.of(&matter_of_clouds(layer))
    }

    fn of(&self, own: &Matter) -> u32 {
        self.matter.iter().position(|matter| matter == own).map_or(NO_FIELD, |index| index as u32)
    }

    /// WGSL `array<vec4<f32>>`; one where there is none.
    pub fn to_texels(&self) -> Vec<[f32; 4]> {
        let mut all = self.texels.concat();
        all.resize(all.len().max(1), [0.0; 4]);
        all
    }
}
