//! How large tables are, and how finely light is integrated.

use super::SourceGrid;

/// Sides of the 4D table of scattered light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScatteringSize {
    /// Azimuths from the light on half a turn, ends included; at least 2.
    pub azimuths: u32,
    /// Heights of the sun, at least 2.
    pub suns: u32,
    /// Elevations of each half of the view sphere, at least 2.
    pub elevations: u32,
    /// Altitudes, at least 2.
    pub altitudes: u32,
}

/// Everything that trades accuracy for time and size. Sizes are (columns, rows) in texels, each at least 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BakeSettings {
    /// Gauss-Legendre nodes on each leg of a ray.
    pub nodes_per_leg: u32,
    /// Optical depth: (direction, altitude).
    pub optical_depth_size: [u32; 2],
    /// Source function, multiple scattering and irradiance: (sun, altitude).
    pub source_size: [u32; 2],
    /// Directions in which the source function is tabulated.
    pub source_grid: SourceGrid,
    /// Orders of scattering that are computed one by one, at least 3; the rest of the series is geometric.
    pub orders: u32,
    /// Scattered light.
    pub scattering: ScatteringSize,
}

/// Of the sides of the scattered light, heights of the sun are worth the most: with too few of them twilight is off, while the
/// sky of day hardly notices how many elevations there are.
impl BakeSettings {
    /// For weak devices: 2.8 MB of scattered light in half floats, for two scatterers.
    pub const LOW: Self = Self {
        nodes_per_leg: 10,
        optical_depth_size: [128, 48],
        source_size: [40, 14],
        source_grid: SourceGrid { ground: 4, low: 4, high: 4, azimuths: 8 },
        orders: 4,
        scattering: ScatteringSize { azimuths: 5, suns: 40, elevations: 24, altitudes: 12 },
    };
    /// The default: 16 MB.
    pub const MEDIUM: Self = Self {
        nodes_per_leg: 12,
        optical_depth_size: [256, 64],
        source_size: [48, 18],
        source_grid: SourceGrid { ground: 4, low: 5, high: 5, azimuths: 8 },
        orders: 4,
        scattering: ScatteringSize { azimuths: 8, suns: 64, elevations: 32, altitudes: 20 },
    };
    /// 44 MB.
    pub const HIGH: Self = Self {
        nodes_per_leg: 12,
        optical_depth_size: [256, 128],
        source_size: [48, 24],
        source_grid: SourceGrid { ground: 5, low: 6, high: 5, azimuths: 10 },
        orders: 5,
        scattering: ScatteringSize { azimuths: 10, suns: 80, elevations: 48, altitudes: 24 },
    };
    /// As close to the truth as the methods come: 154 MB.
    pub const ULTRA: Self = Self {
        nodes_per_leg: 16,
        optical_depth_size: [512, 128],
        source_size: [64, 32],
        source_grid: SourceGrid { ground: 6, low: 8, high: 6, azimuths: 12 },
        orders: 6,
        scattering: ScatteringSize { azimuths: 14, suns: 112, elevations: 64, altitudes: 32 },
    };
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self::MEDIUM
    }
}
