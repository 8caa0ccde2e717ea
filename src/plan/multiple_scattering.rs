//! Which method computes light of the second and later orders, and the rule that chooses it.

use std::fmt;
use std::str::FromStr;

use welkin_lut::{BAND_COUNT, Constituent};

use super::Settings;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum MultipleScattering {
    /// What the air calls for, by the rule in this file.
    #[default]
    Auto,
    /// All orders from the second on are isotropic and the same everywhere around a point, so that they are a geometric
    /// series: Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", CGF 39. For
    /// comparison, and for engines that want it.
    IsotropicSeries,
    /// Order by order, as a few spherical harmonics of the field.
    Harmonics,
    /// Order by order, as the source function in many directions: for haze that scatters forward.
    SourceFunction,
}

/// What is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Treatment {
    /// [`MultipleScattering::IsotropicSeries`].
    IsotropicSeries,
    /// [`MultipleScattering::Harmonics`].
    Harmonics,
    /// [`MultipleScattering::SourceFunction`].
    SourceFunction,
}

impl MultipleScattering {
    /// All that can be asked for.
    pub const ALL: [Self; 4] = [Self::Auto, Self::IsotropicSeries, Self::Harmonics, Self::SourceFunction];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::IsotropicSeries => "isotropic-series",
            Self::Harmonics => "harmonics",
            Self::SourceFunction => "source-function",
        }
    }
}

impl fmt::Display for MultipleScattering {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// A method of that name does not exist.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("multiple scattering is '{0}'; it must be one of auto, isotropic-series, harmonics, source-function")]
pub struct UnknownMultipleScattering(String);

impl FromStr for MultipleScattering {
    type Err = UnknownMultipleScattering;

    fn from_str(name: &str) -> Result<Self, UnknownMultipleScattering> {
        let unknown = || UnknownMultipleScattering(name.to_owned());
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or_else(unknown)
    }
}

/// How much the sky rings, relative to its own light, when spherical harmonics of the field end before `degree_count`.
///
/// Light scattered once by haze has a glow around the sun, and that glow scattered again is what degrees l ≥ n carry:
/// in units of the optical depth τ_c of each constituent's scattering, √(2n + 1) |χ_n|, twice. Over all light that
/// scatters: (Σ τ_c √(2n + 1) |χ_n,c|)² / Σ τ_c, the largest of the bands. The examples' `haze_sweep` compares it with
/// the error itself; docs/accuracy.md has its table.
pub fn expected_ringing(scatterers: &[&Constituent], top_m: f64, degree_count: u32) -> f64 {
    let peak =
        |c: &Constituent| f64::from(2 * degree_count + 1).sqrt() * c.phase.legendre_moment(degree_count as usize);
    let depth = |c: &Constituent, band: usize| c.scattering_per_m[band] * c.profile.column_m(top_m);
    let in_band = |band: usize| {
        let all: f64 = scatterers.iter().map(|c| depth(c, band)).sum();
        let peaked: f64 = scatterers.iter().map(|c| depth(c, band) * peak(c).abs()).sum();
        if all > 0.0 { peaked * peaked / all } else { 0.0 }
    };
    (0..BAND_COUNT).map(in_band).fold(0.0, f64::max)
}

/// How far off single views are whose whole path lies in the planet's shadow, when spherical harmonics of the field end
/// before `degree_count`: all of their light comes from a narrow arch at the horizon. The worst of the 99th percentiles
/// of one sun between 92 and 102° that docs/accuracy.md has for clear air.
pub fn error_in_shadow(degree_count: u32) -> f64 {
    if degree_count < 5 { 0.31 } else { 0.14 }
}

impl Treatment {
    /// What is done about what is asked for, and why.
    pub fn choose(settings: &Settings, scatterers: &[&Constituent], top_m: f64) -> (Self, String) {
        let by_name = |treatment| (treatment, "asked for by name".to_owned());
        match settings.multiple_scattering {
            MultipleScattering::IsotropicSeries => by_name(Self::IsotropicSeries),
            MultipleScattering::Harmonics => by_name(Self::Harmonics),
            MultipleScattering::SourceFunction => by_name(Self::SourceFunction),
            MultipleScattering::Auto => {
                let ringing = expected_ringing(scatterers, top_m, settings.degree_count);
                let (highest, limit) = (settings.degree_count - 1, settings.ringing_limit);
                let estimate = format!("{:.2} % (limit {:.2} %)", 100.0 * ringing, 100.0 * limit);
                if ringing > limit {
                    let reason = format!(
                        "haze scatters forward, and degrees 0 to {highest} of spherical harmonics would ring by about {estimate}"
                    );
                    return (Self::SourceFunction, reason);
                }
                let (dark, limit) = (error_in_shadow(settings.degree_count), settings.shadow_limit);
                if dark > limit {
                    let reason = format!(
                        "with degrees 0 to {highest} of spherical harmonics views into the planet's shadow would be off by up to {:.0} % (limit {:.1} %)",
                        100.0 * dark,
                        100.0 * limit
                    );
                    return (Self::SourceFunction, reason);
                }
                let reason =
                    format!("degrees 0 to {highest} of spherical harmonics are enough; they ring by about {estimate}");
                (Self::Harmonics, reason)
            }
        }
    }

    /// What it computes, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::IsotropicSeries => "Hillaire's isotropic series",
            Self::Harmonics => "spherical harmonics of the field",
            Self::SourceFunction => "the source function in many directions",
        }
    }
}

#[cfg(test)]
mod tests {
    use welkin_lut::Planet;

    use super::*;
    use crate::plan::Quality;

    #[test]
    fn the_most_directions_fit_into_what_a_workgroup_shares() {
        let most = Settings::of(Quality::Ultra).source_grid.on(&Planet {
            radius_m: 1e12,
            atmosphere_height_m: 1e5,
            ground_albedo: [0.0; 3],
        });
        assert!(32 * most.count() <= 16384, "{most:?}");
    }
}
