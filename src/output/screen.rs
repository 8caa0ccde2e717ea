//! What screens are sent that show light above white.
//!
//! Linear light 1 is the white of a page, 203 cd/m² (ITU-R BT.2408-7, table 1).

use glam::{DMat3, DVec3};
use welkin_lut::Bands;

/// Luminance of white, cd/m².
pub const WHITE_CD_PER_M2: f64 = 203.0;

/// Brightest light that pictures hold, in whites: 1000 cd/m², what such screens are graded for.
pub const HEADROOM: f64 = 1000.0 / WHITE_CD_PER_M2;

/// From linear sRGB to extended linear sRGB (scRGB), in which 1 is 80 cd/m² (IEC 61966-2-1, 4.1).
pub fn extended_linear(linear: Bands) -> Bands {
    linear.map(|band| band * WHITE_CD_PER_M2 / 80.0)
}

/// From linear sRGB to HDR10: the primaries of BT.2020 under the curve of SMPTE ST 2084.
pub fn hdr10(linear: Bands) -> Bands {
    let wide = bt2020_from_srgb() * DVec3::from_array(linear);
    wide.to_array().map(|band| perceptual_quantizer(band * WHITE_CD_PER_M2))
}

/// Linear sRGB in the primaries of BT.2020 (ITU-R BT.2087-0, equation 1).
fn bt2020_from_srgb() -> DMat3 {
    DMat3::from_cols(
        DVec3::new(0.6274, 0.0691, 0.0164),
        DVec3::new(0.3293, 0.9195, 0.0880),
        DVec3::new(0.0433, 0.0114, 0.8956),
    )
}

/// The code in [0, 1] of a luminance up to 10 000 cd/m² (SMPTE ST 2084:2014, equation 5.2).
pub fn perceptual_quantizer(cd_per_m2: f64) -> f64 {
    let (m1, m2) = (2610.0 / 16384.0, 2523.0 / 4096.0 * 128.0);
    let (c1, c2, c3) = (3424.0 / 4096.0, 2413.0 / 4096.0 * 32.0, 2392.0 / 4096.0 * 32.0);
    let y = (cd_per_m2 / 10_000.0).clamp(0.0, 1.0).powf(m1);
    ((c1 + c2 * y) / (1.0 + c3 * y)).powf(m2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_perceptual_quantizer_has_its_published_codes() {
        // ITU-R BT.2408-7, table 1: 203 cd/m² are 58 %; ST 2084's ends; 100 and 1000 cd/m² are 51 and 75 % (BT.2390).
        for (cd_per_m2, percent) in [(203.0, 58.0), (100.0, 51.0), (1000.0, 75.0), (10_000.0, 100.0)] {
            let code = 100.0 * perceptual_quantizer(cd_per_m2);
            assert!((code - percent).abs() < 0.5, "{cd_per_m2} cd/m²: {code} %");
        }
        assert!(perceptual_quantizer(0.0) < 1e-6);
    }

    #[test]
    fn white_stays_white_on_every_screen() {
        assert!(hdr10([1.0; 3]).iter().all(|code| (code - perceptual_quantizer(WHITE_CD_PER_M2)).abs() < 1e-4));
        assert_eq!(extended_linear([80.0 / 203.0; 3]), [1.0; 3]);
        // Control: a primary of sRGB is none of BT.2020.
        let [red, green, blue] = hdr10([1.0, 0.0, 0.0]);
        assert!(red > green && green > blue && blue > 0.1, "{red} {green} {blue}");
    }
}
