//! What the three channels of a picture hold.

use std::fmt;
use std::str::FromStr;

use super::ColourSpace;

/// What red, green and blue of a picture mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Channels {
    /// Spectral radiance in the bands at 680, 550 and 440 nm.
    Bands,
    /// Linear colour.
    Colour(ColourSpace),
}

/// There are no channels of that name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("colour space is '{0}'; it must be one of bands, linear-srgb, rec2020, acescg")]
pub struct UnknownChannels(String);

impl Channels {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Bands,
        Self::Colour(ColourSpace::LinearSrgb),
        Self::Colour(ColourSpace::Rec2020),
        Self::Colour(ColourSpace::AcesCg),
    ];

    /// Their name on the command line, in scene files and in EXR headers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bands => "bands",
            Self::Colour(space) => space.name(),
        }
    }
}

impl fmt::Display for Channels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Channels {
    type Err = UnknownChannels;

    fn from_str(name: &str) -> Result<Self, UnknownChannels> {
        Self::ALL.into_iter().find(|channels| channels.name() == name).ok_or_else(|| UnknownChannels(name.to_owned()))
    }
}
