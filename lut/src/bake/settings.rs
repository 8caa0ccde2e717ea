//! How large tables are, and how finely light is integrated.

/// Cosines and azimuths in which a radiance field is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Directions {
    /// Gauss nodes below the horizon.
    pub below: u32,
    /// Gauss nodes between the horizon and the horizontal.
    pub band: u32,
    /// Gauss nodes above the horizontal.
    pub above: u32,
    /// Midpoints on half a turn.
    pub azimuths: u32,
}

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
    /// Multiple scattering and irradiance: (sun, altitude).
    pub multiple_scattering_size: [u32; 2],
    /// Degrees 0 .. n-1 of spherical harmonics that the field keeps: 3 or 5.
    pub degree_count: u32,
    /// Directions in which each texel's field is sampled.
    pub directions: Directions,
    /// Orders of scattering that are computed one by one, at least 3; the rest of the series is geometric.
    pub orders: u32,
    /// Scattered light.
    pub scattering: ScatteringSize,
}

impl BakeSettings {
    /// For weak devices: 2.7 MB of scattered light in half floats, for two scatterers.
    pub const LOW: Self = Self {
        nodes_per_leg: 8,
        optical_depth_size: [128, 48],
        multiple_scattering_size: [32, 16],
        degree_count: 3,
        directions: Directions { below: 3, band: 2, above: 4, azimuths: 4 },
        orders: 3,
        scattering: ScatteringSize { azimuths: 6, suns: 24, elevations: 32, altitudes: 12 },
    };
    /// The default: 12 MB.
    pub const MEDIUM: Self = Self {
        nodes_per_leg: 10,
        optical_depth_size: [256, 64],
        multiple_scattering_size: [48, 24],
        degree_count: 3,
        directions: Directions { below: 4, band: 3, above: 5, azimuths: 6 },
        orders: 3,
        scattering: ScatteringSize { azimuths: 8, suns: 32, elevations: 48, altitudes: 20 },
    };
    /// 42 MB.
    pub const HIGH: Self = Self {
        nodes_per_leg: 12,
        optical_depth_size: [256, 128],
        multiple_scattering_size: [64, 32],
        degree_count: 3,
        directions: Directions { below: 4, band: 3, above: 5, azimuths: 8 },
        orders: 3,
        scattering: ScatteringSize { azimuths: 12, suns: 48, elevations: 64, altitudes: 24 },
    };
    /// As close to the truth as the methods come: 151 MB.
    pub const ULTRA: Self = Self {
        nodes_per_leg: 16,
        optical_depth_size: [512, 128],
        multiple_scattering_size: [96, 32],
        degree_count: 5,
        directions: Directions { below: 5, band: 3, above: 6, azimuths: 8 },
        orders: 4,
        scattering: ScatteringSize { azimuths: 16, suns: 64, elevations: 96, altitudes: 32 },
    };

    /// Coefficients (l, m), m ≥ 0, of the field.
    pub fn coefficient_count(&self) -> u32 {
        self.degree_count * (self.degree_count + 1) / 2
    }
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self::MEDIUM
    }
}
