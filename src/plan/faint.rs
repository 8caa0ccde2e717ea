//! Which lights change nothing but the pixels of their own disc, and which not even those.

use std::f64::consts::FRAC_PI_2;

use welkin_lut::{Planet, geometry};

use super::Skipping;
use crate::scene::DirectionalLight;

/// Degrees of the light's descent below the horizon over which the sky loses a factor of ten, at least and at most:
/// clear twilight on Earth loses one in 2 to 3°.
const QUICKEST_DECADE_DEG: f64 = 2.0;
const SLOWEST_DECADE_DEG: f64 = 4.0;

/// Where the horizon lies deeper than this, some pixels may see another light's night, rad.
const DEEPEST_DIP_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// What becomes of a light.
#[derive(Debug, Clone, PartialEq)]
pub enum Reach {
    /// It lights the air and the ground.
    Lit,
    /// Only its disc is drawn; why.
    DiscOnly(String),
    /// It is left out; why.
    Unseen(String),
}

fn dip_rad(planet: &Planet, altitude_m: f64) -> f64 {
    geometry::horizon_mu(planet.radius_m, altitude_m).clamp(-1.0, 1.0).acos() - FRAC_PI_2
}

/// Irradiance times what is left of it below the horizon, when a decade takes so many degrees.
fn left_over(light: &DirectionalLight, decade_deg: f64) -> f64 {
    let below_deg = light.direction.elevation_rad.to_degrees().min(0.0);
    light.irradiance.iter().sum::<f64>() * 10_f64.powf(below_deg / decade_deg)
}

/// What becomes of a light among all that shine, seen from an altitude ≥ 0, m.
pub fn reach(
    light: &DirectionalLight,
    all: &[&DirectionalLight],
    planet: &Planet,
    altitude_m: f64,
    skipping: &Skipping,
) -> Reach {
    let dip = dip_rad(planet, altitude_m);
    // A view over the horizon leaves the air where the light stands higher by the angle to there, and lights the top
    // of the air while it stands lower than the ground's horizon by the same angle.
    let lowest_rad = dip + 2.0 * dip_rad(planet, planet.atmosphere_height_m) + light.angular_radius_rad;
    if light.direction.elevation_rad < -lowest_rad * skipping.unseen_depressions {
        let (depression, lowest) = (-light.direction.elevation_rad.to_degrees(), lowest_rad.to_degrees());
        return Reach::Unseen(format!(
            "{} stands {depression:.1}° down and lights no air in view below {lowest:.1}°",
            light.name
        ));
    }
    if dip > DEEPEST_DIP_RAD {
        return Reach::Lit;
    }
    let most = left_over(light, SLOWEST_DECADE_DEG);
    let outshines = |other: &&&DirectionalLight| most < skipping.faint_share * left_over(other, QUICKEST_DECADE_DEG);
    match all.iter().find(outshines) {
        Some(other) => Reach::DiscOnly(format!(
            "{} lights less than {} of what {} does: only its disc is drawn",
            light.name, skipping.faint_share, other.name
        )),
        None => Reach::Lit,
    }
}
