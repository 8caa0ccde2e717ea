//! Pictures for the page: what each preset makes of a scene, the truth, and where they differ.

use std::path::{Path, PathBuf};

use super::{ReportError, Shown};
use crate::output::{AtomicFile, display, write_png};

/// Relative difference at which its colour is full.
pub const FULL_DIFFERENCE: f32 = 0.1;

/// Where the picture of a scene by a preset (or "truth") lies.
pub fn picture_path(folder: &Path, scene: &str, by: &str) -> PathBuf {
    folder.join(format!("{}-{by}.png", file_name(scene)))
}

/// Where the difference from the truth lies.
pub fn difference_path(folder: &Path, scene: &str, by: &str) -> PathBuf {
    folder.join(format!("{}-{by}-difference.png", file_name(scene)))
}

/// A scene's name as part of a file's.
pub fn file_name(scene: &str) -> String {
    scene.chars().map(|c| if c.is_alphanumeric() || c == '-' { c } else { '_' }).collect()
}

/// Writes a picture as a screen shows it, and its difference from the truth: a pixel for each cell of the grid, blue where
/// it is too dark and red where it is too bright.
///
/// # Errors
/// [`ReportError::Output`].
pub fn save_picture(folder: &Path, shown: &Shown) -> Result<(), ReportError> {
    let (scene, frame) = (shown.scene, shown.frame);
    let srgb = display::picture(frame, display::exposed_srgb(scene), scene.display.tone_map);
    let file = AtomicFile::create(&picture_path(folder, &scene.name, shown.by))?;
    write_png(file, frame.width, frame.height, &srgb)?;
    let Some(relative) = &shown.relative else { return Ok(()) };
    let cells = super::SampleGrid::new(scene).cells.camera;
    let bytes: Vec<u8> = relative.iter().flat_map(|bands| colour(bands.iter().sum::<f32>() / 3.0)).collect();
    let file = AtomicFile::create(&difference_path(folder, &scene.name, shown.by))?;
    Ok(write_png(file, cells.width, cells.height, &bytes)?)
}

/// White at 0, full blue and red at the ends.
fn colour(difference: f32) -> [u8; 3] {
    let share = (difference / FULL_DIFFERENCE).clamp(-1.0, 1.0);
    let [full, fading] = [255.0, 255.0 * (1.0 - share.abs())].map(|value| value as u8);
    if share < 0.0 { [fading, fading, full] } else { [full, fading, fading] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_dark_is_blue_and_too_bright_is_red() {
        assert_eq!(colour(0.0), [255, 255, 255]);
        assert_eq!(colour(-0.5), [0, 0, 255]);
        assert_eq!(colour(0.5), [255, 0, 0]);
        assert_eq!(file_name("a b/../c"), "a_b____c");
    }
}
