//! Error metrics on linear radiance, and FLIP on what a screen would show of it.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8};
use serde::Serialize;
use welkin_lut::spectrum::{Channels, ColourSpace};
use welkin_lut::{BAND_COUNT, BAND_NAMES};

use crate::frame::Frame;
use crate::output::display;
use crate::scene::ToneMap;

/// Share of the reference's mean radiance below which an error is taken relative to that instead: what is ten thousand
/// times darker than the picture is black beside it, and its ratio says nothing.
const DARK: f64 = 1e-4;

/// How far a frame is from a reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Comparison {
    /// Pixels times bands compared: all of them.
    pub values: usize,
    /// |a - b| / b over all pixels and bands, of colours over the pixel's strongest channel; b counts as at least 1e-4 of
    /// its mean.
    pub relative_error: RelativeErrors,
    /// Root mean square of ln(a / b) where both are above 1e-4 of the reference's mean.
    pub rms_ln_ratio: f64,
    /// Values that `rms_ln_ratio` leaves out because either is too dark.
    pub dark_values: usize,
    /// Sum of a over sum of b.
    pub energy_ratio: f64,
    /// Mean FLIP error in [0, 1] (Andersson et al. 2020), at 67 pixels per degree, after the filmic curve with an
    /// exposure that brings the reference's logarithmic mean to middle grey.
    pub mean_flip: f64,
}

/// Quantiles of the relative error over all pixels and bands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RelativeErrors {
    /// Half of all values are nearer.
    pub median: f64,
    /// 95 % of all values are nearer.
    pub p95: f64,
    /// 99 % of all values are nearer.
    pub p99: f64,
    /// The farthest value.
    pub max: f64,
}

/// Why two frames cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MetricsError {
    /// The frames' channels hold different things.
    #[error("the colour spaces differ: {a} against {b}; they must be the same")]
    Channels {
        /// What the frame's hold.
        a: Channels,
        /// What the reference's hold.
        b: Channels,
    },
    /// The frames have different sizes.
    #[error("the sizes differ: {a_width} x {a_height} against {b_width} x {b_height} pixels; they must be the same")]
    Size {
        /// Width of the frame, pixels.
        a_width: u32,
        /// Height of the frame, pixels.
        a_height: u32,
        /// Width of the reference, pixels.
        b_width: u32,
        /// Height of the reference, pixels.
        b_height: u32,
    },
    /// A radiance that is no amount of light.
    #[error(
        "radiance of the {which} picture at column {column}, row {row}, band {band} is {value}; it must be finite and at least 0"
    )]
    Radiance {
        /// "first" or "second".
        which: &'static str,
        /// Column, from 0 at the left.
        column: usize,
        /// Row, from 0 at the top.
        row: usize,
        /// The band's name.
        band: &'static str,
        /// The value.
        value: f32,
    },
    /// The reference is black where the frame is not, so that no error is relative to anything.
    #[error("the second picture is black everywhere and the first is not; there is nothing to relate errors to")]
    BlackReference,
}

/// Compares the radiance of a frame `a` with that of a reference `b`.
///
/// # Errors
/// [`MetricsError`] where sizes differ, a radiance is negative, NaN or infinite, or only the reference is black.
pub fn compare(a: &Frame, b: &Frame) -> Result<Comparison, MetricsError> {
    if (a.width, a.height) != (b.width, b.height) {
        let (a_width, a_height, b_width, b_height) = (a.width, a.height, b.width, b.height);
        return Err(MetricsError::Size { a_width, a_height, b_width, b_height });
    }
    if let (Some(in_a), Some(in_b)) = (a.channels, b.channels)
        && in_a != in_b
    {
        return Err(MetricsError::Channels { a: in_a, b: in_b });
    }
    check(a, "first")?;
    check(b, "second")?;
    let pairs: Vec<(f64, f64)> = values(a).zip(values(b)).collect();
    let (sum_a, sum_b) = pairs.iter().fold((0.0, 0.0), |(sum_a, sum_b), (a, b)| (sum_a + a, sum_b + b));
    if sum_b == 0.0 && sum_a > 0.0 {
        return Err(MetricsError::BlackReference);
    }
    let dark = DARK * sum_b / pairs.len() as f64;
    let bright = pairs.iter().filter(|(a, b)| *a > dark && *b > dark);
    let (squares, lit) = bright.fold((0.0, 0), |(squares, lit), (a, b)| (squares + (a / b).ln().powi(2), lit + 1));
    Ok(Comparison {
        values: pairs.len(),
        relative_error: relative_errors(&pairs, dark, matches!(b.channels, Some(Channels::Colour(_)))),
        rms_ln_ratio: if lit == 0 { 0.0 } else { (squares / lit as f64).sqrt() },
        dark_values: pairs.len() - lit,
        energy_ratio: if sum_a == sum_b { 1.0 } else { sum_a / sum_b },
        mean_flip: mean_flip(a, b),
    })
}

fn values(frame: &Frame) -> impl Iterator<Item = f64> {
    frame.radiance.as_flattened().iter().map(|&value| f64::from(value))
}

fn check(frame: &Frame, which: &'static str) -> Result<(), MetricsError> {
    let values = frame.radiance.as_flattened();
    // Colours that a space cannot mix are negative.
    let colour = matches!(frame.channels, Some(Channels::Colour(_)));
    match values.iter().position(|value| !(value.is_finite() && (colour || *value >= 0.0))) {
        None => Ok(()),
        Some(index) => {
            let (pixel, width) = (index / BAND_COUNT, frame.width as usize);
            let (column, row, band) = (pixel % width, pixel / width, BAND_NAMES[index % BAND_COUNT]);
            Err(MetricsError::Radiance { which, column, row, band, value: values[index] })
        }
    }
}

