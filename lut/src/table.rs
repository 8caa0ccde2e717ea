//! A table of three bands in rows, slices of rows, and how it is read between texels.

use crate::Bands;

/// Texels in rows from y = 0, then slices from z = 0; a flat table has one slice. Read as a sampler reads: texel i of n
/// is centred on (i + 1/2) / n, linear between centres, clamped to the edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    size: [u32; 3],
    texels: Vec<Bands>,
}

impl Table {
    /// A table of `size` (columns, rows, slices), each at least 1, from its texels in order.
    ///
    /// # Panics
    /// When there are not as many texels as the size says: a mistake of the caller's, not of a user's.
    pub fn new(size: [u32; 3], texels: Vec<Bands>) -> Self {
        let expected: usize = size.iter().map(|&side| side as usize).product();
        assert!(expected == texels.len() && expected > 0, "{size:?} and {} texels", texels.len());
        Self { size, texels }
    }

    /// Columns, rows and slices.
    pub fn size(&self) -> [u32; 3] {
        self.size
    }

    /// All texels, row by row, slice by slice.
    pub fn texels(&self) -> &[Bands] {
        &self.texels
    }

    /// One texel.
    pub fn texel(&self, x: u32, y: u32, z: u32) -> Bands {
        let [width, height, _] = self.size.map(|side| side as usize);
        self.texels[(z as usize * height + y as usize) * width + x as usize]
    }

    /// A slice as a table of its own.
    pub fn slice(&self, z: u32) -> Self {
        let [width, height, _] = self.size;
        let texels = (width * height) as usize;
        Self::new([width, height, 1], self.texels[z as usize * texels..][..texels].to_vec())
    }

    /// Linear between the texels around (x, y) of a slice, in texels from the centre of the first.
    pub fn bilinear(&self, [x, y]: [f64; 2], z: u32) -> Bands {
        let ([x0, x1], fx) = neighbours(x, self.size[0]);
        let ([y0, y1], fy) = neighbours(y, self.size[1]);
        let row = |y| mix(self.texel(x0, y, z), self.texel(x1, y, z), fx);
        mix(row(y0), row(y1), fy)
    }

    /// Linear between the texels around (x, y, z), in texels from the centre of the first.
    pub fn trilinear(&self, [x, y, z]: [f64; 3]) -> Bands {
        let ([z0, z1], fz) = neighbours(z, self.size[2]);
        mix(self.bilinear([x, y], z0), self.bilinear([x, y], z1), fz)
    }

    /// [`Table::bilinear`] at unit coordinates, of which 0 and 1 are the centres of the first and last texel.
    pub fn at_unit(&self, unit: [f64; 2], z: u32) -> Bands {
        self.bilinear(std::array::from_fn(|i| unit[i] * f64::from(self.size[i] - 1)), z)
    }
}

/// The texels on either side of a coordinate, and the share of the second.
fn neighbours(at: f64, count: u32) -> ([u32; 2], f64) {
    let at = at.clamp(0.0, f64::from(count - 1));
    let low = (at as u32).min(count.saturating_sub(2));
    ([low, (low + 1).min(count - 1)], at - f64::from(low))
}

/// Linear between two values.
pub(crate) fn mix(from: Bands, to: Bands, share: f64) -> Bands {
    std::array::from_fn(|band| from[band] + (to[band] - from[band]) * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every texel holds its own place.
    fn places(size: [u32; 3]) -> Table {
        let [width, height, depth] = size;
        let texels = (0..depth).flat_map(|z| (0..height).flat_map(move |y| (0..width).map(move |x| [x, y, z])));
        Table::new(size, texels.map(|place| place.map(f64::from)).collect())
    }

    #[test]
    fn a_table_of_places_is_read_as_the_place_that_is_asked_for() {
        let table = places([5, 4, 3]);
        assert_eq!(table.texel(4, 2, 1), [4.0, 2.0, 1.0]);
        assert_eq!(table.trilinear([1.25, 2.5, 0.75]), [1.25, 2.5, 0.75]);
        assert_eq!(table.at_unit([1.0, 0.5], 2), [4.0, 1.5, 2.0]);
        assert_eq!(table.slice(2).texel(3, 1, 0), [3.0, 1.0, 2.0]);
        // Clamped to the edge.
        assert_eq!(table.trilinear([-3.0, 9.0, 9.0]), [0.0, 3.0, 2.0]);
        assert_eq!(places([1, 1, 1]).trilinear([7.0, 0.0, 0.0]), [0.0; 3]);
    }
}
