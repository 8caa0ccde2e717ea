//! Radiances in the directions of a hemisphere, and what they become.

use super::STREAMS;

/// Radiances in the directions of a hemisphere.
pub type Vector = [f64; STREAMS];

/// What radiances in a hemisphere become.
#[derive(Debug, Clone, Copy)]
pub struct Matrix(pub [Vector; STREAMS]);

impl Matrix {
    pub fn from_fn(entry: impl Fn(usize, usize) -> f64) -> Self {
        Self(std::array::from_fn(|row| std::array::from_fn(|column| entry(row, column))))
    }

    pub fn times(&self, vector: &Vector) -> Vector {
        self.0.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
    }

    pub fn column(&self, column: usize) -> Vector {
        self.0.map(|row| row[column])
    }

    /// Row by row, which processors do for several columns at once.
    pub fn product(&self, other: &Self) -> Self {
        let mut product = [[0.0; STREAMS]; STREAMS];
        for (row, factors) in product.iter_mut().zip(&self.0) {
            for (factor, other) in factors.iter().zip(&other.0) {
                add_times(row, *factor, other);
            }
        }
        Self(product)
    }

    pub fn sum(&self, other: &Self) -> Self {
        Self::from_fn(|row, column| self.0[row][column] + other.0[row][column])
    }

    /// (1 - self)⁻¹ of a vector. Its rows sum to less than 1, by which elimination needs no pivots.
    pub fn solve_from_identity(&self, vector: &Vector) -> Vector {
        let mut left = self.taken_from_identity();
        let mut right = *vector;
        for pivot in 0..STREAMS {
            for row in pivot + 1..STREAMS {
                let factor = eliminate(&mut left, pivot, row);
                right[row] -= factor * right[pivot];
            }
        }
        for row in (0..STREAMS).rev() {
            let known: f64 = (row + 1..STREAMS).map(|column| left[row][column] * right[column]).sum();
            right[row] = (right[row] - known) / left[row][row];
        }
        right
    }

    /// (1 - self)⁻¹ other.
    pub fn solve_all(&self, other: &Self) -> Self {
        let mut left = self.taken_from_identity();
        let mut right = other.0;
        for pivot in 0..STREAMS {
            for row in pivot + 1..STREAMS {
                let factor = eliminate(&mut left, pivot, row);
                let of_pivot = right[pivot];
                add_times(&mut right[row], -factor, &of_pivot);
            }
        }
        for row in (0..STREAMS).rev() {
            for column in row + 1..STREAMS {
                let known = right[column];
                add_times(&mut right[row], -left[row][column], &known);
            }
            right[row] = right[row].map(|value| value / left[row][row]);
        }
        Self(right)
    }

    /// 1 - self.
    fn taken_from_identity(&self) -> [Vector; STREAMS] {
        Self::from_fn(|row, column| f64::from(u8::from(row == column)) - self.0[row][column]).0
    }
}

fn add_times(row: &mut Vector, factor: f64, other: &Vector) {
    row.iter_mut().zip(other).for_each(|(entry, other)| *entry += factor * other);
}

/// Takes that multiple of the pivot's row from another which leaves nothing in the pivot's column; returns the factor.
fn eliminate(matrix: &mut [Vector; STREAMS], pivot: usize, row: usize) -> f64 {
    let of_pivot = matrix[pivot];
    let factor = matrix[row][pivot] / of_pivot[pivot];
    add_times(&mut matrix[row], -factor, &of_pivot);
    factor
}
