//! A density sampled on a regular grid, interpolated trilinearly, with a coarse grid of majorants.

use glam::{DVec3, UVec3};

use super::field::DensityField;
use super::shape::clip;

/// Voxels along one edge of a majorant's cell.
const COARSE: usize = 4;

/// Samples at the centres of the voxels that fill a box. Between them density is trilinear; within half a voxel of the
/// box's faces it keeps the outermost sample's value; outside it is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct GridField {
    min_m: DVec3,
    voxel_m: DVec3,
    size: [usize; 3],
    density: Vec<f64>,
    coarse_size: [usize; 3],
    majorant: Vec<f64>,
}

/// Why a grid cannot exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// A side has no voxels, or the box no extent.
    #[error("a density grid of {size} voxels between {min_m} and {max_m} m has no volume")]
    Empty {
        /// Voxels along x, y, z.
        size: UVec3,
        /// Lowest corner, m.
        min_m: DVec3,
        /// Highest corner, m.
        max_m: DVec3,
    },
    /// The samples do not fill the grid.
    #[error("a density grid of {size} voxels needs {expected} samples; it has {found}")]
    Count {
        /// Voxels along x, y, z.
        size: UVec3,
        /// x·y·z.
        expected: usize,
        /// The number given.
        found: usize,
    },
    /// A sample is negative, NaN or infinite.
    #[error("density sample {index} is {value}; it must be finite and at least 0")]
    Sample {
        /// Position in the list.
        index: usize,
        /// The value refused.
        value: f64,
    },
}

impl GridField {
    /// A grid between two corners. Samples run along x first, then y, then z.
    pub fn new(min_m: DVec3, max_m: DVec3, size: UVec3, density: Vec<f64>) -> Result<Self, GridError> {
        let voxel_m = (max_m - min_m) / size.as_dvec3();
        if size.min_element() == 0 || !voxel_m.is_finite() || voxel_m.min_element() <= 0.0 {
            return Err(GridError::Empty { size, min_m, max_m });
        }
        let [nx, ny, nz] = size.to_array().map(|n| n as usize);
        let expected = nx * ny * nz;
        if density.len() != expected {
            return Err(GridError::Count { size, expected, found: density.len() });
        }
        if let Some((index, &value)) = density.iter().enumerate().find(|(_, d)| !(d.is_finite() && **d >= 0.0)) {
            return Err(GridError::Sample { index, value });
        }
        let size = [nx, ny, nz];
        let coarse_size = size.map(|n| n.div_ceil(COARSE));
        let mut grid = Self { min_m, voxel_m, size, density, coarse_size, majorant: Vec::new() };
        grid.majorant = grid.coarse_majorants();
        Ok(grid)
    }

    /// The largest sample that interpolation inside each coarse cell can touch: its own voxels and one around them.
    fn coarse_majorants(&self) -> Vec<f64> {
        let range = |cell: usize, n: usize| (cell * COARSE).saturating_sub(1)..((cell + 1) * COARSE + 1).min(n);
        let [cx, cy, cz] = self.coarse_size;
        let mut majorants = Vec::with_capacity(cx * cy * cz);
        for k in 0..cz {
            for j in 0..cy {
                for i in 0..cx {
                    let mut most = 0.0_f64;
                    for z in range(k, self.size[2]) {
                        for y in range(j, self.size[1]) {
                            let row = (z * self.size[1] + y) * self.size[0];
                            let samples = &self.density[row..row + self.size[0]][range(i, self.size[0])];
                            most = samples.iter().copied().fold(most, f64::max);
                        }
                    }
                    majorants.push(most);
                }
            }
        }
        majorants
    }

    fn max_m(&self) -> DVec3 {
        self.min_m + self.voxel_m * DVec3::from_array(self.size.map(|n| n as f64))
    }
}

impl DensityField for GridField {
    fn bounds_m(&self) -> (DVec3, DVec3) {
        (self.min_m, self.max_m())
    }

