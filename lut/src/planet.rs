//! The solid sphere below an atmosphere and the shell that bounds it.

use crate::{BAND_COUNT, BAND_NAMES, Bands};

/// A spherical planet: a Lambertian ground under a shell of air.
#[derive(Debug, Clone, PartialEq)]
pub struct Planet {
    /// Distance from the centre to the ground, m.
    pub radius_m: f64,
    /// Altitude above which the medium is taken to be vacuum, m.
    pub atmosphere_height_m: f64,
    /// Lambertian reflectance of the ground, each in [0, 1].
    pub ground_albedo: Bands,
}

/// Why a planet cannot exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanetError {
    /// The radius is not a positive, finite length.
    #[error("planet radius is {0} m; it must be finite and above 0")]
    Radius(f64),
    /// The atmosphere's top does not lie above the ground.
    #[error("atmosphere height is {0} m; the top must lie above the ground, at a finite altitude")]
    AtmosphereHeight(f64),
    /// The ground reflects less than nothing or more than all light.
    #[error("ground albedo in band {band} is {value}; it must lie in [0, 1]")]
    GroundAlbedo {
        /// Name of the band.
        band: &'static str,
        /// The value refused.
        value: f64,
    },
}

impl Planet {
    /// Checks every number, so that what follows never has to.
    pub fn validate(&self) -> Result<(), PlanetError> {
        if !(self.radius_m.is_finite() && self.radius_m > 0.0) {
            return Err(PlanetError::Radius(self.radius_m));
        }
        if !(self.atmosphere_height_m.is_finite() && self.atmosphere_height_m > 0.0) {
            return Err(PlanetError::AtmosphereHeight(self.atmosphere_height_m));
        }
        for (band, value) in (0..BAND_COUNT).map(|i| (BAND_NAMES[i], self.ground_albedo[i])) {
            if !(0.0..=1.0).contains(&value) {
                return Err(PlanetError::GroundAlbedo { band, value });
            }
        }
        Ok(())
    }

    /// The angle from the horizon at which the top of the air is seen from the ground, or lit from below it, rad: √(2 top /
    /// radius) while that is small. Night falls within a few of them.
    pub fn reach_rad(&self) -> f64 {
        (2.0 * self.atmosphere_height_m / self.radius_m).sqrt()
    }
}
