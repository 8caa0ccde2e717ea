//! A density sampled on a regular grid, interpolated trilinearly, with a coarse grid of majorants.

use glam::{DVec3, UVec3};

use super::field::DensityField;

/// Voxels along one edge of a majorant's cell where nobody says how thick the matter is.
const USUAL_VOXELS: usize = 4;

/// Most voxels along that edge: a cell that is much larger knows nothing of its matter.
const MOST_VOXELS: usize = 16;

/// Optical depth of a cell through the densest sample. Shorter cells are more often stepped through than collided in;
/// longer ones find more collisions with matter that is not there. On the thinner grid of `benches/mitsuba/compare.py`
/// half of it takes a quarter longer to the same error, and half as much again the same time.
const CELL_OPTICAL_DEPTH: f64 = 1.25;

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
    /// Along one edge of a majorant's cell.
    voxels_per_cell: usize,
    cell_m: DVec3,
    cells_per_m: DVec3,
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
        let (size, voxels_per_m) = ([nx, ny, nz], voxel_m.recip());
        let (cell_m, cells_per_m, coarse_size) = (voxel_m, voxels_per_m, size);
        let grid = Self {
            min_m,
            voxel_m,
            voxels_per_m,
            size,
            density,
            voxels_per_cell: 1,
            cell_m,
            cells_per_m,
            coarse_size,
            majorant: Vec::new(),
        };
        Ok(grid.in_cells_of(USUAL_VOXELS))
    }

    /// The same grid with cells that suit matter of this extinction at density 1, 1/m: about a mean free path long.
    pub fn for_extinction(self, largest_per_m: f64) -> Self {
        let densest = self.density.iter().copied().fold(0.0, f64::max);
        let voxel_optical_depth = densest * largest_per_m * self.voxel_m.min_element();
        // Without matter the quotient is infinite: as many voxels as there may be.
        let voxels = (CELL_OPTICAL_DEPTH / voxel_optical_depth).round().clamp(1.0, MOST_VOXELS as f64);
        self.in_cells_of(voxels as usize)
    }

    fn in_cells_of(self, voxels_per_cell: usize) -> Self {
        let cell_m = self.voxel_m * voxels_per_cell as f64;
        let coarse_size = self.size.map(|n| n.div_ceil(voxels_per_cell));
        let mut grid = Self { voxels_per_cell, cell_m, cells_per_m: cell_m.recip(), coarse_size, ..self };
        grid.majorant = grid.coarse_majorants();
        grid
    }

    /// The largest sample that interpolation inside each coarse cell can touch: its own voxels and one around them.
    fn coarse_majorants(&self) -> Vec<f64> {
        let voxels = self.voxels_per_cell;
        let range = |cell: usize, n: usize| (cell * voxels).saturating_sub(1)..((cell + 1) * voxels + 1).min(n);
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
    /// Distance along the ray to the face ahead, m; infinite where the ray runs along the faces.
    face_m: f64,
    /// The same of the face behind that one: known before it is wanted, so that no step waits for its arithmetic.
    next_m: f64,
    /// Number of the face behind the one ahead.
    next: f64,
    /// -1 or 1.
    direction: f64,
    start_m: f64,
    per_slope: f64,
    cell_m: f64,
    /// Cells ahead of the one that the ray is in.
    left: i32,
    /// From a cell's majorant to that of the cell ahead.
    stride: i32,
}

impl Axis {
    /// A ray from `start_m` with the direction's component `slope` that is in cell number `cell` of `count`.
    fn new(start_m: f64, slope: f64, cell: i32, cell_m: f64, count: i32, stride: i32) -> Self {
        let ahead = slope > 0.0;
        let (direction, face) = if ahead { (1.0, f64::from(cell + 1)) } else { (-1.0, f64::from(cell)) };
        let left = if ahead { count - 1 - cell } else { cell };
        // Faces are never met by a ray along them: they count as infinitely far.
        let (start_m, per_slope) = if slope == 0.0 { (f64::NEG_INFINITY, 1.0) } else { (start_m, slope.recip()) };
        let stride = if ahead { stride } else { -stride };
        let mut axis =
            Self { face_m: 0.0, next_m: 0.0, next: face, direction, start_m, per_slope, cell_m, left, stride };
        axis.face_m = axis.next_face_m();
        axis.next += direction;
        axis.next_m = axis.next_face_m();
        axis
    }

    fn next_face_m(&self) -> f64 {
        (self.next * self.cell_m - self.start_m) * self.per_slope
    }

