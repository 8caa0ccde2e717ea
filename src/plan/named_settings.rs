//! Settings by name: the qualities, and others' settings for comparisons of speed.

use std::fmt;
use std::str::FromStr;

use super::{Directions, MultipleScattering, Quadrature, Quality, Settings, UnknownQuality};

/// Settings that can be measured by their name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NamedSettings {
    /// A quality.
    Quality(Quality),
    /// Welkin's methods in the sizes and with the samples of Bevy's atmosphere.
    BevySizes,
    /// The same with its quadrature and its isotropic series.
    BevySteps,
}

impl NamedSettings {
    /// What the name means.
    pub fn settings(self) -> Settings {
        match self {
            Self::Quality(quality) => Settings::of(quality),
            Self::BevySizes => bevy_sizes(),
            Self::BevySteps => Settings { quadrature: Quadrature::EqualSteps, ..bevy_sizes() },
        }
    }
}

/// Defaults of `AtmosphereSettings` in Bevy 0.19 (`crates/bevy_pbr/src/atmosphere/mod.rs`): transmittance 256 x 128 texels
/// of 40 samples, multiple scattering 32 x 32 of 64 directions of 20 samples, sky view 400 x 200 of 16 samples, aerial
/// perspective 32³ of 10. Azimuths here are half a turn, of which the other half is the mirror image: 200 columns of a sky
/// view are as fine as Bevy's 400, and eight cosines times four azimuths stand for 64 directions. The sky view has two halves
/// of 100 rows.
fn bevy_sizes() -> Settings {
    Settings {
        // Two legs of a ray are the most that have length where the sun is up.
        nodes_per_leg: 16,
        optical_depth_panels: 20,
        optical_depth_size: [256, 128],
        multiple_scattering: MultipleScattering::IsotropicSeries,
        multiple_scattering_size: [32, 32],
        directions: Directions { below: 3, band: 2, above: 3, azimuths: 4 },
        sky_view_size: [200, 100],
        froxel_size: [32, 16, 32],
        ..Settings::of(Quality::Medium)
    }
}

impl fmt::Display for NamedSettings {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Quality(quality) => quality.fmt(formatter),
            Self::BevySizes => formatter.write_str("bevy-sizes"),
            Self::BevySteps => formatter.write_str("bevy-steps"),
        }
    }
}

impl FromStr for NamedSettings {
    type Err = UnknownQuality;

    fn from_str(name: &str) -> Result<Self, UnknownQuality> {
        match name {
            "bevy-sizes" => Ok(Self::BevySizes),
            "bevy-steps" => Ok(Self::BevySteps),
            quality => quality.parse().map(Self::Quality),
        }
    }
}
