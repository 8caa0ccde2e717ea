//! A density sampled on a regular grid, interpolated trilinearly, with a coarse grid of majorants.

use glam::{DVec3, UVec3};

use super::field::DensityField;

/// Voxels along one edge of a majorant's cell.
const COARSE: usize = 4;

/// How far ahead a ray looks for the cell that it is in, in shares of a cell.
const AHEAD: f64 = 1e-7;

/// Samples at the centres of the voxels that fill a box. Between them density is trilinear; within half a voxel of the
/// box's faces it keeps the outermost sample's value; outside it is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct GridField {
    min_m: DVec3,
    voxel_m: DVec3,
    voxels_per_m: DVec3,
    size: [usize; 3],
    density: Vec<f64>,
    cell_m: DVec3,
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
        let (voxels_per_m, cell_m) = (voxel_m.recip(), voxel_m * COARSE as f64);
        let mut grid = Self { min_m, voxel_m, voxels_per_m, size, density, cell_m, coarse_size, majorant: Vec::new() };
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

/// A ray's way through the cells along one axis.
#[derive(Clone, Copy)]
struct Axis {
    cell: i32,
    count: i32,
    stride: i32,
    /// -1 or 1.
    direction: i32,
    /// Distance along the ray to the face ahead, m; infinite where the ray runs along the faces.
    face_m: f64,
    start_m: f64,
    per_slope: f64,
    cell_m: f64,
}

impl Axis {
    /// A ray from `start_m` with the direction's component `slope` that is in the cell at `inside_m`.
    fn new(start_m: f64, slope: f64, inside_m: f64, cell_m: f64, count: i32, stride: i32) -> Self {
        let cell = ((inside_m / cell_m) as i32).clamp(0, count - 1);
        let direction = if slope > 0.0 { 1 } else { -1 };
        let mut axis =
            Self { cell, count, stride, direction, face_m: f64::INFINITY, start_m, per_slope: slope.recip(), cell_m };
        if slope != 0.0 {
            axis.find_face();
        }
        axis
    }

    fn find_face(&mut self) {
        let face = self.cell + i32::from(self.direction > 0);
        self.face_m = (f64::from(face) * self.cell_m - self.start_m) * self.per_slope;
    }

    /// Into the next cell; false when there is none.
    fn step(&mut self) -> bool {
        self.cell += self.direction;
        self.find_face();
        (0..self.count).contains(&self.cell)
    }
}

impl DensityField for GridField {
    fn bounds_m(&self) -> (DVec3, DVec3) {
        (self.min_m, self.max_m())
    }

    fn density(&self, p: DVec3) -> f64 {
        let position = (p - self.min_m) * self.voxels_per_m;
        let size = DVec3::from_array(self.size.map(|n| n as f64));
        if !(position.cmpge(DVec3::ZERO) & position.cmple(size)).all() {
            return 0.0;
        }
        let x = position.clamp(DVec3::splat(0.5), size - 0.5) - 0.5;
        let low = [x.x as usize, x.y as usize, x.z as usize];
        let share = x - DVec3::from_array(low.map(|i| i as f64));
        let [nx, ny, nz] = self.size;
        let (next_x, next_y) = (usize::from(low[0] + 1 < nx), if low[1] + 1 < ny { nx } else { 0 });
        let next_z = if low[2] + 1 < nz { nx * ny } else { 0 };
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let along_x = |i: usize| mix(self.density[i], self.density[i + next_x], share.x);
        let along_y = |i: usize| mix(along_x(i), along_x(i + next_y), share.y);
        let first = (low[2] * ny + low[1]) * nx + low[0];
        mix(along_y(first), along_y(first + next_z), share.z)
    }

    fn stretch(&self, p: DVec3, d: DVec3, from_m: f64) -> (f64, f64) {
        let mut first = (from_m, 0.0);
        self.march(p, d, from_m, f64::INFINITY, &mut |end_m, majorant| {
            first = (end_m, majorant);
            end_m <= from_m
        });
        first
    }

    /// From cell to cell (Amanatides & Woo 1987); faces are computed from their numbers, so that nothing drifts.
    fn march(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, visit: &mut dyn FnMut(f64, f64) -> bool) {
        let [cx, cy, _] = self.coarse_size.map(|n| n as i32);
        let strides = [1, cx, cx * cy];
        // A little further, so that a point on a face counts to the cell ahead; cells know their neighbours' values.
        let inside = p + d * (from_m + AHEAD * self.cell_m.min_element()) - self.min_m;
        let relative = p - self.min_m;
        let mut axes: [Axis; 3] = std::array::from_fn(|i| {
            Axis::new(relative[i], d[i], inside[i], self.cell_m[i], self.coarse_size[i] as i32, strides[i])
        });
        let mut cell: i32 = axes.iter().map(|axis| axis.cell * axis.stride).sum();
        let mut t = from_m;
        loop {
            let nearest = if axes[0].face_m < axes[1].face_m { 0 } else { 1 };
            let nearest = if axes[nearest].face_m < axes[2].face_m { nearest } else { 2 };
            let axis = &mut axes[nearest];
            let face_m = axis.face_m;
            let leaves = !axis.step();
            // The last cell holds to the end, whatever rounding makes of the face of the box.
            t = if leaves { to_m } else { face_m.max(t).min(to_m) };
            if !visit(t, self.majorant[cell as usize]) || t >= to_m {
                return;
            }
            cell += axis.direction * axis.stride;
        }
    }

    fn detail_m(&self) -> f64 {
        self.voxel_m.min_element()
    }
}

#[cfg(test)]
mod tests {
    use super::super::shape::clip;
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
    fn a_march_reaches_the_end_and_its_majorants_hold_also_along_the_axes() {
        let grid = bumpy();
        for i in 0..200 {
            let f = f64::from(i);
            let mut d = DVec3::new((5.0 * f).cos(), f.sin(), (7.0 * f).sin()).normalize();
            if i % 10 == 0 {
                // Divisions by zero, and of either sign.
                d = [DVec3::X, -DVec3::Y, DVec3::Z, -DVec3::X][i as usize / 10 % 4];
            }
            let p = DVec3::new(0.5 + f.cos(), 0.9 * f.sin(), -0.2) - 9.0 * d;
            let Some((start, end)) = clip(p, d, grid.min_m, grid.max_m()) else { continue };
            let mut t = start;
            grid.march(p, d, start, end, &mut |next, majorant| {
                assert!(next >= t);
                for k in 0..=10 {
                    let density = grid.density(p + d * (t + (next - t) * f64::from(k) / 10.0));
                    assert!(density <= majorant * (1.0 + 1e-6) + 1e-6, "{density} above {majorant} on ray {i}");
                }
                t = next;
                true
            });
            assert_eq!(t, end);
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
