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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Fingerprint(u64);

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
        Self(writer.0.finish())
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
}
