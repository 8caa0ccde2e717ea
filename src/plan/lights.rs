//! Lights by what they reach.

use super::faint::{Reach, reach};
use super::{PlanError, Skipping};
use crate::scene::{DirectionalLight, Light, PointLight, Scene};

/// Lights by what they reach.
#[derive(Default)]
pub(super) struct SortedLights<'a> {
    /// Those that light what is in the picture.
    pub lit: Vec<&'a DirectionalLight>,
    /// Those of which only the disc is seen.
    pub faint_discs: Vec<&'a DirectionalLight>,
    /// Why lights are in none or only the second of these lists.
    pub left_out: Vec<String>,
}

/// Which of the lights that shine show in the picture, and in what.
pub(super) fn sort_lights<'a>(
    shining: &[&'a DirectionalLight],
    scene: &Scene,
    skipping: &Skipping,
) -> SortedLights<'a> {
    let mut sorted = SortedLights::default();
    for light in shining {
        match reach(light, shining, &scene.planet, scene.camera.altitude_m.max(0.0), skipping) {
            Reach::Lit => sorted.lit.push(light),
            Reach::DiscOnly(reason) => {
                sorted.faint_discs.push(light);
                sorted.left_out.push(reason);
            }
            Reach::Unseen(reason) => sorted.left_out.push(reason),
        }
    }
    sorted
}

/// Point and spot lights that shine at the scene's time, by name.
pub(super) fn local_lights(scene: &Scene) -> Vec<PointLight> {
    let lights = scene.lights.iter().filter_map(|light| match light {
        Light::Point(light) => {
            Some(PointLight { intensity: light.intensity_at(scene.time_s), flash: None, ..light.clone() })
        }
        _ => None,
    });
    let lights = lights.filter(|light| light.intensity.iter().any(|&i| i > 0.0));
    let mut lights: Vec<_> = lights.collect();
    lights.sort_by(|a, b| a.name.cmp(&b.name));
    lights
}

/// Directional lights that shine.
///
/// # Errors
/// [`PlanError::Unsupported`] for light from all sides.
pub(super) fn shining_lights(scene: &Scene) -> Result<Vec<&DirectionalLight>, PlanError> {
    let mut lights = Vec::new();
    for light in &scene.lights {
        match light {
            Light::Directional(light) if light.irradiance.iter().any(|&e| e > 0.0) => lights.push(light),
            Light::Directional(_) => {}
            Light::Point(_) => {}
            Light::Environment(_) => {
                return Err(PlanError::Unsupported { what: "the scene has an environment light".to_owned() });
            }
        }
    }
    Ok(lights)
}
