//! How far a picture is from the path tracer's.

use welkin_lut::Bands;

use super::truth::Truth;
use super::views::PIXELS;

/// Squared error and energies over a set of blocks; scores of several pictures can be added.
#[derive(Debug, Clone, Copy, Default)]
pub struct Score {
    squares: f64,
    noise: f64,
    blocks: f64,
    pictures: f64,
    log_energy: f64,
}

/// Blocks with an opacity in this range count.
pub const CLOUDY: [f64; 2] = [0.5, 1.1];
/// The edges of clouds.
pub const THIN: [f64; 2] = [0.03, 0.3];

/// Means over blocks of two by two pixels.
fn blocks(of: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut means = Vec::new();
    for y in (0..PIXELS[1]).step_by(2) {
        for x in (0..PIXELS[0]).step_by(2) {
            let corner = y * PIXELS[0] + x;
            means.push(
                [corner, corner + 1, corner + PIXELS[0], corner + PIXELS[0] + 1].map(&of).iter().sum::<f64>() / 4.0,
            );
        }
    }
    means
}

impl Score {
    /// Compares a picture with a band of the truth. The truth's own noise is taken out of the squared error.
    pub fn new(picture: &[f64], truth: &Truth, band: usize, opacity: &[f64], range: [f64; 2]) -> Self {
        let of = |bands: &[Bands]| blocks(|i| bands[i][band]);
        let (mean, opacity, found) = (of(&truth.mean), blocks(|i| opacity[i]), blocks(|i| picture[i]));
        let error = blocks(|i| truth.error[i][band].powi(2)).into_iter().map(|v| (v / 4.0).sqrt());
        let (mut score, mut energy) = (Self::default(), [0.0; 2]);
        for (((mean, error), opacity), found) in mean.into_iter().zip(error).zip(opacity).zip(found) {
            if opacity >= range[0] && opacity < range[1] && mean > 1e-5 {
                score.squares += (found.max(1e-7) / mean).ln().powi(2);
                score.noise += (error / mean).powi(2).min(0.25);
                score.blocks += 1.0;
                energy = [energy[0] + found, energy[1] + mean];
            }
        }
        if score.blocks > 0.0 {
            // A picture counts once, however many blocks it has.
            score.squares /= score.blocks;
            score.noise /= score.blocks;
            score.pictures = 1.0;
            score.log_energy = (energy[0] / energy[1]).ln();
        }
        score
    }

    /// Together with another.
    pub fn and(self, other: Self) -> Self {
        Self {
            squares: self.squares + other.squares,
            noise: self.noise + other.noise,
            blocks: self.blocks + other.blocks,
            pictures: self.pictures + other.pictures,
            log_energy: self.log_energy + other.log_energy,
        }
    }

    /// RMS of ln(radiance ratio).
    pub fn rms(&self) -> f64 {
        ((self.squares - self.noise) / self.pictures).max(0.0).sqrt()
    }

    /// The truth's own part of that, which was taken out.
    pub fn noise(&self) -> f64 {
        (self.noise / self.pictures).sqrt()
    }

    /// Geometric mean over the pictures of the ratio of their energies.
    pub fn energy(&self) -> f64 {
        (self.log_energy / self.pictures).exp()
    }
}

impl std::fmt::Display for Score {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{:.2}/{:.2}", self.rms(), self.energy())
    }
}
