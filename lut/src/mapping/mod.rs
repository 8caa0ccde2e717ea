//! Where a physical parameter lies in a table.
//!
//! Each mapping takes parameters to *unit* coordinates in [0, 1]² and back. Unit coordinates are inset so that 0 and 1
//! fall on the centres of the first and last texel ([`texture_coordinate`]). The shaders' `mapping.wgsl` holds the same
//! functions in f32.

mod multiple_scattering;
mod optical_depth;
mod sky_view;
mod slices;

pub use multiple_scattering::MultipleScatteringMapping;
pub use optical_depth::OpticalDepthMapping;
pub use sky_view::{SkyHalf, SkyViewMapping};
pub use slices::SliceMapping;

/// From unit coordinates to texture coordinates, in which texel i of n is centred on (i + 1/2) / n.
pub fn texture_coordinate(unit: [f64; 2], size: [u32; 2]) -> [f64; 2] {
    std::array::from_fn(|i| (unit[i] * f64::from(size[i] - 1) + 0.5) / f64::from(size[i]))
}

/// Keeps a filter inside its tile or block, in texels.
const TILE_MARGIN: f64 = 0.002;

/// From a unit coordinate to a place in a tile of so many texels, from the centre of its first.
pub(crate) fn inside_tile(unit: f64, count: u32) -> f64 {
    let last = f64::from(count - 1);
    (unit * last).clamp(TILE_MARGIN, last - TILE_MARGIN)
}

/// Unit coordinates of a texel's centre; a table of one texel in a direction stands for 0.
pub fn unit_from_texel(texel: [u32; 2], size: [u32; 2]) -> [f64; 2] {
    std::array::from_fn(|i| f64::from(texel[i]) / f64::from(size[i] - 1).max(1.0))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Texel -> parameters -> texel is the identity on a dense, non-square grid.
    pub(crate) fn assert_round_trip(there: impl Fn([f64; 2]) -> [f64; 2], back: impl Fn([f64; 2]) -> [f64; 2]) {
        let size = [61, 37];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let unit = unit_from_texel([x, y], size);
                let again = back(there(unit));
                for axis in 0..2 {
                    let difference = (again[axis] - unit[axis]).abs();
                    // Square-root warps turn a rounding of 1e-16 in a cosine near the horizon into 1e-8.
                    assert!(difference < 1e-7, "texel ({x}, {y}): {unit:?} came back as {again:?}");
                }
            }
        }
    }

    #[test]
    fn first_and_last_texel_centres_are_zero_and_one() {
        let size = [7, 4];
        assert_eq!(texture_coordinate([0.0, 0.0], size), [0.5 / 7.0, 0.5 / 4.0]);
        assert_eq!(texture_coordinate([1.0, 1.0], size), [6.5 / 7.0, 3.5 / 4.0]);
        assert_eq!(unit_from_texel([6, 3], size), [1.0, 1.0]);
    }

    #[test]
    #[should_panic(expected = "came back")]
    fn the_round_trip_test_notices_a_half_texel_error() {
        assert_round_trip(|unit| unit, |unit| [unit[0] + 0.5 / 61.0, unit[1]]);
    }
}
