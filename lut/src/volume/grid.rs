//! A density given by samples.

/// Samples at the centres of the voxels that fill a volume's box. Between them density is trilinear; within half a voxel of
/// the faces it keeps the outermost sample's value.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeGrid {
    size: [usize; 3],
    samples: Vec<f32>,
    largest: f32,
}

/// Why a grid cannot exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VolumeGridError {
    /// A side has no voxels, or more than an index can count.
    #[error("a grid of {0:?} voxels, expected 1 to 1024 along each axis")]
    Size([usize; 3]),
    /// The samples do not fill the grid.
    #[error("{found} samples, expected {expected}: one for each voxel")]
    Count {
        /// x·y·z.
        expected: usize,
        /// The number given.
        found: usize,
    },
    /// A sample is negative, NaN or infinite.
    #[error("sample {index} is {value}, expected a finite number of at least 0")]
    Sample {
        /// Position in the list.
        index: usize,
        /// The value refused.
        value: f32,
    },
}

impl VolumeGrid {
    /// Samples run along x (east before the volume is turned) first, then along y (north), then along z (up).
    ///
    /// # Errors
    /// [`VolumeGridError`] says what is wrong with size, count or a sample.
    pub fn new(size: [usize; 3], samples: Vec<f32>) -> Result<Self, VolumeGridError> {
        if size.iter().any(|n| !(1..=1024).contains(n)) {
            return Err(VolumeGridError::Size(size));
        }
        let expected = size.iter().product();
        if samples.len() != expected {
            return Err(VolumeGridError::Count { expected, found: samples.len() });
        }
        if let Some((index, &value)) = samples.iter().enumerate().find(|(_, d)| !(d.is_finite() && **d >= 0.0)) {
            return Err(VolumeGridError::Sample { index, value });
        }
        let largest = samples.iter().copied().fold(0.0, f32::max);
        Ok(Self { size, samples, largest })
    }

    /// Voxels along x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// All samples, x first.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// The largest sample.
    pub fn largest(&self) -> f32 {
        self.largest
    }

    /// Density at a place in [0, 1]³ of the box.
    pub fn density(&self, share: [f64; 3]) -> f64 {
        let around: [(usize, usize, f64); 3] = std::array::from_fn(|axis| {
            let n = self.size[axis];
            let voxel = (share[axis] * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
            let low = voxel as usize;
            (low, (low + 1).min(n - 1), voxel - low as f64)
        });
        let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
        let [(x0, x1, sx), (y0, y1, sy), (z0, z1, sz)] = around;
        let row = |y: usize, z: usize| {
            let start = (z * self.size[1] + y) * self.size[0];
            mix(f64::from(self.samples[start + x0]), f64::from(self.samples[start + x1]), sx)
        };
        let slice = |z: usize| mix(row(y0, z), row(y1, z), sy);
        mix(slice(z0), slice(z1), sz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_met_at_the_centres_of_their_voxels_and_interpolated_between() {
        let grid = VolumeGrid::new([2, 1, 2], vec![1.0, 3.0, 5.0, 7.0]).unwrap();
        assert_eq!(grid.density([0.25, 0.5, 0.25]), 1.0);
        assert_eq!(grid.density([0.75, 0.1, 0.75]), 7.0);
        assert_eq!(grid.density([0.5, 0.5, 0.5]), 4.0);
        assert_eq!(grid.density([0.0, 0.5, 0.0]), 1.0);
    }

    #[test]
    fn impossible_grids_are_refused() {
        assert_eq!(VolumeGrid::new([0, 1, 1], vec![]), Err(VolumeGridError::Size([0, 1, 1])));
        let count = VolumeGridError::Count { expected: 8, found: 7 };
        assert_eq!(VolumeGrid::new([2; 3], vec![0.0; 7]), Err(count));
        let negative = VolumeGridError::Sample { index: 0, value: -1.0 };
        assert_eq!(VolumeGrid::new([1; 3], vec![-1.0]), Err(negative));
    }
}
