//! Whether the width of a light's disc matters.
//!
//! Light is averaged over a disc where that changes some pixel by more than half a per cent. Measured with the sun's
//! disc and the preset `earth` (docs/accuracy.md): with the sun 1° above the horizon 0.4 % at most, at 0.5° 0.6 %, at 2°
//! 0.4 % in one view beside the horizon and else 0.1 %. The change grows with the square of the radius, so that the
//! elevation where it matters grows with the radius, and that of a disc of 0.1° stays below a quarter per cent seen from the
//! ground. From high up a light at the limb shines through air that weakens it by another factor in each hundredth of a
//! degree: 45 km up a disc of 0.07° changed a pixel by 5.3 % (`examples/skipping_sweep.rs`). Discs of 0.02° and less are beams,
//! which by the square of the radius is worth 0.43 % there.

use std::f64::consts::FRAC_PI_2;

use welkin_lut::{Planet, geometry};

use super::Skipping;
use crate::scene::DirectionalLight;

/// Whether pixels change when light is averaged over a light's disc, seen from an altitude ≥ 0, m.
///
/// From high up the ground under the horizon lies elsewhere: there the light stands lower by the dip of the horizon.
pub fn is_wide(light: &DirectionalLight, planet: &Planet, altitude_m: f64, skipping: &Skipping) -> bool {
    let radius_rad = light.angular_radius_rad;
    let dip_rad = geometry::horizon_mu(planet.radius_m, altitude_m).clamp(-1.0, 1.0).acos() - FRAC_PI_2;
    radius_rad >= skipping.narrowest_disc_rad
        && light.direction.elevation_rad <= skipping.beam_above_radii * radius_rad + dip_rad
}
