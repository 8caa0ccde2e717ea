//! The options that trade the gpu backend's accuracy for time.

use clap::Args;
use welkin::plan::{MultipleScattering, Quality, Rung, Settings};

/// How accurate the gpu backend is.
#[derive(Debug, Args)]
pub struct Accuracy {
    /// How accurate the gpu backend is: low, medium (default), high, ultra, or between them, as in medium+1/2
    #[arg(long, value_name = "Q")]
    pub quality: Option<Rung>,
    /// How the gpu backend computes light scattered more than once: auto (default: what the air calls for),
    /// isotropic-series (Hillaire 2020), harmonics or source-function
    #[arg(long, value_name = "METHOD")]
    pub multiple_scattering: Option<MultipleScattering>,
}

impl Accuracy {
    /// The quality asked for, or the default.
    pub fn quality(&self) -> Rung {
        self.quality.unwrap_or(Rung::of(Quality::default()))
    }

    /// What was asked for, in numbers.
    pub fn settings(&self) -> Settings {
        let multiple_scattering = self.multiple_scattering.unwrap_or_default();
        Settings { multiple_scattering, ..self.quality().settings() }
    }
}
