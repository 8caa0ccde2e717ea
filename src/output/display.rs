//! From linear radiance to a picture on a screen; `display.wgsl` is the same in f32.

use welkin_lut::{BAND_COUNT, Bands};

use crate::scene::{Light, Scene};

/// What radiance is multiplied by before the tone map: 2^EV, and a white balance in which the first directional light
/// is white above the air, as a camera set to daylight sees it.
pub fn exposure(scene: &Scene) -> Bands {
    let white = scene.lights.iter().find_map(|light| match light {
        Light::Directional(light) if light.irradiance.iter().all(|&e| e > 0.0) => Some(light.irradiance),
        _ => None,
    });
    let white = white.unwrap_or([1.0; BAND_COUNT]);
    let mean = white.iter().sum::<f64>() / BAND_COUNT as f64;
    white.map(|irradiance| scene.display.exposure_ev.exp2() * mean / irradiance)
}
