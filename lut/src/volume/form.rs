//! A local medium as a user describes it.

use std::sync::Arc;

use super::VolumeGrid;
use crate::{Bands, PhaseFunction};

/// Scale heights after which fog that thins exponentially is cut off: 1/3000 of its density is left.
const CUT_SCALE_HEIGHTS: f64 = 8.0;

/// How fog's density varies with altitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FogProfile {
    /// exp(-(h - bottom) / H) above the bottom, cut off after eight scale heights.
    Exponential {
        /// H, m.
        scale_height_m: f64,
    },
    /// 1 up to a top, falling to 0 over the uppermost share `edge` of the thickness.
    Layer {
        /// Altitude of the top, m.
        top_m: f64,
    },
}

/// Where matter is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VolumeForm {
    /// A box whose edges are level or upright.
    Box {
        /// Its middle: east, north, up from the ground below the camera, m.
        centre_m: [f64; 3],
        /// Lengths of its edges: those that run east, north and up before it is turned, m.
        size_m: [f64; 3],
        /// Turn about the vertical, clockwise seen from above, rad.
        turn_rad: f64,
    },
    /// An ellipsoid with a vertical axis.
    Ellipsoid {
        /// As for the box.
        centre_m: [f64; 3],
        /// Its diameters, m.
        size_m: [f64; 3],
        /// As for the box.
        turn_rad: f64,
    },
    /// All around the planet, between altitudes.
    Fog {
        /// Altitude below which there is none, m.
        bottom_m: f64,
        /// Density above it.
        profile: FogProfile,
    },
}

/// Billows in a volume's density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeNoise {
    /// Size of the largest billows, m.
    pub size_m: f64,
    /// What the noise takes of the density at most, 0 to 1.
    pub strength: f64,
    /// Another seed is another place in the noise.
    pub seed: u32,
    /// Wind that carries it: east, north, m/s.
    pub wind_m_per_s: [f64; 2],
    /// Speed at which shapes change as if the noise rose, m/s.
    pub evolution_m_per_s: f64,
}

/// A form filled with one kind of matter.
#[derive(Debug, Clone, PartialEq)]
pub struct Volume {
    /// What it is called in messages and tables.
    pub name: String,
    /// Where it is.
    pub form: VolumeForm,
    /// Share of the half size, or of a fog layer's thickness, over which density falls to zero at the surface; 0 is sharp.
    pub edge: f64,
    /// b, scattering coefficient at density 1, 1/m.
    pub scattering_per_m: Bands,
    /// a, absorption coefficient at density 1, 1/m.
    pub absorption_per_m: Bands,
    /// a·L_e, radiance emitted per metre at density 1, W·m⁻²·sr⁻¹·nm⁻¹ per m.
    pub emission_per_m: Bands,
    /// P.
    pub phase: PhaseFunction,
    /// Billows, if any.
    pub noise: Option<VolumeNoise>,
    /// Density from a file, if any; in a box or an ellipsoid.
    pub grid: Option<Arc<VolumeGrid>>,
}

impl Volume {
    /// c = a + b at density 1, 1/m.
    pub fn extinction_per_m(&self) -> Bands {
        std::array::from_fn(|band| self.scattering_per_m[band] + self.absorption_per_m[band])
    }

    /// Whether it scatters in any band.
    pub fn scatters(&self) -> bool {
        self.scattering_per_m.iter().any(|&b| b > 0.0)
    }

    /// Whether nothing of it can be seen.
    pub fn is_empty(&self) -> bool {
        let bands = self.extinction_per_m().into_iter().chain(self.emission_per_m);
        bands.into_iter().all(|value| value <= 0.0) || self.grid.as_ref().is_some_and(|grid| grid.largest() <= 0.0)
    }

    /// Middle, m, and radius, m, of a ball around a local form; none for fog.
    pub fn bounding_sphere(&self) -> Option<([f64; 3], f64)> {
        match self.form {
            VolumeForm::Box { centre_m, size_m, .. } | VolumeForm::Ellipsoid { centre_m, size_m, .. } => {
                Some((centre_m, 0.5 * size_m.iter().map(|size_m| size_m * size_m).sum::<f64>().sqrt()))
            }
            VolumeForm::Fog { .. } => None,
        }
    }

    /// Altitudes between which fog lies, m; none for local forms.
    pub fn altitudes_m(&self) -> Option<[f64; 2]> {
        match self.form {
            VolumeForm::Fog { bottom_m, profile: FogProfile::Layer { top_m } } => Some([bottom_m, top_m]),
            VolumeForm::Fog { bottom_m, profile: FogProfile::Exponential { scale_height_m } } => {
                Some([bottom_m, bottom_m + CUT_SCALE_HEIGHTS * scale_height_m])
            }
            _ => None,
        }
    }

    /// The largest density anywhere, a bound that holds exactly.
    pub fn largest_density(&self) -> f64 {
        self.grid.as_ref().map_or(1.0, |grid| f64::from(grid.largest()))
    }

    /// A length over which the density changes little, m.
    pub fn detail_m(&self) -> f64 {
        let edge = |size_m: f64| if self.edge > 0.0 { 0.25 * self.edge * size_m } else { size_m };
        let form_m = match self.form {
            VolumeForm::Box { size_m, .. } | VolumeForm::Ellipsoid { size_m, .. } => {
                edge(0.5 * size_m.into_iter().fold(f64::INFINITY, f64::min))
            }
            VolumeForm::Fog { profile: FogProfile::Exponential { scale_height_m }, .. } => 0.5 * scale_height_m,
            VolumeForm::Fog { bottom_m, profile: FogProfile::Layer { top_m } } => edge(top_m - bottom_m),
        };
        let noise_m =
            self.noise.filter(|noise| noise.strength > 0.0).map_or(f64::INFINITY, |noise| 0.125 * noise.size_m);
        let voxel_m = match (&self.grid, self.form) {
            (Some(grid), VolumeForm::Box { size_m, .. } | VolumeForm::Ellipsoid { size_m, .. }) => {
                (0..3).map(|i| size_m[i] / grid.size()[i] as f64).fold(f64::INFINITY, f64::min)
            }
            _ => f64::INFINITY,
        };
        form_m.min(noise_m).min(voxel_m)
    }
}