/// Of a colour a channel may be near zero or negative beside the others, so its errors are relative to its strongest.
fn relative_errors(pairs: &[(f64, f64)], dark: f64, colour: bool) -> RelativeErrors {
    let relative = |a: f64, b: f64, scale: f64| if a == b { 0.0 } else { (a - b).abs() / scale.max(dark) };
    let pixel = |channels: &[(f64, f64)]| -> [f64; BAND_COUNT] {
        let strongest = channels.iter().fold(0.0_f64, |strongest, (_, b)| strongest.max(*b));
        std::array::from_fn(|i| {
            let (a, b) = channels[i];
            relative(a, b, if colour { strongest } else { b })
        })
    };
    let mut errors: Vec<f64> = pairs.chunks_exact(BAND_COUNT).flat_map(pixel).collect();
    errors.sort_unstable_by(f64::total_cmp);
    // The smallest error that at least this share of values does not exceed.
    let quantile = |share: f64| errors[((share * errors.len() as f64).ceil() as usize).clamp(1, errors.len()) - 1];
    RelativeErrors { median: quantile(0.5), p95: quantile(0.95), p99: quantile(0.99), max: quantile(1.0) }
}

fn mean_flip(a: &Frame, b: &Frame) -> f64 {
    let exposure = automatic_exposure(b);
    // Files that do not say what they hold count as what most of them do.
    let srgb = Channels::Colour(ColourSpace::LinearSrgb);
    let to_srgb = display::linear_srgb(a.channels.or(b.channels).unwrap_or(srgb));
    let image = |frame: &Frame| {
        let picture = display::picture(frame, exposure * to_srgb, ToneMap::Filmic);
        FlipImageRgb8::with_data(frame.width, frame.height, &picture)
    };
    let map = nv_flip::flip(image(b), image(a), DEFAULT_PIXELS_PER_DEGREE).to_vec();
    map.iter().map(|&error| f64::from(error)).sum::<f64>() / map.len() as f64
}

/// Brings the logarithmic mean of the pixels' strongest bands to middle grey; black pixels have no say.
fn automatic_exposure(frame: &Frame) -> f64 {
    let strongest = frame.radiance.iter().map(|pixel| f64::from(pixel[0].max(pixel[1]).max(pixel[2])));
    let logarithms: Vec<f64> = strongest.filter(|&value| value > 0.0).map(f64::ln).collect();
    if logarithms.is_empty() {
        return 1.0;
    }
    0.18 / (logarithms.iter().sum::<f64>() / logarithms.len() as f64).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Frame {
        let mut frame = Frame::new(20, 10);
        for (index, pixel) in frame.radiance.iter_mut().enumerate() {
            *pixel = [0.01, 0.02, 0.05].map(|band| band * (1.0 + index as f32));
        }
        frame
    }

    fn scaled(frame: &Frame, factor: f32) -> Frame {
        let radiance = frame.radiance.iter().map(|pixel| pixel.map(|band| band * factor)).collect();
        Frame { radiance, ..frame.clone() }
    }

    #[test]
    fn a_frame_is_no_distance_from_itself() {
        let comparison = compare(&gradient(), &gradient()).unwrap();
        assert_eq!(comparison.relative_error.max, 0.0);
        assert_eq!((comparison.rms_ln_ratio, comparison.energy_ratio, comparison.mean_flip), (0.0, 1.0, 0.0));
    }

    #[test]
    fn a_brighter_frame_is_off_by_how_much_brighter_it_is() {
        let comparison = compare(&scaled(&gradient(), 1.25), &gradient()).unwrap();
        for error in [comparison.relative_error.median, comparison.relative_error.max, comparison.energy_ratio - 1.0] {
            assert!((error - 0.25).abs() < 1e-6, "{comparison:?}");
        }
        assert!((comparison.rms_ln_ratio - 1.25_f64.ln()).abs() < 1e-6);
        assert!(comparison.mean_flip > 0.01, "{comparison:?}");
    }

    #[test]
    fn one_wrong_pixel_in_two_hundred_is_the_maximum_and_not_the_median() {
        let mut frame = gradient();
        frame.radiance[57] = frame.radiance[57].map(|band| band * 3.0);
        let errors = compare(&frame, &gradient()).unwrap().relative_error;
        assert_eq!((errors.median, errors.p95, errors.p99), (0.0, 0.0, 0.0));
        assert!((errors.max - 2.0).abs() < 1e-6);
    }

    #[test]
    fn black_beside_a_bright_picture_is_not_an_infinite_error() {
        let (mut frame, mut reference) = (gradient(), gradient());
        (frame.radiance[0], reference.radiance[0]) = ([1e-12; 3], [0.0; 3]);
        let comparison = compare(&frame, &reference).unwrap();
        assert!(comparison.relative_error.max < 1e-6);
        assert_eq!(comparison.dark_values, 3);
        assert_eq!(compare(&gradient(), &Frame::new(20, 10)), Err(MetricsError::BlackReference));
        assert_eq!(compare(&Frame::new(20, 10), &Frame::new(20, 10)).unwrap().relative_error.max, 0.0);
    }

    #[test]
    fn a_pixel_that_is_no_light_is_named() {
        let mut frame = gradient();
        frame.radiance[21][2] = f32::NAN;
        let message = compare(&frame, &gradient()).unwrap_err().to_string();
        assert!(message.contains("first picture at column 1, row 1, band b is NaN"), "{message}");
    }
}
