//! Linear equations whose matrix is a band around the diagonal.

/// Equations in which unknown i stands with those from i - half to i + half.
pub struct Banded {
    half: usize,
    /// Of row r the coefficients from column r - half on.
    rows: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl Banded {
    /// No equations yet, for `count` unknowns.
    pub fn new(count: usize, half: usize) -> Self {
        Self { half, rows: vec![vec![0.0; 2 * half + 1]; count], right: vec![0.0; count] }
    }

    /// Adds to a coefficient; the column must lie in the band.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row][column + self.half - row] += value;
    }

    /// Adds to a right-hand side.
    pub fn add_right(&mut self, row: usize, value: f64) {
        self.right[row] += value;
    }

    /// The unknowns, by elimination with row pivots.
    pub fn solve(mut self) -> Vec<f64> {
        let count = self.rows.len();
        // Rows that take part in a column's elimination begin at that column, so that they can change places.
        for (index, row) in self.rows.iter_mut().enumerate() {
            row.rotate_left(self.half.saturating_sub(index));
        }
        for column in 0..count {
            let end = (column + self.half + 1).min(count);
            let pivot = (column..end).max_by(|&a, &b| self.rows[a][0].abs().total_cmp(&self.rows[b][0].abs()));
            self.rows.swap(column, pivot.unwrap_or(column));
            self.right.swap(column, pivot.unwrap_or(column));
            let (done, rest) = self.rows.split_at_mut(column + 1);
            let lead = &done[column];
            for (offset, row) in rest[..end - column - 1].iter_mut().enumerate() {
                let factor = row[0] / lead[0];
                for i in 1..row.len() {
                    row[i - 1] = row[i] - factor * lead[i];
                }
                row[2 * self.half] = 0.0;
                self.right[column + 1 + offset] -= factor * self.right[column];
            }
        }
        for row in (0..count).rev() {
            let after = self.rows[row].iter().zip(&self.right[row..]).skip(1);
            let known: f64 = after.map(|(coefficient, value)| coefficient * value).sum();
            self.right[row] = (self.right[row] - known) / self.rows[row][0];
        }
        self.right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_that_needs_pivots_gives_back_what_it_was_made_from() {
        let value = |i: usize| (i as f64 * 0.7).sin() + 0.3;
        let mut equations = Banded::new(40, 3);
        for row in 0..40_usize {
            for column in row.saturating_sub(3)..(row + 4).min(40) {
                // Nothing on the diagonal.
                let coefficient = if row == column { 0.0 } else { 1.0 + ((7 * row + 3 * column) % 5) as f64 };
                equations.add(row, column, coefficient);
                equations.add_right(row, coefficient * value(column));
            }
        }
        for (i, found) in equations.solve().into_iter().enumerate() {
            assert!((found - value(i)).abs() < 1e-9, "{i}: {found}");
        }
    }
}
