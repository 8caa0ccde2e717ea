//! How a constituent's density varies with altitude.

/// Density relative to the value that a constituent's coefficients are given for; never negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DensityProfile {
    /// exp(-h / H): gases and haze in hydrostatic balance.
    Exponential {
        /// H, the altitude over which density falls by e, m.
        scale_height_m: f64,
    },
    /// max(0, 1 - |h - h₀| / w): the ozone layer.
    Tent {
        /// h₀, the altitude of full density, m.
        centre_m: f64,
        /// w, the distance from the centre at which density reaches zero, m.
        half_width_m: f64,
    },
    /// 1 between two altitudes, 0 elsewhere: a homogeneous layer.
    Layer {
        /// Lower boundary, m.
        bottom_m: f64,
        /// Upper boundary, m.
        top_m: f64,
    },
}

/// Why a profile cannot exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// A length that must be positive and finite is not.
    #[error("{field} is {value} m; it must be finite and above 0")]
    NotPositive {
        /// Name of the field.
        field: &'static str,
        /// The value refused.
        value: f64,
    },
    /// An altitude is NaN or infinite.
    #[error("{field} is {value} m; it must be finite")]
    NotFinite {
        /// Name of the field.
        field: &'static str,
        /// The value refused.
        value: f64,
    },
    /// A layer whose top does not lie above its bottom.
    #[error("top_m is {top_m} m; it must lie above bottom_m, {bottom_m} m")]
    TopBelowBottom {
        /// Lower boundary, m.
        bottom_m: f64,
        /// Upper boundary, m.
        top_m: f64,
    },
}

impl DensityProfile {
    /// Relative density at an altitude in metres; altitudes below ground count as ground.
    pub fn density(&self, altitude_m: f64) -> f64 {
        let h = altitude_m.max(0.0);
        match *self {
            Self::Exponential { scale_height_m } => (-h / scale_height_m).exp(),
            Self::Tent { centre_m, half_width_m } => (1.0 - (h - centre_m).abs() / half_width_m).max(0.0),
            Self::Layer { bottom_m, top_m } => f64::from((bottom_m..=top_m).contains(&h)),
        }
    }

    /// ∫ density dh from the ground to an altitude: metres of air at density 1.
    pub fn column_m(&self, top_m: f64) -> f64 {
        match *self {
            Self::Exponential { scale_height_m } => -scale_height_m * (-top_m / scale_height_m).exp_m1(),
            Self::Tent { centre_m, half_width_m } => {
                // Of the rising or falling half, the share below an offset from the centre.
                let below = |h: f64| {
                    let x = ((h - centre_m) / half_width_m).clamp(-1.0, 1.0);
                    half_width_m * (0.5 + x - 0.5 * x * x.abs())
                };
                below(top_m) - below(0.0)
            }
            Self::Layer { bottom_m, top_m: end_m } => (end_m.min(top_m) - bottom_m.max(0.0)).max(0.0),
        }
    }

    /// The largest relative density between two altitudes, a bound that holds exactly.
    pub fn majorant(&self, low_m: f64, high_m: f64) -> f64 {
        match *self {
            Self::Exponential { .. } => self.density(low_m),
            Self::Tent { centre_m, .. } => self.density(centre_m.clamp(low_m, high_m)),
            Self::Layer { bottom_m, top_m } => f64::from(low_m <= top_m && high_m >= bottom_m),
        }
    }

    /// The smallest relative density between two altitudes, a bound that holds exactly.
    pub fn minorant(&self, low_m: f64, high_m: f64) -> f64 {
        match *self {
            Self::Layer { bottom_m, top_m } => f64::from(low_m >= bottom_m && high_m <= top_m),
            // Both are unimodal, so the smallest value lies at an end.
            _ => self.density(low_m).min(self.density(high_m)),
        }
    }

    /// Altitudes at which the profile has a kink or a jump, where quadrature should split, m.
    pub fn breakpoints_m(&self) -> Vec<f64> {
        match *self {
            Self::Exponential { .. } => vec![],
            Self::Tent { centre_m, half_width_m } => vec![centre_m - half_width_m, centre_m, centre_m + half_width_m],
            Self::Layer { bottom_m, top_m } => vec![bottom_m, top_m],
        }
    }

    /// Checks every number, so that what follows never has to.
    pub fn validate(&self) -> Result<(), ProfileError> {
        let positive = |field, value: f64| {
            if value.is_finite() && value > 0.0 { Ok(()) } else { Err(ProfileError::NotPositive { field, value }) }
        };
        let finite = |field, value: f64| {
            if value.is_finite() { Ok(()) } else { Err(ProfileError::NotFinite { field, value }) }
        };
        match *self {
            Self::Exponential { scale_height_m } => positive("scale_height_m", scale_height_m),
            Self::Tent { centre_m, half_width_m } => {
                finite("centre_m", centre_m)?;
                positive("half_width_m", half_width_m)
            }
            Self::Layer { bottom_m, top_m } => {
                finite("bottom_m", bottom_m)?;
                finite("top_m", top_m)?;
                if top_m > bottom_m { Ok(()) } else { Err(ProfileError::TopBelowBottom { bottom_m, top_m }) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::DensityProfile;

    const PROFILES: [DensityProfile; 3] = [
        DensityProfile::Exponential { scale_height_m: 1200.0 },
        DensityProfile::Tent { centre_m: 25_000.0, half_width_m: 15_000.0 },
        DensityProfile::Layer { bottom_m: 300.0, top_m: 700.0 },
    ];

    #[test]
    fn density_lies_between_its_bounds_on_every_interval() {
        for profile in PROFILES {
            for i in 0..60 {
                let (low, high) = (f64::from(i) * 777.0, f64::from(i + 1) * 777.0);
                for j in 0..=20 {
                    let density = profile.density(low + (high - low) * f64::from(j) / 20.0);
                    assert!(density <= profile.majorant(low, high), "{profile:?} at {low}");
                    assert!(density >= profile.minorant(low, high), "{profile:?} at {low}");
                }
            }
        }
    }

    #[test]
    fn a_column_is_the_integral_of_density() {
        for profile in PROFILES {
            for top_m in [0.0, 500.0, 20_000.0, 30_000.0, 100_000.0] {
                let n = 200_000;
                let step_m = top_m / f64::from(n);
                let sum: f64 = (0..n).map(|i| profile.density((f64::from(i) + 0.5) * step_m)).sum();
                // A jump of density can fall anywhere in a step.
                let error_m = (profile.column_m(top_m) - sum * step_m).abs();
                assert!(error_m <= step_m, "{profile:?} to {top_m} m: {error_m} m off");
            }
        }
    }
}
