//! Where the light in clouds is solved: nested boxes of cells.

use glam::{DVec3, UVec3};

/// A box of cells. Coordinates are east, north and altitude, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Lowest corner.
    pub lowest_m: DVec3,
    /// Edges of a cell.
    pub cell_m: DVec3,
    /// Cells along each axis, at least 1.
    pub size: UVec3,
}

/// What lies around the outermost box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sides {
    /// Clear air: light from sky and ground comes in.
    #[default]
    Clear,
    /// The same clouds again and again; such a level has one cell or an even number of them across.
    Periodic,
}

/// Nested boxes, the finest first; each lies within the next, spans the same altitudes and has equally many cells
/// across.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// At least one.
    pub levels: Vec<Level>,
    /// Around the last of them.
    pub sides: Sides,
    /// Texels of extinction and optical depth along a cell's edge, at least 1.
    pub refinement: u32,
}

/// Rows of cells in a level at most: the cells of deep clouds are higher than they are wide.
const MOST_ROWS: f64 = 48.0;

/// What nested boxes around a camera are to cover, and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// Edge of the finest cells, m.
    pub cell_m: f64,
    /// Cells across every level; even.
    pub cells_across: u32,
    /// The last level reaches at least so far to each side, m.
    pub reach_m: f64,
    /// Lowest and highest altitude with clouds, m.
    pub altitudes_m: [f64; 2],
    /// See [`Grid::refinement`].
    pub refinement: u32,
}

impl Grid {
    /// Nested boxes around a place, each twice as wide as the one before. They stand on multiples of their cells, so that
    /// they stay where they are while the camera moves less than two cells.
    pub fn around(east_m: f64, north_m: f64, coverage: &Coverage) -> Self {
        let [lowest_m, highest_m] = coverage.altitudes_m;
        let thickness_m = (highest_m - lowest_m).max(1.0);
        let across = coverage.cells_across.max(2).next_multiple_of(2);
        let mut levels = Vec::new();
        let mut edge_m = coverage.cell_m;
        loop {
            let rows = (thickness_m / edge_m).ceil().clamp(1.0, MOST_ROWS);
            let snapped = |centre_m: f64| ((centre_m / edge_m / 2.0).round() * 2.0 - f64::from(across / 2)) * edge_m;
            levels.push(Level {
                lowest_m: DVec3::new(snapped(east_m), snapped(north_m), lowest_m),
                cell_m: DVec3::new(edge_m, edge_m, thickness_m / rows),
                size: UVec3::new(across, across, rows as u32),
            });
            // A level may be off its centre by one cell.
            if f64::from(across / 2 - 1) * edge_m >= coverage.reach_m {
                break;
            }
            edge_m *= 2.0;
        }
        Self { levels, sides: Sides::Clear, refinement: coverage.refinement.max(1) }
    }

    /// Cells of all levels.
    pub fn cell_count(&self) -> u64 {
        self.levels.iter().map(|level| level.size.as_u64vec3().element_product()).sum()
    }

    /// Extent of the textures that hold one texel a cell.
    pub fn cell_texture(&self) -> [u32; 3] {
        let across = self.levels[0].size;
        [across.x, across.y, self.levels.iter().map(|level| level.size.z).sum()]
    }

    /// Extent of the textures of extinction and optical depth.
    pub fn fine_texture(&self) -> [u32; 3] {
        self.cell_texture().map(|n| n * self.refinement)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coverage() -> Coverage {
        Coverage { cell_m: 120.0, cells_across: 32, reach_m: 14_000.0, altitudes_m: [600.0, 2100.0], refinement: 2 }
    }

    #[test]
    fn levels_are_nested_and_reach_as_far_as_asked() {
        for (east_m, north_m) in [(0.0, 0.0), (119.0, -7777.0), (1e5, 3.0)] {
            let grid = Grid::around(east_m, north_m, &coverage());
            let high = |level: &Level| level.lowest_m + level.size.as_dvec3() * level.cell_m;
            for pair in grid.levels.windows(2) {
                assert!(pair[1].lowest_m.cmple(pair[0].lowest_m).all(), "{pair:?}");
                assert!(high(&pair[1]).cmpge(high(&pair[0]) - 1e-6).all(), "{pair:?}");
            }
            let last = grid.levels.last().unwrap();
            assert!(east_m - last.lowest_m.x >= 14_000.0 && high(last).y - north_m >= 14_000.0, "{last:?}");
            assert!(grid.levels.iter().all(|level| (high(level).z - 2100.0).abs() < 1e-6));
        }
    }

    #[test]
    fn a_step_of_the_camera_within_a_cell_moves_no_level() {
        let grid = Grid::around(10.0, 20.0, &coverage());
        assert_eq!(grid, Grid::around(60.0, -40.0, &coverage()));
        assert_ne!(grid, Grid::around(10_000.0, 20.0, &coverage()), "a long way moves them");
    }
}
