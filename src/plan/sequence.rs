//! Frames that follow one another: what the next may take over from the one before.

use std::f64::consts::PI;

use super::Fingerprint;
use crate::scene::{Camera, DirectionalLight, Light, Scene};

/// Where a frame stands among others of one view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sequence {
    /// Frames since the last cut.
    pub index: u32,
    /// The frame before; none after a cut.
    pub before: Option<Moment>,
    /// Whether nothing at all has changed since then.
    pub is_still: bool,
    /// Frames since clouds or lights have last moved; none where they have not since the cut.
    pub settling: Option<u32>,
}

/// How a frame saw the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// From where.
    pub camera: Camera,
    /// When, s.
    pub time_s: f64,
}

impl Sequence {
    /// The first frame after a cut.
    pub const CUT: Self = Self { index: 0, before: None, is_still: false, settling: None };
}

/// Whether the light in clouds is another: they themselves or lights have moved.
pub fn light_in_clouds_moved(before: &Scene, now: &Scene) -> bool {
    before.time_s != now.time_s || directions(before).zip(directions(now)).any(|(a, b)| a.direction != b.direction)
}

/// Altitude that a camera may gain between two frames, m, and as a share of its own.
const CLIMB_M: f64 = 200.0;
const CLIMB_SHARE: f64 = 0.05;
/// How far clouds may change their shape, m: noise that has risen so far is another.
const CHANGE_M: f64 = 10.0;
/// How far lights may turn, rad.
const TURN_RAD: f64 = PI / 180.0;

/// Whether a frame shows what the one before has shown, moved on: if not, there is a cut between them. Camera, time and
/// the lights' directions may change a little, nothing else at all.
pub fn follows(before: &Scene, now: &Scene) -> bool {
    let (a, b) = (&before.camera, &now.camera);
    // Half of the picture must stay in view.
    let turned_rad = a.direction.to_vector().dot(b.direction.to_vector()).clamp(-1.0, 1.0).acos();
    let climbed_m = (a.altitude_m - b.altitude_m).abs();
    let elapsed_s = (now.time_s - before.time_s).abs();
    let changed_m = now.clouds.iter().map(|layer| layer.evolution_m_per_s.abs() * elapsed_s).fold(0.0, f64::max);
    turned_rad < 0.5 * a.vertical_field_of_view_rad.min(b.vertical_field_of_view_rad)
        && climbed_m <= CLIMB_M.max(CLIMB_SHARE * a.altitude_m.max(b.altitude_m))
        && changed_m <= CHANGE_M
        && directions(before).zip(directions(now)).all(|(a, b)| angle_rad(a, b) <= TURN_RAD)
        && same_but_moved(before, now)
}

fn directions(scene: &Scene) -> impl Iterator<Item = &DirectionalLight> {
    scene.lights.iter().filter_map(|light| match light {
        Light::Directional(light) => Some(light),
        _ => None,
    })
}

fn angle_rad(a: &DirectionalLight, b: &DirectionalLight) -> f64 {
    a.direction.to_vector().dot(b.direction.to_vector()).clamp(-1.0, 1.0).acos()
}

/// Whether two scenes are the same but for camera, time, directions of lights, and how they are shown.
fn same_but_moved(before: &Scene, now: &Scene) -> bool {
    let mut moved = before.clone();
    let (width, height) = (before.camera.width, before.camera.height);
    (moved.camera, moved.time_s, moved.display) = (now.camera, now.time_s, now.display);
    let pairs = moved.lights.iter_mut().zip(&now.lights);
    for (light, other) in pairs {
        if let (Light::Directional(light), Light::Directional(other)) = (light, other) {
            light.direction = other.direction;
        }
    }
    (width, height) == (now.camera.width, now.camera.height) && Fingerprint::of(&moved) == Fingerprint::of(now)
}

/// The pixel of a block of so many pixels a side, a power of two, that is marched as the n-th: neighbours in time lie far
/// apart (Bayer 1973).
pub fn pixel_of_block(side: u32, n: u32) -> [u32; 2] {
    const QUARTERS: [[u32; 2]; 4] = [[0, 0], [1, 1], [1, 0], [0, 1]];
    let (mut pixel, mut step, mut rest) = ([0; 2], side / 2, n);
    while step > 0 {
        let [x, y] = QUARTERS[(rest % 4) as usize];
        pixel = [pixel[0] + step * x, pixel[1] + step * y];
        (step, rest) = (step / 2, rest / 4);
    }
    pixel
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;

    fn scene() -> Scene {
        let text = "preset = \"earth\"\nsun = { elevation_deg = 40, azimuth_deg = 100 }\n\
            camera = { altitude_m = 2, elevation_deg = 10, azimuth_deg = 0, width = 8, height = 8 }\n\
            [[clouds]]\nkind = \"cumulus\"\n";
        Scene::parse(text, Path::new("clouds.toml")).unwrap()
    }

    #[test]
    fn every_pixel_of_a_block_comes_round_once() {
        for side in [1, 2, 4, 8] {
            let all: BTreeSet<_> = (0..side * side).map(|n| pixel_of_block(side, n)).collect();
            assert_eq!(all.len() as u32, side * side);
            assert!(all.iter().flatten().all(|&place| place < side));
        }
    }

    #[test]
    fn a_small_move_is_no_cut_and_every_other_change_is_one() {
        let before = scene();
        assert!(follows(&before, &before));
        let moved = |change: fn(&mut Scene)| {
            let mut now = before.clone();
            change(&mut now);
            follows(&before, &now)
        };
        assert!(moved(|now| now.camera.direction.azimuth_rad += 0.1));
        assert!(moved(|now| now.camera.altitude_m += 50.0));
        assert!(moved(|now| now.time_s += 1.0));
        assert!(!moved(|now| now.camera.direction.azimuth_rad += 1.0), "a turn to another view");
        assert!(!moved(|now| now.camera.altitude_m += 1000.0));
        assert!(!moved(|now| now.camera.width = 16));
        assert!(!moved(|now| now.time_s += 3600.0));
        assert!(!moved(|now| now.clouds[0].coverage += 0.01));
        assert!(!moved(|now| now.lights.clear()));
        assert!(!moved(|now| now.planet.ground_albedo = [0.9; 3]));
    }
}
