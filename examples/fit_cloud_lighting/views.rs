//! Where the clouds are looked at from, and where the sun stands.

use glam::DVec3;

use super::fields::extent_m;

/// Pixels across and down.
pub const PIXELS: [usize; 2] = [28, 20];
/// Extent of the picture, m.
const PICTURE_M: [f64; 2] = [2800.0, 2000.0];

/// Zenith angles of the suns, degrees; all stand in the direction of +x.
pub const SUN_ZENITHS_DEG: [f64; 3] = [20.0, 60.0, 80.0];

/// Unit vectors to the suns.
pub fn suns() -> [DVec3; 3] {
    SUN_ZENITHS_DEG.map(|degrees| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        DVec3::new(sine, 0.0, cosine)
    })
}

/// A view by parallel rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum View {
    /// From the side, the sun to the right.
    Side,
    /// With the sun in the back.
    AwayFromSun,
    /// Towards the sun, 15° beside its azimuth.
    ToSun,
    /// From above, as from an aircraft.
    Above,
    /// From the ground.
    Below,
}

impl View {
    pub const ALL: [Self; 5] = [Self::Side, Self::AwayFromSun, Self::ToSun, Self::Above, Self::Below];

    /// The direction of all rays, a unit vector.
    pub fn direction(self) -> DVec3 {
        let turned = |azimuth_deg: f64, elevation_deg: f64| {
            let (azimuth, elevation) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
            DVec3::new(azimuth.cos() * elevation.cos(), azimuth.sin() * elevation.cos(), elevation.sin())
        };
        match self {
            Self::Side => turned(90.0, -5.0),
            Self::AwayFromSun => turned(180.0, -10.0),
            Self::ToSun => turned(15.0, 20.0),
            Self::Above => DVec3::new(-0.3, 0.3, -0.9).normalize(),
            Self::Below => DVec3::new(0.2, 0.2, 0.96).normalize(),
        }
    }

    /// Where the ray through a point of the picture starts: (across, down) in [0, 1]². Well outside the cloud's box.
    pub fn start(self, across: f64, down: f64) -> DVec3 {
        let d = self.direction();
        let up = if d.z.abs() > 0.8 { DVec3::X } else { DVec3::Z };
        let right = d.cross(up).normalize();
        let offset = right * ((across - 0.5) * PICTURE_M[0]) + right.cross(d) * ((0.5 - down) * PICTURE_M[1]);
        0.5 * extent_m() + offset - 4000.0 * d
    }
}
