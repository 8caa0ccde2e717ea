//! Light of lamps and of beams that matter has scattered, as tables over optical depth and angle for the shaders: for each kind of matter
//! one around a lamp, and one of what its forward peak makes of a beam.

use std::f64::consts::PI;

use welkin_lut::cloud::CloudLayer;
use welkin_lut::forward_peak::{self, ForwardPeak};
use welkin_lut::lamp_field::LampField;
use welkin_lut::volume::{Volume, VolumeParameters};
use welkin_lut::{BAND_COUNT, Bands, PhaseFunction};

use super::volumes::{albedo, followed_moments, mean_chord_m};
use crate::plan::{CloudScattering, Facts};

/// Depths of a table: WGSL `DEPTHS`.
const DEPTHS: usize = 32;
/// Angles of a table: WGSL `ANGLES`.
const ANGLES: usize = 48;
/// The first depth, and the last.
const RANGE: [f64; 2] = [0.02, 60.0];
/// WGSL `NO_FIELD`.
pub(super) const NO_FIELD: u32 = u32::MAX;

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    /// A lamp within a ball of so many optical depths, which stands for the form of the matter.
    Lamp { radius: Bands },
    /// A beam, of what turns away from which so many moments are followed.
    Beam { moments: usize },
}

/// What a table depends on.
#[derive(Debug, Clone, PartialEq)]
struct Matter {
    phase: PhaseFunction,
    albedo: Bands,
    source: Source,
}

/// Tables of a scene's kinds of matter; those that are there already are not made anew.
#[derive(Debug, Default)]
pub struct AngularFields {
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
    Matter { phase: layer.phase.clone(), albedo: layer.albedo, source: Source::Lamp { radius: [radius; BAND_COUNT] } }
}

fn matter(volume: &Volume, source: Source) -> Matter {
    Matter { phase: volume.phase.clone(), albedo: albedo(volume), source }
}

fn in_beam(volume: &Volume) -> Matter {
    matter(volume, Source::Beam { moments: followed_moments(volume) })
}

fn around_lamp(volume: &Volume) -> Matter {
    matter(volume, Source::Lamp { radius: radius(volume) })
}

/// What rows of one band are made of.
enum Field {
    Lamp(LampField),
    Beam { peak: ForwardPeak, share: f64, albedo: f64 },
}

impl Field {
    fn new(matter: &Matter, band: usize) -> Self {
        let albedo = matter.albedo[band];
        match matter.source {
            Source::Lamp { radius } => Self::Lamp(LampField::new(&matter.phase, albedo, radius[band])),
            Source::Beam { moments } => Self::Beam {
                peak: ForwardPeak::new(&matter.phase, moments),
                share: forward_peak::share(&matter.phase, moments),
                albedo,
            },
        }
    }

    /// A row: values at its angles, then of lamps flux and mean, all over the light that the depth takes; of a beam also over what the
    /// similar medium leaves of it, but for the ceiling of its peak, which comes last.
    fn row(&self, depth: f64, cosines: &[f64]) -> Vec<f64> {
        let opacity = -(-depth).exp_m1();
        match self {
            Self::Lamp(field) => {
                let flux = field.flux(depth);
                let values = field.scattered_per_sr(depth, cosines).into_iter();
                values.chain([flux.outward, flux.scalar]).map(|value| value / opacity).collect()
            }
            Self::Beam { peak, share, albedo } => {
                let per = ((1.0 - albedo * share) * depth).exp() / opacity;
                let values = peak.scattered_again_per_sr(*albedo, depth, cosines).into_iter();
                // The shaders' least of two numbers knows no infinity.
                let ceiling_per_sr = peak.ceiling_per_sr().min(f64::from(f32::MAX));
                values.map(|value| value * per).chain([ceiling_per_sr, 0.0]).collect()
            }
        }
    }
}

/// Whether two bands are one.
fn are_alike(matter: &Matter, a: usize, b: usize) -> bool {
    let same_ball = match matter.source {
        Source::Lamp { radius } => radius[a] == radius[b],
        Source::Beam { .. } => true,
    };
    same_ball && matter.albedo[a] == matter.albedo[b]
}

/// A table's rows, one after the other.
fn texels(matter: &Matter) -> Vec<[f32; 4]> {
    let cosines: Vec<f64> = (0..ANGLES).map(|i| (PI * (i as f64 / (ANGLES - 1) as f64).powi(2)).cos()).collect();
    let mut texels = vec![[0.0; 4]; DEPTHS * (ANGLES + 2)];
    for band in 0..BAND_COUNT {
        if let Some(other) = (0..band).find(|&other| are_alike(matter, other, band)) {
            texels.iter_mut().for_each(|texel| texel[band] = texel[other]);
            continue;
        }
        let field = Field::new(matter, band);
        for (index, of_depth) in texels.chunks_exact_mut(ANGLES + 2).enumerate() {
            let depth = RANGE[0] * (RANGE[1] / RANGE[0]).powf(index as f64 / (DEPTHS - 1) as f64);
            of_depth.iter_mut().zip(field.row(depth, &cosines)).for_each(|(texel, value)| texel[band] = value as f32);
        }
    }
    texels
}

impl AngularFields {
    /// Makes the tables that a scene calls for, and forgets others.
    pub fn prepare(&mut self, facts: &Facts) {
        let scattering = || facts.volumes.iter().filter(|volume| volume.scatters());
        let mut all: Vec<Matter> = Vec::new();
        if !facts.lights.is_empty() && facts.cloud_scattering() != CloudScattering::Single {
            all.extend(scattering().map(|volume| in_beam(volume)));
        }
        if super::local_light_count(facts) > 0 {
            all.extend(scattering().map(|volume| around_lamp(volume)));
            all.extend(facts.clouds.iter().map(|layer| matter_of_clouds(layer)));
        }
        let mut wanted: Vec<Matter> = Vec::new();
        for matter in all {
            if !wanted.contains(&matter) {
                wanted.push(matter);
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

    /// The number of a volume's table around a lamp.
    pub(super) fn around_lamp(&self, volume: &Volume) -> u32 {
        self.of(&around_lamp(volume))
    }

    /// The number of its table of a beam's light.
    pub(super) fn in_beam(&self, volume: &Volume) -> u32 {
        self.of(&in_beam(volume))
    }

    /// The number of the table around a lamp of a layer of clouds.
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
