//! The options that trade the gpu backend's accuracy for time.

use clap::Args;
use welkin::plan::{MultipleScattering, Quality, Settings};

/// How accurate the gpu backend is.
#[derive(Debug, Args)]
pub struct Accuracy {
    /// How accurate the gpu backend is: low, medium (default), high or ultra
    #[arg(long, value_name = "Q")]
    pub quality: Option<Quality>,
    /// How the gpu backend computes light scattered more than once: auto (default: what the air calls for),
    /// isotropic-series (Hillaire 2020), harmonics or source-function
    #[arg(long, value_name = "METHOD")]
    pub multiple_scattering: Option<MultipleScattering>,
}

impl Accuracy {
    /// The quality asked for, or the default.
    pub fn quality(&self) -> Quality {
        self.quality.unwrap_or_default()
    }

    /// What was asked for, in numbers.
    pub fn settings(&self) -> Settings {
        let multiple_scattering = self.multiple_scattering.unwrap_or_default();
        Settings { multiple_scattering, ..Settings::of(self.quality()) }
    }
}
