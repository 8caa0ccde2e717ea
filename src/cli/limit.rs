//! Numbers on the command line that must be finite and not negative.

use std::str::FromStr;

/// A finite number, at least 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit(f64);

impl Limit {
    /// The number.
    pub fn get(self) -> f64 {
        self.0
    }
}

impl FromStr for Limit {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0);
        number.map(Self).ok_or("expected a finite number, at least 0")
    }
}
