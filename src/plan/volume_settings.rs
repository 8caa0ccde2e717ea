//! What a quality means for fog, local volumes and local lights.

use super::Quality;

/// Everything that trades accuracy for time in them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct VolumeSettings {
    /// Growth of steps with distance, m per km.
    pub step_permille: u32,
    /// Most steps along a ray.
    pub max_steps: u32,
    /// Cells along each side of a block of light; fewer where there are many volumes.
    pub cells: u32,
    /// Nested grids of light in fog, each four times as wide as the one inside it.
    pub fog_levels: u32,
    /// Width of the innermost grid's cells, m.
    pub fog_cell_m: u32,
    /// Points on the way from a cell to a directional light.
    pub beam_samples: u32,
    /// Points on the way from a sample to a local light, where matter is uneven.
    pub lamp_samples: u32,
    /// A local light is left out where it brings less than this part, one in so many, of what it brings to its neighbour.
    pub lamp_share: u32,
    /// Thousandths by which pixels between others may differ at most from what they would be if each were marched; 0 marches each.
    pub lattice_permille: u32,
}

impl VolumeSettings {
    /// The preset of a quality.
    pub fn of(quality: Quality) -> Self {
        let medium = Self {
            step_permille: 30,
            max_steps: 256,
            cells: 24,
            fog_levels: 4,
            fog_cell_m: 16,
            beam_samples: 16,
            lamp_samples: 2,
            lamp_share: 1000,
            lattice_permille: 10,
        };
        match quality {
            Quality::Low => Self {
                step_permille: 60,
                max_steps: 128,
                cells: 16,
                fog_cell_m: 24,
                beam_samples: 8,
                lamp_samples: 1,
                lamp_share: 300,
                lattice_permille: 20,
                ..medium
            },
            Quality::Medium => medium,
            Quality::High => Self {
                step_permille: 15,
                max_steps: 512,
                cells: 32,
                fog_cell_m: 12,
                beam_samples: 24,
                lamp_samples: 4,
                lamp_share: 3000,
                lattice_permille: 5,
                ..medium
            },
            Quality::Ultra => Self {
                step_permille: 8,
                max_steps: 1024,
                cells: 48,
                fog_cell_m: 8,
                beam_samples: 32,
                lamp_samples: 8,
                lamp_share: 10_000,
                lattice_permille: 2,
                ..medium
            },
        }
    }
}
