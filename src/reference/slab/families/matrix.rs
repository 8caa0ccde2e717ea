//! Square matrices of a few dozen rows.

/// A square matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    size: usize,
    values: Vec<f64>,
}

impl Matrix {
    /// From its elements, by row and column.
    pub fn from_fn(size: usize, element: impl Fn(usize, usize) -> f64) -> Self {
        Self { size, values: (0..size * size).map(|at| element(at / size, at % size)).collect() }
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.size + column]
    }

    /// Element by element: `self` + `factor` × `other`.
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        Self::from_fn(self.size, |row, column| self.at(row, column) + factor * other.at(row, column))
    }

    /// 1 + `factor` × `self`.
    pub fn identity_plus(&self, factor: f64) -> Self {
        Self::from_fn(self.size, |row, column| f64::from(u8::from(row == column)) + factor * self.at(row, column))
    }

    /// The product with another.
    pub fn times(&self, other: &Self) -> Self {
        let element = |row: usize, column: usize| (0..self.size).map(|k| self.at(row, k) * other.at(k, column)).sum();
        Self::from_fn(self.size, element)
    }

    /// The product with a column.
    pub fn apply(&self, column: &[f64]) -> Vec<f64> {
        (0..self.size).map(|row| (0..self.size).map(|k| self.at(row, k) * column[k]).sum()).collect()
    }

    /// The inverse, by Gauss and Jordan with the largest pivot of each column; the matrix must have one.
    pub fn inverse(&self) -> Self {
        let n = self.size;
        let mut left = self.clone();
        let mut right = Self::from_fn(n, |row, column| f64::from(u8::from(row == column)));
        for column in 0..n {
            let by_size = |a: &usize, b: &usize| left.at(*a, column).abs().total_cmp(&left.at(*b, column).abs());
            let pivot = (column..n).max_by(by_size).unwrap_or(column);
            for matrix in [&mut left, &mut right] {
                (0..n).for_each(|k| matrix.values.swap(pivot * n + k, column * n + k));
            }
            let scale = 1.0 / left.at(column, column);
            for row in (0..n).filter(|row| *row != column) {
                let factor = scale * left.at(row, column);
                for matrix in [&mut left, &mut right] {
                    (0..n).for_each(|k| matrix.values[row * n + k] -= factor * matrix.values[column * n + k]);
                }
            }
            for matrix in [&mut left, &mut right] {
                (0..n).for_each(|k| matrix.values[column * n + k] *= scale);
            }
        }
        right
    }
}

#[cfg(test)]
mod tests {
    use super::Matrix;

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        // The first pivot is 0.
        let matrix =
            Matrix::from_fn(
                5,
                |row, column| if row == 0 && column == 0 { 0.0 } else { 1.0 / (1.0 + (row + 2 * column) as f64) },
            );
        let one = matrix.times(&matrix.inverse());
        let difference = one.plus(-1.0, &Matrix::from_fn(5, |row, column| f64::from(u8::from(row == column))));
        assert!(difference.values.iter().all(|value| value.abs() < 1e-8), "{one:?}");
    }
}
