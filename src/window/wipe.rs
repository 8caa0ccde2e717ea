//! Which pictures are shown side by side: the real-time frame, the truth, their difference.

/// A picture that can be shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// What the renderer computes in real time.
    RealTime,
    /// What the reference computes.
    Truth,
    /// How far the first is from the second.
    Difference,
}

/// The pictures to the left and right of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wipe {
    /// What is compared.
    pub pair: [Shown; 2],
    /// Where the line is: a share of the window's width.
    pub at: f32,
}

impl Default for Wipe {
    fn default() -> Self {
        Self { pair: PAIRS[0], at: 0.5 }
    }
}

/// All that can be compared, in the order in which a key goes through them.
pub const PAIRS: [[Shown; 2]; 3] =
    [[Shown::RealTime, Shown::Truth], [Shown::RealTime, Shown::Difference], [Shown::Truth, Shown::Difference]];

impl Wipe {
    /// The next pair.
    pub fn turn(&mut self) {
        let present = PAIRS.iter().position(|pair| *pair == self.pair).unwrap_or(0);
        self.pair = PAIRS[(present + 1) % PAIRS.len()];
    }

    /// Moves the line.
    pub fn shift(&mut self, by: f32) {
        self.at = (self.at + by).clamp(0.0, 1.0);
    }

    /// What the pair is called.
    pub fn name(&self) -> String {
        let name = |shown: Shown| match shown {
            Shown::RealTime => "real time",
            Shown::Truth => "truth",
            Shown::Difference => "difference",
        };
        format!("{} | {}", name(self.pair[0]), name(self.pair[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_comes_round_and_the_line_stays_in_the_window() {
        let mut wipe = Wipe::default();
        let names: Vec<_> = (0..4)
            .map(|_| {
                wipe.turn();
                wipe.name()
            })
            .collect();
        assert_eq!(names, ["real time | difference", "truth | difference", "real time | truth", names[0].as_str()]);
        wipe.shift(2.0);
        assert_eq!(wipe.at, 1.0);
    }
}
