//! What the air is made of: a list of constituents, each with coefficients, a density profile and a phase function.

use crate::{BAND_COUNT, BAND_NAMES, Bands, DensityProfile, PhaseError, PhaseFunction, ProfileError};

/// One kind of matter in the air. In the notation of Premože 2003: a, b and L_e at density 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Constituent {
    /// What it is called in messages, in `explain` and in table manifests.
    pub name: String,
    /// b, scattering coefficient at density 1, 1/m.
    pub scattering_per_m: Bands,
    /// a, absorption coefficient at density 1, 1/m.
    pub absorption_per_m: Bands,
    /// a·L_e, radiance emitted per metre at density 1, W·m⁻²·sr⁻¹·nm⁻¹ per m.
    pub emission_per_m: Bands,
    /// Density relative to the coefficients above.
    pub profile: DensityProfile,
    /// P, how scattered light is spread over directions.
    pub phase: PhaseFunction,
}

/// All matter between the ground and the top of the atmosphere. An empty list is vacuum.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Medium {
    /// The constituents; their order has no meaning.
    pub constituents: Vec<Constituent>,
}

/// Why a medium cannot exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MediumError {
    /// A coefficient is negative, NaN or infinite.
    #[error("constituent '{constituent}': {field} in band {band} is {value}; it must be finite and at least 0")]
    Coefficient {
        /// Name of the constituent.
        constituent: String,
        /// Name of the field.
        field: &'static str,
        /// Name of the band.
        band: &'static str,
        /// The value refused.
        value: f64,
    },
    /// The density profile is impossible.
    #[error("constituent '{constituent}': {source}")]
    Profile {
        /// Name of the constituent.
        constituent: String,
        /// What is wrong with it.
        source: ProfileError,
    },
    /// The phase function is impossible.
    #[error("constituent '{constituent}': {source}")]
    Phase {
        /// Name of the constituent.
        constituent: String,
        /// What is wrong with it.
        source: PhaseError,
    },
}

impl Constituent {
    /// c = a + b at density 1, 1/m.
    pub fn extinction_per_m(&self) -> Bands {
        std::array::from_fn(|band| self.scattering_per_m[band] + self.absorption_per_m[band])
    }

    /// Whether it scatters in any band.
    pub fn scatters(&self) -> bool {
        self.scattering_per_m.iter().any(|&b| b > 0.0)
    }

    /// Whether it emits in any band.
    pub fn emits(&self) -> bool {
        self.emission_per_m.iter().any(|&e| e > 0.0)
    }

    /// Checks every number, so that what follows never has to.
    pub fn validate(&self) -> Result<(), MediumError> {
        let fields = [
            ("scattering_per_m", &self.scattering_per_m),
            ("absorption_per_m", &self.absorption_per_m),
            ("emission_per_m", &self.emission_per_m),
        ];
        for (field, values) in fields {
            for (band, &value) in values.iter().enumerate() {
                if !(value.is_finite() && value >= 0.0) {
                    let (constituent, band) = (self.name.clone(), BAND_NAMES[band]);
                    return Err(MediumError::Coefficient { constituent, field, band, value });
                }
            }
        }
        let constituent = || self.name.clone();
        self.profile.validate().map_err(|source| MediumError::Profile { constituent: constituent(), source })?;
        self.phase.validate().map_err(|source| MediumError::Phase { constituent: constituent(), source })
    }
}

impl Medium {
    /// c, extinction at an altitude, 1/m.
    pub fn extinction_per_m(&self, altitude_m: f64) -> Bands {
        let mut extinction = [0.0; BAND_COUNT];
        for constituent in &self.constituents {
            let density = constituent.profile.density(altitude_m);
            for (sum, c) in extinction.iter_mut().zip(constituent.extinction_per_m()) {
                *sum += c * density;
            }
        }
        extinction
    }

    /// Checks every constituent.
    pub fn validate(&self) -> Result<(), MediumError> {
        self.constituents.iter().try_for_each(Constituent::validate)
    }
}
