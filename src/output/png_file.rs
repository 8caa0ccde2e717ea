//! PNG: what a screen shows.

use std::io::BufWriter;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::{AtomicFile, OutputError};

/// Writes a picture of sRGB bytes, three a pixel, row by row from the top left.
///
/// # Errors
/// [`OutputError::Encode`] or [`OutputError::Write`]; then nothing is left behind.
///
/// # Panics
/// When there are not `3 * width * height` bytes.
pub fn write_png(mut file: AtomicFile, width: u32, height: u32, srgb: &[u8]) -> Result<(), OutputError> {
    assert_eq!(srgb.len(), 3 * width as usize * height as usize, "bytes of a picture of {width} x {height} pixels");
    let encoded =
        PngEncoder::new(BufWriter::new(file.file())).write_image(srgb, width, height, ExtendedColorType::Rgb8);
    encoded.map_err(|source| OutputError::Encode { path: file.path().to_owned(), source: source.into() })?;
    file.commit()
}
