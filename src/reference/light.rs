//! Sources of light as an estimator sees them: sampled directions, radiance, probability densities.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use welkin_lut::Bands;

use super::matter::around;
use crate::scene::{Cone, Light, LitSphere};

/// A source outside the medium.
#[derive(Debug, Clone, PartialEq)]
pub enum Emitter {
    /// Exactly parallel rays.
    Beam {
        /// Unit vector to the source.
        toward: DVec3,
        /// On a plane normal to the beam, W·m⁻²·nm⁻¹.
        irradiance: Bands,
    },
    /// A disc at infinity.
    Disc {
        /// Unit vector to its centre.
        toward: DVec3,
        /// On a plane normal to its centre, W·m⁻²·nm⁻¹.
        irradiance: Bands,
        /// Angular radius, rad.
        radius_rad: f64,
        /// k of its radiance, μ^k; see `DirectionalLight::limb_exponent`.
        limb_exponent: Bands,
        /// Takes the place of the limb's law where it is a sphere lit from one side.
        sphere: Option<LitSphere>,
    },
    /// A point.
    Point {
        /// Where, m.
        position_m: DVec3,
        /// W·sr⁻¹·nm⁻¹.
        intensity: Bands,
        /// What it shines into.
        cone: Option<Cone>,
    },
    /// Uniform surroundings.
    Environment {
        /// W·m⁻²·sr⁻¹·nm⁻¹.
        radiance: Bands,
    },
}

/// One direction towards a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSample {
    /// Unit vector towards the light.
    pub direction: DVec3,
    /// Distance to the light, m; infinite outside the world.
    pub distance_m: f64,
    /// Radiance over probability density: what a unit of response per steradian receives, W·m⁻²·nm⁻¹.
    pub irradiance: Bands,
    /// Density of this direction per steradian; `None` when no other way of sampling can find it.
    pub pdf_per_sr: Option<f64>,
}

/// 1 - cos of a disc's angular radius, without cancellation.
fn disc_height(radius_rad: f64) -> f64 {
    2.0 * (0.5 * radius_rad).sin().powi(2)
}

/// Radiance of a disc relative to its mean, at the squared sine of the angle from its centre relative to that of its
/// limb.
pub(super) fn limb_factor(exponent: f64, relative_squared: f64) -> f64 {
    0.5 * (2.0 + exponent) * (1.0 - relative_squared).max(0.0).powf(0.5 * exponent)
}

impl Emitter {
    /// The scene's light at a time.
    pub fn new(light: &Light, time_s: f64) -> Self {
        match light {
            Light::Directional(sun) if sun.angular_radius_rad == 0.0 => {
                Self::Beam { toward: sun.direction.to_vector(), irradiance: sun.irradiance }
            }
            Light::Directional(sun) => Self::Disc {
                toward: sun.direction.to_vector(),
                irradiance: sun.irradiance,
                radius_rad: sun.angular_radius_rad,
                limb_exponent: sun.limb_exponent(),
                sphere: sun.sphere,
            },
            Light::Point(point) => {
                Self::Point { position_m: point.position_m, intensity: point.intensity_at(time_s), cone: point.cone }
            }
            Light::Environment(sky) => Self::Environment { radiance: sky.radiance },
        }
    }

    /// Where a directional light stands.
    pub fn toward(&self) -> Option<DVec3> {
        match *self {
            Self::Beam { toward, .. } | Self::Disc { toward, .. } => Some(toward),
            _ => None,
        }
    }

    /// The same light, standing elsewhere if it is directional.
    pub fn moved(&self, direction: DVec3) -> Self {
        let mut light = self.clone();
        if let Self::Beam { toward, .. } | Self::Disc { toward, .. } = &mut light {
            *toward = direction;
        }
        light
    }

    /// A direction from `p` to the light, from two numbers in [0, 1[.
    pub fn sample(&self, p: DVec3, u: f64, v: f64) -> LightSample {
        match *self {
            Self::Beam { toward, irradiance } => {
                LightSample { direction: toward, distance_m: f64::INFINITY, irradiance, pdf_per_sr: None }
            }
            Self::Disc { toward, radius_rad, .. } => {
                let height = disc_height(radius_rad);
                let direction = around(toward, 1.0 - u * height, v).normalize();
                let pdf = 1.0 / (TAU * height);
                let irradiance = self.disc_radiance(direction).map(|l| l / pdf);
                LightSample { direction, distance_m: f64::INFINITY, irradiance, pdf_per_sr: Some(pdf) }
            }
            Self::Point { position_m, intensity, cone } => {
                let offset = position_m - p;
                let squared = offset.length_squared();
                let distance_m = squared.sqrt();
                let direction = offset / distance_m;
                let share = cone.map_or(1.0, |cone| cone.share(-direction.dot(cone.axis.to_vector())));
                let irradiance = intensity.map(|i| share * i / squared);
                LightSample { direction, distance_m, irradiance, pdf_per_sr: None }
            }
            Self::Environment { radiance } => {
                let direction = around(DVec3::Z, 1.0 - 2.0 * u, v);
                let irradiance = radiance.map(|l| l * 4.0 * PI);
                LightSample { direction, distance_m: f64::INFINITY, irradiance, pdf_per_sr: Some(0.25 / PI) }
            }
        }
    }

    /// Radiance of a disc in a direction within it.
    fn disc_radiance(&self, direction: DVec3) -> Bands {
        let Self::Disc { toward, irradiance, radius_rad, limb_exponent, sphere } = *self else { return [0.0; 3] };
        if let Some(sphere) = sphere {
            let offset = (direction - direction.dot(toward) * toward) / radius_rad.sin();
            let profile = sphere.profile(toward, offset.clamp_length_max(1.0));
            return std::array::from_fn(|band| profile[band] * irradiance[band] / radius_rad.sin().powi(2));
        }
        // 1 - cos of the angle from the centre, relative to that of the limb.
        let relative_height = 0.5 * (direction - toward).length_squared() / disc_height(radius_rad);
        // A uniform disc of radiance L gives π sin²α L on a plane normal to its centre.
        let projected = PI * radius_rad.sin().powi(2);
        std::array::from_fn(|band| limb_factor(limb_exponent[band], relative_height) * irradiance[band] / projected)
    }

    /// Radiance arriving from a direction of space, and the density with which `sample` would choose it; `None` when
    /// the light is not there or cannot be hit.
    pub fn radiance(&self, direction: DVec3) -> Option<(Bands, f64)> {
        match *self {
            Self::Environment { radiance } => Some((radiance, 0.25 / PI)),
            Self::Disc { toward, radius_rad, .. } => {
                let height = 0.5 * (direction - toward).length_squared();
                let limb = disc_height(radius_rad);
                (height <= limb).then(|| (self.disc_radiance(direction), 1.0 / (TAU * limb)))
            }
            _ => None,
        }
    }
}
