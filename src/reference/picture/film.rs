//! What has been gathered of a picture so far: for every pixel a mean, and how sure it is.

use bytemuck::{Pod, Zeroable};
use welkin_lut::{BAND_COUNT, Bands};

/// A pixel darker than this share of the picture's mean counts as if it were as bright, so that one black pixel does
/// not decide about the relative error of a picture.
const DARKEST_SHARE: f64 = 0.01;

/// Which of the pixels are gathered: those whose number leaves the remainder `index` when divided by `count`.
///
/// A pixel depends on nothing but its number, so the parts of a picture need no sum to become the whole: merged, they
/// are the same to the last bit as one run of all. Neighbouring pixels fall into different parts, which spreads the
/// work evenly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 0.
    pub index: u32,
    /// At least 1.
    pub count: u32,
}

impl Shard {
    /// All of the picture.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// How many of a picture's pixels are in this part.
    pub fn pixels_of(self, all: usize) -> usize {
        let (index, count) = (self.index as usize, self.count as usize);
        (all + count - 1).saturating_sub(index) / count
    }

    /// Number of the picture's pixel that is the part's pixel `number`.
    pub fn pixel(self, number: usize) -> usize {
        self.index as usize + number * self.count as usize
    }
}

/// `I/N` with 1 ≤ I ≤ N, as people count.
impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse::<u32>().ok()?, n.parse::<u32>().ok()?)));
        match numbers {
            Some((number, count)) if (1..=count).contains(&number) => Ok(Self { index: number - 1, count }),
            _ => Err(format!("'{text}' is not I/N with 1 ≤ I ≤ N, as in 2/4")),
        }
    }
}

/// Mean and spread of the batches of one pixel (Welford 1962), batch by batch in order: the same to the last bit
/// wherever a run was interrupted and however many threads it had.
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable)]
#[repr(C)]
pub struct PixelMean {
    /// Batches so far.
    pub batches: u64,
    /// Their mean, W·m⁻²·sr⁻¹·nm⁻¹.
    pub mean: Bands,
    /// Sum of their squared deviations from it.
    pub squares: Bands,
}

impl PixelMean {
    /// Adds the mean over one more batch.
    pub fn add(&mut self, batch: Bands) {
        self.batches += 1;
        for ((mean, squares), value) in self.mean.iter_mut().zip(&mut self.squares).zip(batch) {
            let before = value - *mean;
            *mean += before / self.batches as f64;
            *squares += before * (value - *mean);
        }
    }

    /// One standard error of the mean; infinite where fewer than two batches cannot tell.
    pub fn standard_error(&self) -> Bands {
        if self.batches < 2 {
            return [f64::INFINITY; BAND_COUNT];
        }
        let n = self.batches as f64;
        self.squares.map(|squares| (squares / (n * (n - 1.0))).sqrt())
    }
}

/// The pixels of one part of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Which part.
    pub shard: Shard,
    /// The part's pixels, in the picture's order.
    pub pixels: Vec<PixelMean>,
    /// Batches that every pixel is to have before the next look at the error.
    pub goal: u64,
}

/// A picture is larger than memory.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no memory for {pixels} pixels ({bytes} bytes); make the picture smaller, or trace it in parts with --shard")]
pub struct FilmError {
    /// How many.
    pub pixels: usize,
    /// What they take.
    pub bytes: usize,
}

impl Film {
    /// Unexposed film for the part of a picture with so many pixels.
    pub fn new(shard: Shard, picture_pixels: usize) -> Self {
        Self { shard, pixels: vec![PixelMean::default(); shard.pixels_of(picture_pixels)], goal: 0 }
    }

    /// The same where the picture may be larger than memory.
    ///
    /// # Errors
    /// [`FilmError`] with what it takes.
    pub fn with_room(shard: Shard, picture_pixels: usize) -> Result<Self, FilmError> {
        let count = shard.pixels_of(picture_pixels);
        let mut pixels = Vec::new();
        let no_room = |_| FilmError { pixels: count, bytes: count.saturating_mul(size_of::<PixelMean>()) };
        pixels.try_reserve_exact(count).map_err(no_room)?;
        pixels.resize(count, PixelMean::default());
        Ok(Self { shard, pixels, goal: 0 })
    }

    /// Whether every pixel has reached the goal.
    pub fn is_level(&self) -> bool {
        self.pixels.iter().all(|pixel| pixel.batches >= self.goal)
    }

    /// Root mean square, over pixels and bands, of the standard error relative to the pixel's radiance (or to 1 % of
    /// the picture's mean in the band, where that is more). Zero for a picture that is black, infinite before two
    /// batches.
    pub fn relative_error(&self) -> f64 {
        let n = self.pixels.len() as f64;
        let mean: Bands = std::array::from_fn(|j| self.pixels.iter().map(|pixel| pixel.mean[j].abs()).sum::<f64>() / n);
        let mut sum = 0.0;
        for pixel in &self.pixels {
            let error = pixel.standard_error();
            for j in 0..BAND_COUNT {
                if error[j] > 0.0 {
                    sum += (error[j] / pixel.mean[j].abs().max(DARKEST_SHARE * mean[j])).powi(2);
                }
            }
        }
        if self.pixels.is_empty() { 0.0 } else { (sum / (n * BAND_COUNT as f64)).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_pixels_without_gap_or_overlap() {
        for (all, count) in [(12, 4), (13, 4), (3, 5), (1, 1)] {
            let mut seen = vec![0; all];
            for index in 0..count {
                let shard = Shard { index, count };
                (0..shard.pixels_of(all)).for_each(|number| seen[shard.pixel(number)] += 1);
            }
            assert!(seen.iter().all(|&times| times == 1), "{all} pixels in {count} parts: {seen:?}");
        }
    }

    #[test]
    fn mean_and_standard_error_are_those_of_the_textbook() {
        let values = [1.0, 4.0, 2.5, 8.0, -1.0];
        let mut pixel = PixelMean::default();
        values.iter().for_each(|&value| pixel.add([value, 10.0 * value, 0.0]));
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
        assert!((pixel.mean[0] - mean).abs() < 1e-15);
        assert!((pixel.standard_error()[0] - (variance / n).sqrt()).abs() < 1e-15);
        assert!((pixel.standard_error()[1] - 10.0 * (variance / n).sqrt()).abs() < 1e-14);
        assert_eq!(pixel.standard_error()[2], 0.0);
    }

    #[test]
    fn the_relative_error_of_a_picture_is_that_of_its_pixels() {
        let mut film = Film::new(Shard::WHOLE, 10);
        assert_eq!(film.relative_error(), f64::INFINITY);
        for (i, pixel) in film.pixels.iter_mut().enumerate() {
            // Mean i + 1 with a standard error of 10 % of it.
            let level = (i + 1) as f64;
            pixel.add([0.9 * level; BAND_COUNT]);
            pixel.add([1.1 * level; BAND_COUNT]);
        }
        assert!((film.relative_error() - 0.1).abs() < 1e-12, "{}", film.relative_error());
        assert_eq!(Film { pixels: vec![PixelMean { batches: 2, ..Default::default() }], ..film }.relative_error(), 0.0);
    }
}
