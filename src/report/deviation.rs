//! How far values are from a truth that is itself uncertain.

use serde::{Deserialize, Serialize};
use welkin_lut::BAND_COUNT;
use welkin_lut::spectrum::Channels;

use schemars::JsonSchema;

/// Share of the truth's mean radiance below which an error is taken relative to that instead.
const DARK: f64 = 1e-4;

/// Relative errors of linear radiance over pixels and bands; of colours relative to the pixel's strongest channel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Deviation {
    /// Root of the mean squared relative error, less what the truth's own noise puts in: the error that the report and
    /// its plots speak of.
    pub rms: f64,
    /// One standard error below it.
    pub low: f64,
    /// One standard error above it.
    pub high: f64,
    /// Root mean square of the truth's relative standard errors, which `rms` has lost already.
    pub noise: f64,
    /// Of |ours / truth - 1| with the noise in it: half of all values are nearer.
    pub median: f64,
    /// 95 % of all values are nearer.
    pub p95: f64,
    /// 99 % of all values are nearer.
    pub p99: f64,
    /// Sum of ours over sum of the truth.
    pub energy_ratio: f64,
    /// Pixels that count.
    pub pixels: usize,
}

/// A truth with its standard errors, pixel by pixel.
#[derive(Debug, Clone, Copy)]
pub struct Uncertain<'a> {
    /// Radiance or colour.
    pub radiance: &'a [[f32; BAND_COUNT]],
    /// One standard error of it.
    pub standard_error: &'a [[f32; BAND_COUNT]],
    /// What the channels hold.
    pub channels: Option<Channels>,
}

impl Deviation {
    /// Of pixels from a truth; those marked in `left_out` do not count. None where nothing is left or the truth is black.
    ///
    /// The squared error of a pixel is that of ours plus the truth's variance, which its standard error estimates, so the
    /// difference is right in the mean; its spread over the pixels gives the bar.
    pub fn of(ours: &[[f32; BAND_COUNT]], truth: &Uncertain, left_out: &[bool]) -> Option<Self> {
        let counted: Vec<usize> = (0..ours.len()).filter(|&pixel| !left_out[pixel]).collect();
        let sum = |values: &[[f32; BAND_COUNT]]| -> f64 {
            counted.iter().flat_map(|&pixel| values[pixel]).map(f64::from).sum()
        };
        let (pixels, light) = (counted.len(), sum(truth.radiance));
        let dark = DARK * light / (pixels * BAND_COUNT) as f64;
        if pixels == 0 || dark <= 0.0 || dark.is_nan() {
            return None;
        }
        let errors = counted.iter().map(|&pixel| relative(ours[pixel], truth, pixel, dark)).collect::<Vec<_>>();
        let mean = |of: &dyn Fn(&BandErrors) -> f64| errors.iter().map(of).sum::<f64>() / pixels as f64;
        let squares = |bands: &BandErrors| band_mean(bands, |(error, noise)| error * error - noise * noise);
        let square = mean(&squares);
        let spread = mean(&|bands| (squares(bands) - square).powi(2));
        let bar = (spread / (pixels as f64 - 1.0).max(1.0)).sqrt();
        let root = |square: f64| square.max(0.0).sqrt();
        let mut sizes: Vec<f64> = errors.iter().flatten().map(|(error, _)| error.abs()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let quantile = |share: f64| sizes[((share * sizes.len() as f64).ceil() as usize).clamp(1, sizes.len()) - 1];
        Some(Self {
            rms: root(square),
            low: root(square - bar),
            high: root(square.max(0.0) + bar),
            noise: root(mean(&|bands| band_mean(bands, |(_, noise)| noise * noise))),
            median: quantile(0.5),
            p95: quantile(0.95),
            p99: quantile(0.99),
            energy_ratio: sum(ours) / light,
            pixels,
        })
    }
}

/// Root of the mean squared relative difference of a picture from another, as [`Deviation::rms`] is of one from the truth. None where
/// nothing is left, or the other picture is black.
pub fn distance(
    ours: &[[f32; BAND_COUNT]],
    other: &[[f32; BAND_COUNT]],
    channels: Channels,
    left_out: &[bool],
) -> Option<f64> {
    let exact = vec![[0.0; BAND_COUNT]; other.len()];
    let other = Uncertain { radiance: other, standard_error: &exact, channels: Some(channels) };
    Some(Deviation::of(ours, &other, left_out)?.rms)
}

/// Relative error and relative standard error of the truth, in each band of a pixel.
type BandErrors = [(f64, f64); BAND_COUNT];

fn band_mean(bands: &BandErrors, of: impl Fn((f64, f64)) -> f64) -> f64 {
    bands.iter().map(|band| of(*band)).sum::<f64>() / BAND_COUNT as f64
}

fn relative(ours: [f32; BAND_COUNT], truth: &Uncertain, pixel: usize, dark: f64) -> BandErrors {
    let (value, noise) = (truth.radiance[pixel].map(f64::from), truth.standard_error[pixel].map(f64::from));
    let strongest = value.iter().fold(dark, |strongest, value| strongest.max(*value));
    std::array::from_fn(|band| {
        let scale = match truth.channels {
            Some(Channels::Colour(_)) => strongest,
            _ => value[band].max(dark),
        };
        ((f64::from(ours[band]) - value[band]) / scale, noise[band] / scale)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::{Rng as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    const PIXELS: usize = 400;

    /// A truth of 1 that is off by normal noise of a standard error.
    fn noisy(standard_error: f64, seed: u64) -> Vec<[f32; 3]> {
        let mut generator = Pcg64::seed_from_u64(seed);
        let mut uniform = || (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        // A sum of twelve: variance 1.
        let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        (0..PIXELS).map(|_| std::array::from_fn(|_| (1.0 + standard_error * normal()) as f32)).collect()
    }

    fn deviation(ours: f32, noise: f64, stated: f64) -> Deviation {
        let (radiance, standard_error) = (noisy(noise, 7), vec![[stated as f32; 3]; PIXELS]);
        let truth = Uncertain { radiance: &radiance, standard_error: &standard_error, channels: None };
        Deviation::of(&vec![[ours; 3]; PIXELS], &truth, &[false; PIXELS]).unwrap()
    }

    #[test]
    fn an_error_is_found_below_the_noise_of_the_truth() {
        let found = deviation(1.02, 0.03, 0.03);
        assert!(found.low - 0.002 < 0.02 && 0.02 < found.high + 0.002, "{found:?}");
        assert!((found.noise - 0.03).abs() < 0.002);
        // What is said of the noise matters: unsaid, it counts as error.
        assert!(deviation(1.02, 0.03, 0.0).low > 0.03);
    }

    #[test]
    fn a_perfect_picture_has_no_error_that_could_be_told_from_zero() {
        let found = deviation(1.0, 0.03, 0.03);
        assert!(found.low == 0.0 && found.high < 0.012, "{found:?}");
    }

    #[test]
    fn what_is_left_out_does_not_count_and_what_is_black_is_no_truth() {
        let radiance = [[1.0; 3], [1.0; 3]];
        let truth = Uncertain { radiance: &radiance, standard_error: &[[0.0; 3]; 2], channels: None };
        let ours = [[1.5; 3], [1.0; 3]];
        assert_eq!(Deviation::of(&ours, &truth, &[true, false]).unwrap().rms, 0.0);
        assert!((Deviation::of(&ours, &truth, &[false, true]).unwrap().rms - 0.5).abs() < 1e-12);
        let black = Uncertain { radiance: &[[0.0; 3]; 2], ..truth };
        assert_eq!(Deviation::of(&ours, &black, &[false, false]), None);
    }
}
