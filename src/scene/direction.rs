//! Directions in the local frame: x east, y north, z up at the point below the camera.

use glam::DVec3;

/// A direction by its elevation above the horizontal and its azimuth clockwise from north.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Angle above the horizontal, in [-π/2, π/2], rad.
    pub elevation_rad: f64,
    /// Angle from north towards east, rad.
    pub azimuth_rad: f64,
}

impl Direction {
    /// The unit vector (east, north, up).
    pub fn to_vector(self) -> DVec3 {
        let (sin_elevation, cos_elevation) = self.elevation_rad.sin_cos();
        let (sin_azimuth, cos_azimuth) = self.azimuth_rad.sin_cos();
        DVec3::new(cos_elevation * sin_azimuth, cos_elevation * cos_azimuth, sin_elevation)
    }
}
