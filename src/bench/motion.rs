//! What changes from one frame to the next.

use crate::scene::{Light, Scene};

/// What changes from one frame to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Nothing.
    Still,
    /// The camera turns by a tenth of a degree.
    Turn,
    /// The camera climbs by a millimetre, so that what is seen from its altitude is computed anew.
    Fly,
    /// The lights rise or set by a hundredth of a degree, as the sun does in some seconds.
    Sun,
    /// Nothing, but everything is computed as for the first time.
    Anew,
}

impl Motion {
    /// From the least to the most that must be computed.
    pub const ALL: [Self; 5] = [Self::Still, Self::Turn, Self::Fly, Self::Sun, Self::Anew];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Turn => "turn",
            Self::Fly => "fly",
            Self::Sun => "sun",
            Self::Anew => "anew",
        }
    }

    /// Moves a scene on by one frame.
    pub fn advance(self, scene: &mut Scene, frame: u32) {
        // Back and forth, so that long series stay where they began.
        let way = if frame % 16 < 8 { 1.0 } else { -1.0 };
        match self {
            Self::Still | Self::Anew => {}
            Self::Turn => scene.camera.direction.azimuth_rad += way * 0.1_f64.to_radians(),
            Self::Fly => scene.camera.altitude_m += way * 1e-3,
            Self::Sun => {
                for light in &mut scene.lights {
                    if let Light::Directional(light) = light {
                        light.direction.elevation_rad += way * 0.01_f64.to_radians();
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_motion_but_stillness_changes_what_a_frame_depends_on() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/noon.toml");
        let scene = Scene::read(&path).unwrap();
        for motion in Motion::ALL {
            let mut moved = scene.clone();
            motion.advance(&mut moved, 0);
            let same = format!("{scene:?}") == format!("{moved:?}");
            assert_eq!(same, matches!(motion, Motion::Still | Motion::Anew), "{}", motion.name());
        }
    }
}
