//! What a quality means in numbers: everything that trades accuracy for time.

use std::fmt;
use std::str::FromStr;

use welkin_lut::bake::SourceGrid;

use super::{CloudSettings, MultipleScattering, Skipping, VolumeSettings};

/// How much accuracy a picture is worth. The error of each is measured in docs/accuracy.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Quality {
    /// For weak devices.
    Low,
    /// The default: right to a few per cent everywhere.
    #[default]
    Medium,
    /// Right to within a per cent nearly everywhere.
    High,
    /// As close to the truth as the methods come.
    Ultra,
}

impl Quality {
    /// From the cheapest to the dearest.
    pub const ALL: [Self; 4] = [Self::Low, Self::Medium, Self::High, Self::Ultra];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
            Self::Ultra => "ultra",
        }
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// A quality of that name does not exist.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("quality is '{0}'; it must be one of low, medium, high, ultra")]
pub struct UnknownQuality(String);

impl FromStr for Quality {
    type Err = UnknownQuality;

    fn from_str(name: &str) -> Result<Self, UnknownQuality> {
        Self::ALL.into_iter().find(|quality| quality.name() == name).ok_or_else(|| UnknownQuality(name.to_owned()))
    }
}

/// Cosines and azimuths in which a radiance field is sampled; their product is a workgroup's invocations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Directions {
    /// Gauss nodes below the horizon.
    pub below: u32,
    /// Gauss nodes between the horizon and the horizontal.
    pub band: u32,
    /// Gauss nodes above the horizontal.
    pub above: u32,
    /// Midpoints on half a turn.
    pub azimuths: u32,
}

impl Directions {
    /// All cosines.
    pub fn cosines(&self) -> u32 {
        self.below + self.band + self.above
    }

    /// All directions; at most 128, which every Vulkan device takes in one workgroup.
    pub fn count(&self) -> u32 {
        self.cosines() * self.azimuths
    }
}

/// How tables are stored on the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TableFormat {
    /// 32-bit floats.
    Float32,
    /// Half floats: half of the memory, and up to 0.1 % in what is bright; see docs/accuracy.md.
    Float16,
}

impl fmt::Display for TableFormat {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Float32 => "32-bit floats",
            Self::Float16 => "half floats",
        })
    }
}

/// Where a view ray is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quadrature {
    /// Gauss-Legendre on every leg of the ray.
    GaussLegendre,
    /// As other renderers do, for comparison: steps of equal length sampled at three tenths, and what lies behind the last
    /// sample left out (sebh/UnrealEngineSkyAtmosphere, `Resources/RenderSkyRayMarching.hlsl`; copied by Bevy); on each leg
    /// of a ray.
    EqualSteps,
}

/// Everything that trades accuracy for time. Sizes are (columns, rows) in texels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Gauss-Legendre nodes on each leg of a ray.
    pub nodes_per_leg: u32,
    /// Where these nodes lie.
    pub quadrature: Quadrature,
    /// Panels of Simpson's rule on each leg where only optical depth is asked for.
    pub optical_depth_panels: u32,
    /// How tables are stored.
    pub table_format: TableFormat,
    /// Optical depth: (direction, altitude).
    pub optical_depth_size: [u32; 2],
    /// Multiple scattering: (sun, altitude).
    pub multiple_scattering_size: [u32; 2],
    /// Degrees 0 .. n-1 of spherical harmonics that the field keeps: 3 or 5.
    pub degree_count: u32,
    /// Directions in which each texel's field is sampled.
    pub directions: Directions,
    /// Orders of scattering that are computed one by one, at least 3; the rest of the series is geometric.
    pub orders: u32,
    /// How light of the second and later orders is computed.
    pub multiple_scattering: MultipleScattering,
    /// How much the sky may ring, relative to its own light, before the source function takes the place of spherical
    /// harmonics: see [`super::expected_ringing`]. A quarter of what the quality promises at the 99th percentile, as the
    /// error there is about three times the expectation.
    pub ringing_limit: f64,
    /// How far single views into the planet's shadow may be off before the source function takes the place of spherical
    /// harmonics: see [`super::error_in_shadow`]. What the quality promises there at the 99th percentile; half of it at
    /// `high` and `ultra`.
    pub shadow_limit: f64,
    /// Directions of the source function.
    pub source_grid: SourceGrid,
    /// Source function: (sun, altitude).
    pub source_size: [u32; 2],
    /// Orders of scattering of the source function that are computed one by one, at least 3.
    pub source_orders: u32,
    /// Sky view, each half: (azimuth, elevation).
    pub sky_view_size: [u32; 2],
    /// Froxels, each half of the view sphere: (azimuth, elevation, distance).
    pub froxel_size: [u32; 3],
    /// By how much pixels may differ at most from what they would be if each were evaluated for itself, relative. Those
    /// between the directions of a lattice are interpolated where second differences promise it. 0 evaluates every pixel.
    pub lattice_tolerance: f64,
    /// Clouds.
    pub clouds: CloudSettings,
    /// Fog, local volumes and local lights.
    pub volumes: VolumeSettings,
    /// What is left out because it hardly shows.
    pub skipping: Skipping,
}

