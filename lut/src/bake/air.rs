//! The air that tables are made of.

use crate::phase::PhaseLobe;
use crate::{BAND_COUNT, Bands, Constituent, DensityProfile, Medium, MediumError, PhaseFunction, Planet, PlanetError};

/// Scatterers that shaders have room for.
pub const MAX_SCATTERERS: usize = 8;

/// A planet with its air, checked and in the order in which shaders count.
#[derive(Debug, Clone, PartialEq)]
pub struct Air {
    planet: Planet,
    /// Those that scatter, then those that only absorb.
    constituents: Vec<Constituent>,
    scatterer_count: usize,
}

/// Why tables cannot be made of an air.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AirError {
    /// The planet is impossible.
    #[error(transparent)]
    Planet(#[from] PlanetError),
    /// The medium is impossible.
    #[error(transparent)]
    Medium(#[from] MediumError),
    /// A phase function is a table.
    #[error(
        "constituent '{0}' has a tabulated phase function; shaders evaluate closed forms only, so choose one of them"
    )]
    TabulatedPhase(String),
    /// A constituent has sharp bounds, at which tables would blur its optical depth.
    #[error(
        "constituent '{0}' is a layer with sharp bounds, which tables would blur; choose an exponential or tent profile"
    )]
    Layer(String),
    /// Nothing scatters.
    #[error("no constituent scatters in any band; there is no sky to tabulate")]
    NothingScatters,
    /// There are too many scatterers.
    #[error("{0} constituents scatter; tables hold at most {MAX_SCATTERERS}, so join those that are alike")]
    TooManyScatterers(usize),
}

impl Air {
    /// Checks everything, and leaves out what does nothing to light. Emission is not tabulated.
    ///
    /// # Errors
    /// [`AirError`] with what is wrong and what is allowed.
    pub fn new(planet: &Planet, medium: &Medium) -> Result<Self, AirError> {
        planet.validate()?;
        medium.validate()?;
        let weakens = |c: &&Constituent| c.extinction_per_m().iter().any(|&c| c > 0.0);
        let mut constituents: Vec<_> = medium.constituents.iter().filter(weakens).cloned().collect();
        if let Some(layer) = constituents.iter().find(|c| matches!(c.profile, DensityProfile::Layer { .. })) {
            return Err(AirError::Layer(layer.name.clone()));
        }
        constituents.sort_by_key(|c| (!c.scatters(), profile_rank(&c.profile)));
        let scatterers = constituents.iter().filter(|c| c.scatters());
        if let Some(tabulated) = scatterers.clone().find(|c| matches!(c.phase, PhaseFunction::Tabulated(_))) {
            return Err(AirError::TabulatedPhase(tabulated.name.clone()));
        }
        let scatterer_count = scatterers.count();
        if scatterer_count == 0 {
            return Err(AirError::NothingScatters);
        }
        if scatterer_count > MAX_SCATTERERS {
            return Err(AirError::TooManyScatterers(scatterer_count));
        }
        Ok(Self { planet: planet.clone(), constituents, scatterer_count })
    }

    /// The planet.
    pub fn planet(&self) -> &Planet {
        &self.planet
    }

    /// Constituents that scatter, in the order of the tables' layers.
    pub fn scatterers(&self) -> &[Constituent] {
        &self.constituents[..self.scatterer_count]
    }

    /// The lobes of each scatterer's phase function.
    pub fn phase_lobes(&self) -> Vec<Vec<PhaseLobe>> {
        self.scatterers().iter().map(|c| c.phase.lobes()).collect()
    }

    /// Of each scatterer: the number of its density profile among those of all, counted as new ones appear.
    pub(super) fn profile_groups(&self) -> Vec<usize> {
        let mut profiles: Vec<DensityProfile> = Vec::new();
        let mut number_of = |profile: &DensityProfile| {
            profiles.iter().position(|other| other == profile).unwrap_or_else(|| {
                profiles.push(*profile);
                profiles.len() - 1
            })
        };
        self.scatterers().iter().map(|constituent| number_of(&constituent.profile)).collect()
    }

    /// Constituents whose density is a tent: altitude of its centre, half its width, m, and extinction at density 1.
    pub(super) fn tents(&self) -> impl Iterator<Item = (f64, f64, Bands)> {
        self.constituents.iter().filter_map(|constituent| match constituent.profile {
            DensityProfile::Tent { centre_m, half_width_m } => {
                Some((centre_m, half_width_m, constituent.extinction_per_m()))
            }
            _ => None,
        })
    }

    /// Extinction of all but the tents.
    pub(super) fn extinction_without_tents_per_m(&self, altitude_m: f64) -> Bands {
        let mut sum = [0.0; BAND_COUNT];
        let is_smooth = |c: &&Constituent| !matches!(c.profile, DensityProfile::Tent { .. });
        for constituent in self.constituents.iter().filter(is_smooth) {
            let density = constituent.profile.density(altitude_m);
            for (sum, c) in sum.iter_mut().zip(constituent.extinction_per_m()) {
                *sum += c * density;
            }
        }
        sum
    }

    /// Scattering coefficients of each scatterer at an altitude, 1/m.
    pub(super) fn scattering_per_m(&self, altitude_m: f64) -> impl Iterator<Item = Bands> {
        self.scatterers().iter().map(move |c| {
            let density = c.profile.density(altitude_m);
            c.scattering_per_m.map(|b| b * density)
        })
    }
}

/// The shaders' order of profiles.
fn profile_rank(profile: &DensityProfile) -> u8 {
    match profile {
        DensityProfile::Exponential { .. } => 0,
        DensityProfile::Tent { .. } => 1,
        DensityProfile::Layer { .. } => 2,
    }
}
