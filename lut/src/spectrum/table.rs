//! Values at even steps of wavelength.

/// Values at `first_nm`, `first_nm + step_nm`, .., linear in between and constant beyond the ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvenTable<'a> {
    /// Wavelength of the first value, nm.
    pub first_nm: f64,
    /// Distance from one value to the next, nm.
    pub step_nm: f64,
    /// At least one value.
    pub values: &'a [f64],
}

impl EvenTable<'_> {
    /// The value at a wavelength.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let last = self.values.len() - 1;
        let position = ((wavelength_nm - self.first_nm) / self.step_nm).clamp(0.0, last as f64);
        let below = (position as usize).min(last.saturating_sub(1));
        let share = position - below as f64;
        self.values[below] * (1.0 - share) + self.values[(below + 1).min(last)] * share
    }
}

#[cfg(test)]
mod tests {
    use super::EvenTable;

    #[test]
    fn a_table_is_linear_between_its_values_and_constant_beyond() {
        let table = EvenTable { first_nm: 400.0, step_nm: 10.0, values: &[1.0, 3.0, 2.0] };
        let expected =
            [(390.0, 1.0), (400.0, 1.0), (405.0, 2.0), (410.0, 3.0), (417.5, 2.25), (420.0, 2.0), (900.0, 2.0)];
        for (wavelength_nm, value) in expected {
            assert_eq!(table.at(wavelength_nm), value, "{wavelength_nm} nm");
        }
    }
}
