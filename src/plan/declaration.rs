//! What a pass says about itself before it runs.

use std::fmt::{self, Write as _};
use std::hash::{DefaultHasher, Hasher as _};

use super::Facts;

/// Whether a scene calls for a pass, and why, in words and numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Need {
    /// The picture would be wrong without it.
    Needed(String),
    /// The picture is the same without it.
    NotNeeded(String),
}

/// A pass as the plan knows it: no word of how it computes.
#[derive(Clone, Copy)]
pub struct Declaration {
    /// The stem of its `.rs` and `.wgsl`.
    pub name: &'static str,
    /// Whether the scene calls for it.
    pub need: fn(&Facts) -> Need,
    /// Names of the resources of other passes that it reads.
    pub reads: &'static [&'static str],
    /// Names of the resources that it fills.
    pub writes: &'static [&'static str],
    /// What its result depends on besides `reads`.
    pub inputs: fn(&Facts) -> Fingerprint,
    /// Bytes of the resources that it fills.
    pub bytes: fn(&Facts) -> u64,
}

/// Stands for a set of inputs: equal inputs have equal fingerprints.
#[derive(Debug, Clone, PartialEq)]
pub struct Fingerprint {
    hash: u64,
    /// Inputs that results may lag behind, and by how much.
    followed: Vec<(f64, f64)>,
}

impl Fingerprint {
    /// Of anything whose debug text holds all that matters; that of an f64 is exact.
    pub fn of(inputs: &impl fmt::Debug) -> Self {
        struct HashWriter(DefaultHasher);
        impl fmt::Write for HashWriter {
            fn write_str(&mut self, text: &str) -> fmt::Result {
                self.0.write(text.as_bytes());
                Ok(())
            }
        }
        let mut writer = HashWriter(DefaultHasher::new());
        // Writing into a hasher cannot fail.
        let _ = write!(writer, "{inputs:?}");
        Self { hash: writer.0.finish(), followed: Vec::new() }
    }

    /// With numbers that the result may lag behind, each with by how much; 0 for not at all.
    pub fn following(self, followed: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { followed: followed.into_iter().collect(), ..self }
    }

    /// With the results that it reads.
    pub(super) fn reading(self, read: &[Option<&Self>]) -> Self {
        Self { hash: Self::of(&(self.hash, read)).hash, followed: self.followed }
    }

    /// How far a result of these inputs lags behind others, as a share of what it may; none where it is a result of
    /// something else.
    pub(super) fn lag_behind(&self, now: &Self) -> Option<f64> {
        if self.hash == now.hash { self.lag_of_values(now) } else { None }
    }

    /// The same where only the followed numbers are looked at; none where there are not as many.
    pub(super) fn lag_of_values(&self, now: &Self) -> Option<f64> {
        // What has not moved does not lag, also behind what nothing may lag behind.
        let lag = |((before, _), (now, slack)): (&(f64, f64), &(f64, f64))| {
            let moved: f64 = (before - now).abs();
            if moved == 0.0 { 0.0 } else { moved / slack }
        };
        (self.followed.len() == now.followed.len())
            .then(|| self.followed.iter().zip(&now.followed).map(lag).fold(0.0, f64::max))
    }
}

#[cfg(test)]
mod tests {
    use super::Fingerprint;

    #[test]
    fn the_smallest_change_of_an_input_changes_the_fingerprint() {
        let elevation_rad = 0.1_f64;
        assert_eq!(Fingerprint::of(&[elevation_rad]), Fingerprint::of(&[0.1_f64]));
        assert_ne!(Fingerprint::of(&[elevation_rad]), Fingerprint::of(&[elevation_rad.next_up()]));
    }

    #[test]
    fn results_lag_behind_what_they_follow_and_nothing_else() {
        let of = |inputs: u32, followed: f64, slack: f64| Fingerprint::of(&inputs).following([(followed, slack)]);
        assert_eq!(of(1, 2.0, 0.0).lag_behind(&of(1, 2.0, 0.0)), Some(0.0));
        assert_eq!(of(1, 2.0, 0.0).lag_behind(&of(1, 2.5, 1.0)), Some(0.5));
        assert_eq!(of(1, 2.0, 1.0).lag_behind(&of(1, 2.5, 0.0)), Some(f64::INFINITY));
        assert_eq!(of(1, 2.0, 1.0).lag_behind(&of(2, 2.0, 1.0)), None);
        assert_eq!(of(1, 2.0, 1.0).lag_behind(&Fingerprint::of(&1)), None);
    }
}