impl Settings {
    /// The preset of a quality.
    pub fn of(quality: Quality) -> Self {
        match quality {
            Quality::Low => Self {
                nodes_per_leg: 10,
                quadrature: Quadrature::GaussLegendre,
                optical_depth_panels: 64,
                table_format: TableFormat::Float32,
                optical_depth_size: [128, 48],
                multiple_scattering_size: [32, 16],
                degree_count: 3,
                directions: Directions { below: 3, band: 2, above: 4, azimuths: 4 },
                orders: 3,
                multiple_scattering: MultipleScattering::Auto,
                ringing_limit: 0.015,
                shadow_limit: 0.4,
                source_grid: SourceGrid { ground: 4, low: 4, high: 4, azimuths: 8 },
                source_size: [40, 14],
                source_orders: 4,
                sky_view_size: [32, 48],
                froxel_size: [8, 16, 16],
                lattice_tolerance: 4e-3,
                clouds: CloudSettings::of(quality),
                volumes: VolumeSettings::of(quality),
                skipping: Skipping::USUAL,
            },
            Quality::Medium => Self {
                nodes_per_leg: 12,
                quadrature: Quadrature::GaussLegendre,
                optical_depth_panels: 64,
                table_format: TableFormat::Float32,
                optical_depth_size: [256, 64],
                multiple_scattering_size: [48, 24],
                degree_count: 3,
                directions: Directions { below: 4, band: 3, above: 5, azimuths: 6 },
                orders: 3,
                multiple_scattering: MultipleScattering::Auto,
                ringing_limit: 0.015,
                shadow_limit: 0.4,
                source_grid: SourceGrid { ground: 4, low: 5, high: 5, azimuths: 8 },
                source_size: [48, 18],
                source_orders: 4,
                sky_view_size: [48, 96],
                froxel_size: [12, 24, 24],
                lattice_tolerance: 2e-3,
                clouds: CloudSettings::of(quality),
                volumes: VolumeSettings::of(quality),
                skipping: Skipping::USUAL,
            },
            Quality::High => Self {
                nodes_per_leg: 12,
                quadrature: Quadrature::GaussLegendre,
                optical_depth_panels: 64,
                table_format: TableFormat::Float32,
                optical_depth_size: [256, 128],
                multiple_scattering_size: [64, 32],
                degree_count: 3,
                directions: Directions { below: 4, band: 3, above: 5, azimuths: 8 },
                orders: 3,
                multiple_scattering: MultipleScattering::Auto,
                ringing_limit: 0.0075,
                shadow_limit: 0.125,
                source_grid: SourceGrid { ground: 5, low: 6, high: 5, azimuths: 10 },
                source_size: [48, 24],
                source_orders: 5,
                sky_view_size: [80, 144],
                froxel_size: [16, 48, 32],
                lattice_tolerance: 8e-4,
                clouds: CloudSettings::of(quality),
                volumes: VolumeSettings::of(quality),
                skipping: Skipping::USUAL,
            },
            Quality::Ultra => Self {
                nodes_per_leg: 16,
                quadrature: Quadrature::GaussLegendre,
                optical_depth_panels: 64,
                table_format: TableFormat::Float32,
                optical_depth_size: [512, 128],
                multiple_scattering_size: [96, 32],
                degree_count: 5,
                directions: Directions { below: 5, band: 3, above: 6, azimuths: 8 },
                orders: 4,
                multiple_scattering: MultipleScattering::Auto,
                ringing_limit: 0.00375,
                shadow_limit: 0.075,
                source_grid: SourceGrid { ground: 6, low: 8, high: 6, azimuths: 12 },
                source_size: [64, 32],
                source_orders: 6,
                sky_view_size: [96, 192],
                froxel_size: [24, 64, 48],
                lattice_tolerance: 4e-4,
                clouds: CloudSettings::of(quality),
                volumes: VolumeSettings::of(quality),
                skipping: Skipping::USUAL,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quality_fits_the_smallest_vulkan_device() {
        for quality in Quality::ALL {
            let settings = Settings::of(quality);
            // maxComputeWorkGroupInvocations is at least 128, and each coefficient needs an invocation.
            assert!(settings.directions.count() <= 128, "{quality}");
            let coefficients = settings.degree_count * (settings.degree_count + 1) / 2;
            assert!(coefficients <= settings.directions.count(), "{quality}");
            let grid = settings.source_grid;
            let ([width, height], [columns, rows]) = (settings.source_size, grid.tiles());
            // Beside an image's side of 4096, 16 KiB of workgroup memory: 32 bytes for each direction.
            assert!(width * columns <= 4096 && height * rows <= 4096, "{quality}");
            assert!(32 * grid.count() <= 16384, "{quality}");
            assert!(settings.source_orders >= 3, "{quality}");
            assert!(settings.orders >= 3, "{quality}: the ratio of orders is constant only after the third");
        }
    }

    #[test]
    fn a_quality_is_known_by_its_name() {
        for quality in Quality::ALL {
            assert_eq!(quality.name().parse(), Ok(quality));
        }
        assert!("best".parse::<Quality>().is_err());
    }
}
