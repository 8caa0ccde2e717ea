//! What a quality means for clouds.

use super::Quality;

/// How light that is scattered more than once is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CloudScattering {
    /// Not at all: each photon is scattered once.
    Single,
    /// Octaves with halved strength, extinction and asymmetry, attenuated along the light's path alone, as engines ship
    /// them (Wrenninge 2013), eight of them.
    OctavesAsShipped,
    /// Four octaves with fitted factors, attenuated along both paths.
    OctavesFitted,
    /// Two bands of light that is scattered little and almost straight ahead, and the rest by discrete ordinates on the
    /// grids, eight of them.
    Ordinates8,
    /// The same with sixteen.
    Ordinates16,
}

impl CloudScattering {
    /// From the simplest to the best.
    pub const ALL: [Self; 5] =
        [Self::Single, Self::OctavesAsShipped, Self::OctavesFitted, Self::Ordinates8, Self::Ordinates16];

    /// Groups of four ordinates of one zenith cosine; 0 where there is no grid of them.
    pub fn ordinate_groups(self) -> u32 {
        match self {
            Self::Ordinates8 => 2,
            Self::Ordinates16 => 4,
            _ => 0,
        }
    }
}

/// Everything that trades accuracy for time in clouds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct CloudSettings {
    /// Multiple scattering.
    pub scattering: CloudScattering,
    /// Sweeps of the ordinates through each level of their grid.
    pub sweeps: u32,
    /// The same in a frame of a sequence, which starts from the light of the one before.
    pub warm_sweeps: u32,
    /// Width of the ordinates' smallest cells, m.
    pub ordinate_cell_m: u32,
    /// Cells across each level of the ordinates' grid; even.
    pub ordinate_cells: u32,
    /// Points between a sample and where the grid of optical depths takes over.
    pub near_samples: u32,
    /// Shortest step along a ray, m.
    pub step_m: u32,
    /// Growth of steps with distance, m per km.
    pub step_permille: u32,
    /// Most steps along a ray.
    pub max_steps: u32,
    /// Columns and rows of each grid of light.
    pub grid_size: u32,
    /// Slices of each layer of clouds.
    pub grid_slices: u32,
    /// Nested grids, each four times as wide as the one inside it.
    pub grid_levels: u32,
    /// Width of the innermost grid's cells, m.
    pub cell_m: u32,
    /// Side of the blocks of pixels of which each frame of a sequence marches one, a power of two; 1 marches all.
    pub block: u32,
}

impl CloudSettings {
    /// The preset of a quality.
    pub fn of(quality: Quality) -> Self {
        let medium = Self {
            scattering: CloudScattering::Ordinates16,
            sweeps: 24,
            warm_sweeps: 2,
            ordinate_cell_m: 120,
            ordinate_cells: 64,
            near_samples: 6,
            step_m: 30,
            step_permille: 10,
            max_steps: 384,
            grid_size: 96,
            grid_slices: 12,
            grid_levels: 3,
            cell_m: 100,
            block: 4,
        };
        match quality {
            Quality::Low => Self {
                scattering: CloudScattering::Ordinates8,
                sweeps: 12,
                ordinate_cell_m: 240,
                ordinate_cells: 32,
                near_samples: 0,
                max_steps: 192,
                grid_size: 64,
                grid_slices: 8,
                cell_m: 150,
                ..medium
            },
            Quality::Medium => medium,
            Quality::High => {
                Self { sweeps: 32, step_m: 15, step_permille: 5, max_steps: 640, grid_slices: 16, block: 2, ..medium }
            }
            Quality::Ultra => Self {
                sweeps: 48,
                ordinate_cell_m: 60,
                step_m: 8,
                step_permille: 3,
                max_steps: 1280,
                grid_size: 128,
                grid_slices: 24,
                cell_m: 60,
                block: 1,
                ..medium
            },
        }
    }
}