    /// Into the next cell if that is so, without a branch that nobody could foretell.
    fn step(&mut self, taken: bool) {
        self.face_m = if taken { self.next_m } else { self.face_m };
        self.next += if taken { self.direction } else { 0.0 };
        self.next_m = self.next_face_m();
        self.left -= i32::from(taken);
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

    /// From cell to cell (Amanatides & Woo 1987); faces are computed from their numbers, so that nothing drifts.
    fn march(&self, p: DVec3, d: DVec3, from_m: f64, to_m: f64, visit: &mut dyn FnMut(f64, f64) -> bool) {
        let [cx, cy, cz] = self.coarse_size.map(|n| n as i32);
        let (counts, strides) = ([cx, cy, cz], [1, cx, cx * cy]);
        // A little further, so that a point on a face counts to the cell ahead; cells know their neighbours' values.
        let inside = (p + d * (from_m + AHEAD * self.cell_m.min_element()) - self.min_m) * self.cells_per_m;
        let relative = p - self.min_m;
        let first: [i32; 3] = std::array::from_fn(|i| (inside[i] as i32).clamp(0, counts[i] - 1));
        let [mut x, mut y, mut z]: [Axis; 3] =
            std::array::from_fn(|i| Axis::new(relative[i], d[i], first[i], self.cell_m[i], counts[i], strides[i]));
        let mut cell = first[0] + first[1] * strides[1] + first[2] * strides[2];
        let mut t = from_m;
        loop {
            let face_m = x.face_m.min(y.face_m).min(z.face_m);
            let along_x = x.face_m <= face_m;
            let along_y = !along_x & (y.face_m <= face_m);
            let along_z = !(along_x | along_y);
            x.step(along_x);
            y.step(along_y);
            z.step(along_z);
            // The last cell holds to the end, whatever rounding makes of the face of the box.
            let leaves = x.left | y.left | z.left < 0;
            t = if leaves { to_m } else { face_m.max(t).min(to_m) };
            if !visit(t, self.majorant[cell as usize]) || t >= to_m {
                return;
            }
            let masked = |axis: &Axis, taken: bool| axis.stride & -i32::from(taken);
            cell += masked(&x, along_x) + masked(&y, along_y) + masked(&z, along_z);
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
        for i in 0..200 {
            let grid = bumpy().in_cells_of(1 + i as usize % 6);
            let f = f64::from(i);
            let p = DVec3::new(f.sin(), (2.0 * f).cos(), (3.0 * f).sin()) * 2.0;
            let d = (DVec3::new((5.0 * f).cos(), f.sin(), 0.3 * (7.0 * f).sin()) - 0.3 * p).normalize();
            let Some((start, end)) = clip(p, d, grid.min_m, grid.max_m()) else { continue };
            let mut t = start;
            grid.march(p, d, start, end, &mut |stretch_end, majorant| {
                assert!(stretch_end >= t);
                for k in 0..=10 {
                    let density = grid.density(p + d * (t + (stretch_end - t) * f64::from(k) / 10.0));
                    assert!(density <= majorant * (1.0 + 1e-6) + 1e-6, "{density} above {majorant}");
                }
                t = stretch_end;
                true
            });
            assert_eq!(t, end);
        }
    }

    #[test]
    fn a_march_reaches_the_end_and_its_majorants_hold_also_along_the_axes() {
        for i in 0..200 {
            let grid = bumpy().in_cells_of(1 + i as usize % 6);
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
    fn cells_are_a_mean_free_path_long_where_voxels_allow_it() {
        let voxels = |extinction_per_m: f64| bumpy().for_extinction(extinction_per_m).voxels_per_cell;
        let densest = bumpy().density.iter().copied().fold(0.0, f64::max);
        let per_m = CELL_OPTICAL_DEPTH / (densest * bumpy().voxel_m.min_element());
        assert_eq!([0.0, per_m / 100.0, per_m / 5.0, per_m, 100.0 * per_m].map(voxels), [16, 16, 5, 1, 1]);
    }

    #[test]
    fn impossible_grids_are_refused() {
        let make = |n, samples| GridField::new(DVec3::ZERO, DVec3::ONE, UVec3::splat(n), samples);
        assert!(matches!(make(0, vec![]), Err(GridError::Empty { .. })));
        assert!(matches!(make(2, vec![1.0; 7]), Err(GridError::Count { expected: 8, found: 7, .. })));
        assert!(matches!(make(1, vec![f64::NAN]), Err(GridError::Sample { index: 0, .. })));
    }
}
