//! The numbers of one volume at one time, as the device has them.

use super::{FogProfile, Volume, VolumeForm};
use crate::cloud::noise_place;

/// Forms as the device tells them apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum VolumeKind {
    /// A box.
    Box = 0,
    /// An ellipsoid.
    Ellipsoid = 1,
    /// Fog that thins exponentially.
    ExponentialFog = 2,
    /// A layer of fog.
    FogLayer = 3,
}

/// Everything that the chain from a place to density needs. The numbers are those of the device, in 32 bits: where the
/// definition says a number, it is this one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeParameters {
    /// Which form.
    pub kind: VolumeKind,
    /// Middle of a local form: east, north, up, m.
    pub centre_m: [f32; 3],
    /// Half of its size, m.
    pub half_size_m: [f32; 3],
    /// Cosine and sine of its turn.
    pub turn: [f32; 2],
    /// Altitudes between which fog lies, m.
    pub bottom_m: f32,
    /// The upper one.
    pub top_m: f32,
    /// 1 / scale height of fog, 1/m; 0 for a layer.
    pub per_scale_height: f32,
    /// 1 / the share over which density falls at the surface; 0 where it is sharp.
    pub per_edge: f32,
    /// What noise takes at most.
    pub noise_strength: f32,
    /// Tiles of noise per metre.
    pub noise_per_m: f32,
    /// Where the tile begins, tiles.
    pub noise_offset: [f32; 3],
}

/// The largest billows along a tile of the clouds' shape.
const BILLOWS_PER_TILE: f64 = 4.0;

impl VolumeParameters {
    /// Those of a volume at a time in seconds.
    pub fn new(volume: &Volume, time_s: f64) -> Self {
        let (kind, centre_m, size_m, turn_rad) = match volume.form {
            VolumeForm::Box { centre_m, size_m, turn_rad } => (VolumeKind::Box, centre_m, size_m, turn_rad),
            VolumeForm::Ellipsoid { centre_m, size_m, turn_rad } => (VolumeKind::Ellipsoid, centre_m, size_m, turn_rad),
            VolumeForm::Fog { profile: FogProfile::Exponential { .. }, .. } => {
                (VolumeKind::ExponentialFog, [0.0; 3], [0.0; 3], 0.0)
            }
            VolumeForm::Fog { profile: FogProfile::Layer { .. }, .. } => {
                (VolumeKind::FogLayer, [0.0; 3], [0.0; 3], 0.0)
            }
        };
        let per_scale_height = match volume.form {
            VolumeForm::Fog { profile: FogProfile::Exponential { scale_height_m }, .. } => 1.0 / scale_height_m,
            _ => 0.0,
        };
        let [bottom_m, top_m] = volume.altitudes_m().unwrap_or([0.0; 2]);
        let (sin, cos) = turn_rad.sin_cos();
        let noise = volume.noise.filter(|noise| noise.strength > 0.0);
        let noise_per_m = noise.map_or(0.0, |noise| 1.0 / (BILLOWS_PER_TILE * noise.size_m));
        let noise_offset = noise.map_or([0.0; 3], |noise| {
            let [east, north] = noise.wind_m_per_s.map(|speed| speed * time_s);
            // In the axes of a form that is turned.
            let drift_m = [east * cos - north * sin, east * sin + north * cos, noise.evolution_m_per_s * time_s];
            std::array::from_fn(|axis| {
                let place = noise_place(4, axis as i32, noise.seed);
                (place - drift_m[axis] * noise_per_m).rem_euclid(1.0) as f32
            })
        });
        Self {
            kind,
            centre_m: centre_m.map(|x| x as f32),
            half_size_m: size_m.map(|x| (0.5 * x) as f32),
            turn: [cos as f32, sin as f32],
            bottom_m: bottom_m as f32,
            top_m: top_m as f32,
            per_scale_height: per_scale_height as f32,
            per_edge: if volume.edge > 0.0 { (1.0 / volume.edge) as f32 } else { 0.0 },
            noise_strength: noise.map_or(0.0, |noise| noise.strength) as f32,
            noise_per_m: noise_per_m as f32,
            noise_offset,
        }
    }

    /// Whether it lies all around the planet.
    pub fn is_fog(&self) -> bool {
        matches!(self.kind, VolumeKind::ExponentialFog | VolumeKind::FogLayer)
    }
}