    fn density(&self, p: DVec3) -> f64 {
        let position = (p - self.min_m) / self.voxel_m;
        let (mut low, mut high, mut share) = ([0; 3], [0; 3], [0.0; 3]);
        for axis in 0..3 {
            let n = self.size[axis] as f64;
            if !(0.0..=n).contains(&position[axis]) {
                return 0.0;
            }
            let x = (position[axis] - 0.5).clamp(0.0, n - 1.0);
            low[axis] = x as usize;
            high[axis] = (low[axis] + 1).min(self.size[axis] - 1);
            share[axis] = x - low[axis] as f64;
        }
        let sample = |x: usize, y: usize, z: usize| self.density[(z * self.size[1] + y) * self.size[0] + x];
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let along_x = |y: usize, z: usize| mix(sample(low[0], y, z), sample(high[0], y, z), share[0]);
        let along_y = |z: usize| mix(along_x(low[1], z), along_x(high[1], z), share[1]);
        mix(along_y(low[2]), along_y(high[2]), share[2])
    }

    fn stretch(&self, p: DVec3, d: DVec3, from_m: f64) -> (f64, f64) {
        let cell_m = self.voxel_m * COARSE as f64;
        // A hair further on, so that a ray on the border of two cells is in the one it enters.
        let inside = ((p + d * from_m - self.min_m) / cell_m) + d / cell_m * (1e-9 * cell_m.min_element());
        let mut index = [0; 3];
        for axis in 0..3 {
            index[axis] = (inside[axis].max(0.0) as usize).min(self.coarse_size[axis] - 1);
        }
        let corner = self.min_m + cell_m * DVec3::from_array(index.map(|i| i as f64));
        let end = clip(p, d, corner, corner + cell_m).map_or(from_m, |(_, end)| end);
        let [cx, cy, _] = self.coarse_size;
        let majorant = self.majorant[(index[2] * cy + index[1]) * cx + index[0]];
        // Rounding may put the end at the start: step over the border then.
        (end.max(from_m + 1e-9 * cell_m.min_element()), majorant)
    }

    fn detail_m(&self) -> f64 {
        self.voxel_m.min_element()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bumpy() -> GridField {
        let (nx, ny, nz) = (9, 7, 5);
        let samples = (0..nx * ny * nz).map(|i| f64::from((i * 7919) % 31) / 31.0).collect();
        GridField::new(DVec3::splat(-1.0), DVec3::new(2.0, 1.0, 0.5), UVec3::new(nx, ny, nz), samples).unwrap()
    }

    #[test]
    fn density_stays_below_the_majorant_along_any_ray() {
        let grid = bumpy();
        for i in 0..200 {
            let f = f64::from(i);
            let p = DVec3::new(f.sin(), (2.0 * f).cos(), (3.0 * f).sin()) * 2.0;
            let d = (DVec3::new((5.0 * f).cos(), f.sin(), 0.3 * (7.0 * f).sin()) - 0.3 * p).normalize();
            let Some((start, end)) = clip(p, d, grid.min_m, grid.max_m()) else { continue };
            let mut t = start;
            while t < end {
                let (stretch_end, majorant) = grid.stretch(p, d, t);
                assert!(stretch_end > t);
                for k in 0..=10 {
                    let density = grid.density(p + d * (t + (stretch_end.min(end) - t) * f64::from(k) / 10.0));
                    assert!(density <= majorant * (1.0 + 1e-6) + 1e-6, "{density} above {majorant}");
                }
                t = stretch_end;
            }
        }
    }

    #[test]
    fn samples_are_met_at_the_centres_of_their_voxels() {
        let grid = bumpy();
        let centre = grid.min_m + grid.voxel_m * DVec3::new(3.5, 2.5, 1.5);
        assert!((grid.density(centre) - grid.density[(7 + 2) * 9 + 3]).abs() < 1e-12);
        assert_eq!(grid.density(grid.max_m() + 1e-6), 0.0);
    }

    #[test]
    fn impossible_grids_are_refused() {
        let make = |n, samples| GridField::new(DVec3::ZERO, DVec3::ONE, UVec3::splat(n), samples);
        assert!(matches!(make(0, vec![]), Err(GridError::Empty { .. })));
        assert!(matches!(make(2, vec![1.0; 7]), Err(GridError::Count { expected: 8, found: 7, .. })));
        assert!(matches!(make(1, vec![f64::NAN]), Err(GridError::Sample { index: 0, .. })));
    }
}
