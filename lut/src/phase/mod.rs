//! Phase functions: how scattered light is spread over directions.
//!
//! Each is normalised, ∫P dω = 1, and takes cos θ, where θ is the angle between the directions in which the light
//! travels before and after: cos θ = 1 is forward.

use std::f64::consts::PI;

/// A phase function P(cos θ), 1/sr.
#[derive(Debug, Clone, PartialEq)]
pub enum PhaseFunction {
    /// 1/4π.
    Isotropic,
    /// Molecules (Premože 2003, eq. 5 without its λ⁻⁴, which belongs to b).
    Rayleigh,
    /// Henyey & Greenstein 1941 (Premože 2003, eq. 2).
    HenyeyGreenstein {
        /// Mean cosine.
        g: f64,
    },
    /// Cornette & Shanks 1992 (Premože 2003, eq. 6).
    CornetteShanks {
        /// Asymmetry parameter; the mean cosine is larger.
        g: f64,
    },
}

/// Why a phase function cannot exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PhaseError {
    /// A parameter lies outside its domain.
    #[error("{parameter} is {value}; it must lie in {allowed}")]
    Domain {
        /// Name of the parameter.
        parameter: &'static str,
        /// The value refused.
        value: f64,
        /// The domain in words.
        allowed: &'static str,
    },
}

impl PhaseFunction {
    /// P(cos θ), 1/sr.
    pub fn value(&self, cos_theta: f64) -> f64 {
        let henyey_greenstein = |g: f64| {
            let d = 1.0 + g * g - 2.0 * g * cos_theta;
            (1.0 - g * g) / (4.0 * PI * d * d.sqrt())
        };
        match *self {
            Self::Isotropic => 0.25 / PI,
            Self::Rayleigh => 3.0 / (16.0 * PI) * (1.0 + cos_theta * cos_theta),
            Self::HenyeyGreenstein { g } => henyey_greenstein(g),
            Self::CornetteShanks { g } => 1.5 * (1.0 + cos_theta * cos_theta) / (2.0 + g * g) * henyey_greenstein(g),
        }
    }

    /// Checks the parameters, so that what follows never has to.
    pub fn validate(&self) -> Result<(), PhaseError> {
        match *self {
            Self::HenyeyGreenstein { g } | Self::CornetteShanks { g } if !(g.abs() < 1.0) => {
                Err(PhaseError::Domain { parameter: "g", value: g, allowed: "]-1, 1[" })
            }
            _ => Ok(()),
        }
    }
}
