//! `--frames A..B`: pictures of a scene one after the other, as time goes on.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use welkin::scene::Scene;

/// Numbers of frames, the last left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frames(pub Range<u32>);

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once("..").and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        match numbers {
            Some((first, end)) if first < end => Ok(Self(first..end)),
            _ => Err("it must be A..B, as in 0..24, with A below B: frames A to B - 1".to_owned()),
        }
    }
}

impl Frames {
    /// The scene at a frame, of so many a second after its own time.
    pub fn scene_at(scene: &Scene, frame: u32, per_second: f64) -> Scene {
        Scene { time_s: scene.time_s + f64::from(frame) / per_second, ..scene.clone() }
    }
}

/// The file of a frame: its number stands for the last run of `#` in the name, in at least as many digits, or, with four,
/// before the name's ending.
pub fn numbered(path: &Path, frame: u32) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let named = match name.rfind('#') {
        Some(last) => {
            let first = name[..=last].trim_end_matches('#').len();
            let digits = last + 1 - first;
            format!("{}{frame:0digits$}{}", &name[..first], &name[last + 1..])
        }
        None => match name.rsplit_once('.') {
            Some((stem, ending)) => format!("{stem}-{frame:04}.{ending}"),
            None => format!("{name}-{frame:04}"),
        },
    };
    path.with_file_name(named)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_a_range_that_is_not_empty() {
        assert_eq!("3..5".parse(), Ok(Frames(3..5)));
        for wrong in ["", "5", "5..5", "5..3", "-1..3", "a..b", "1..2..3"] {
            assert!(wrong.parse::<Frames>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn each_frame_has_a_file_of_its_own() {
        let name = |path: &str, frame| numbered(Path::new(path), frame).display().to_string();
        assert_eq!(name("out/sky.exr", 7), "out/sky-0007.exr");
        assert_eq!(name("out/sky.###.png", 7), "out/sky.007.png");
        assert_eq!(name("#.png", 123), "123.png");
        assert_eq!(name("a#b##.png", 1), "a#b01.png");
    }
}
