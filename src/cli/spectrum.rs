//! Wavelengths and colours on the command line.

use clap::Args;
use welkin::scene::SpectrumRequest;
use welkin_lut::spectrum::{Channels, rule};

/// What a picture is computed from and holds, in place of what its scene says.
#[derive(Debug, Args)]
pub struct SpectrumArguments {
    /// Wavelengths to compute, 3 to 40; 3 are the bands at 680, 550 and 440 nm. Time grows with a third of them [default:
    /// the scene's, or 3]
    #[arg(long, value_name = "N", value_parser = wavelengths)]
    wavelengths: Option<usize>,
    /// What R, G and B of an EXR file hold: bands, linear-srgb, rec2020 or acescg [default: the scene's; bands where
    /// neither speaks of spectra]
    #[arg(long, value_name = "SPACE")]
    colour_space: Option<Channels>,
}

impl SpectrumArguments {
    /// What the scene is asked for.
    pub fn request(&self) -> SpectrumRequest {
        SpectrumRequest { wavelengths: self.wavelengths, channels: self.colour_space }
    }
}

fn wavelengths(text: &str) -> Result<usize, String> {
    let allowed = 3..=rule::MOST;
    let count = text.parse().ok().filter(|count| allowed.contains(count));
    count.ok_or_else(|| format!("'{text}' is not a whole number from 3 to {}", rule::MOST))
}
