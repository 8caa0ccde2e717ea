//! From linear radiance to a picture on a screen; `display.wgsl` is the same in f32.

use glam::{DMat3, DVec3};
use welkin_lut::Bands;
use welkin_lut::spectrum::{Channels, ColourSpace, adaptation, cie, solar, three_bands};

use crate::frame::Frame;
use crate::scene::{Scene, ToneMap};

/// What makes exposed linear sRGB of the channels that a backend renders of a scene: the colours that its wavelengths stand
/// for, balanced to its white, times 2^EV.
pub fn exposed_srgb(scene: &Scene) -> DMat3 {
    match scene.spectrum.channels {
        Channels::Bands => exposed_bands(scene),
        Channels::Colour(space) => scene.display.exposure_ev.exp2() * space.to_space(ColourSpace::LinearSrgb),
    }
}

/// The same of the bands themselves, whatever channels the scene asks for.
pub fn exposed_bands(scene: &Scene) -> DMat3 {
    scene.display.exposure_ev.exp2() * scene.colour_in(ColourSpace::LinearSrgb)[0].radiance
}

/// Linear sRGB of channels whose scene is not known: bands are balanced to sunlight.
pub fn linear_srgb(channels: Channels) -> DMat3 {
    match channels {
        Channels::Bands => {
            let sun = DVec3::from_array(cie::tristimulus(solar::irradiance));
            let srgb = ColourSpace::LinearSrgb;
            srgb.from_xyz() * adaptation(sun, srgb.white_xyz() * sun.y) * three_bands::to_xyz()
        }
        Channels::Colour(space) => space.to_space(ColourSpace::LinearSrgb),
    }
}

/// Luminance of linear sRGB (IEC 61966-2-1).
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Brings a colour that a screen cannot mix to the nearest that it can on the way to grey of the same luminance, so that
/// hue and brightness stay. What has no luminance is black.
pub fn into_gamut(linear: Bands) -> Bands {
    let colour = DVec3::from_array(linear);
    let (luminance, least) = (colour.dot(LUMINANCE), colour.min_element());
    if least >= 0.0 {
        return linear;
    }
    if luminance <= 0.0 {
        return [0.0; 3];
    }
    let kept = luminance / (luminance - least);
    (DVec3::splat(luminance) + (colour - luminance) * kept).max(DVec3::ZERO).to_array()
}

/// Exponent of the filmic curve, its contrast in the shadows. At middle grey the slope on doubly logarithmic axes is
/// 1.3 (1 - 0.18) = 1.07.
const CONTRAST: f64 = 1.3;

/// Middle grey, which the filmic curve leaves where it is.
const MIDDLE_GREY: f64 = 0.18;

/// Radiance above which everything is white; it keeps the powers within f32.
const WHITEST: f64 = 1e9;

/// From exposed linear sRGB to linear light in [0, 1]; colours out of gamut are first brought [`into_gamut`].
///
/// The filmic curve takes the strongest primary m to t = m^c / (m^c + k), a sigmoid in log m as film and the eye have it
/// (Naka & Rushton 1966), with c = 1.3 and k such that 0.18 stays 0.18. The other primaries keep their ratio to m, so that
/// hue does not turn as it does where each has its own curve, and all move towards white by the share t⁴: strong
/// light is white, and a blue sky stays blue.
pub fn tone_map(tone_map: ToneMap, exposed: Bands) -> Bands {
    tone_map_up_to(1.0, tone_map, exposed)
}

/// The same to linear light in [0, headroom], for a screen that shows light above white: the sigmoid m^c H / (m^c + k) ends
/// at the headroom H, and k leaves middle grey where it is.
pub fn tone_map_up_to(headroom: f64, tone_map: ToneMap, exposed: Bands) -> Bands {
    let exposed = into_gamut(exposed);
    let strongest = exposed.iter().fold(0.0_f64, |strongest, &band| strongest.max(band));
    match tone_map {
        ToneMap::None => exposed.map(|band| band.min(headroom)),
        ToneMap::Filmic if strongest == 0.0 => [0.0; 3],
        ToneMap::Filmic => {
            let powered = strongest.min(WHITEST).powf(CONTRAST);
            let half_point = MIDDLE_GREY.powf(CONTRAST) * (headroom / MIDDLE_GREY - 1.0);
            let t = powered / (powered + half_point);
            let white = t.powi(4);
            exposed.map(|band| headroom * t * (band / strongest * (1.0 - white) + white))
        }
    }
}

/// From linear light in [0, 1] to the value in [0, 1] that a screen is sent, IEC 61966-2-1.
pub fn srgb_encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// A frame as sRGB bytes, three a pixel, row by row from the top left; `exposed` takes its channels to exposed linear sRGB.
pub fn picture(frame: &Frame, exposed: DMat3, curve: ToneMap) -> Vec<u8> {
    let pixel = |radiance: &[f32; 3]| {
        let linear = exposed * DVec3::from_array(radiance.map(f64::from));
        tone_map(curve, linear.to_array()).map(|linear| (255.0 * srgb_encoded(linear)).round() as u8)
    };
    frame.radiance.iter().flat_map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_screen_with_headroom_shows_middle_grey_alike_and_the_sun_brighter() {
        let bright = |exposed: f64| tone_map_up_to(5.0, ToneMap::Filmic, [exposed; 3])[0];
        assert!((bright(0.18) - 0.18).abs() < 1e-12 && bright(1e6) > 4.99 && bright(1e6) <= 5.0);
        assert!(bright(3.0) > filmic([3.0; 3])[0]);
    }

    fn filmic(exposed: Bands) -> Bands {
        tone_map(ToneMap::Filmic, exposed)
    }

    #[test]
    fn middle_grey_stays_and_grey_stays_grey() {
        assert!((filmic([0.18; 3])[0] - 0.18).abs() < 1e-7);
        for stop in -20..20 {
            let [r, g, b] = filmic([f64::from(stop).exp2(); 3]);
            assert!(r == g && g == b);
        }
    }

    #[test]
    fn more_light_is_never_darker_and_never_beyond_white() {
        for colour in [[1.0, 1.0, 1.0], [0.2, 0.4, 1.0], [1.0, 0.5, 0.0], [0.0, 0.0, 1.0]] {
            let mut darker = [0.0; 3];
            for step in -200..400 {
                let light = colour.map(|band: f64| band * (f64::from(step) / 10.0).exp2());
                let shown = filmic(light);
                assert!((0..3).all(|band| (darker[band]..=1.0).contains(&shown[band])), "{light:?} gave {shown:?}");
                darker = shown;
            }
        }
    }

    #[test]
    fn hue_does_not_turn_with_exposure() {
        // Where the middle band lies between the weakest and the strongest is the hue.
        let hue = |[weak, middle, strong]: Bands| (middle - weak) / (strong - weak);
        for stop in -10..7 {
            let light = [0.1, 0.4, 1.0].map(|band: f64| band * f64::from(stop).exp2());
            assert!((hue(filmic(light)) - hue(light)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_sun_is_white_and_night_is_black() {
        assert_eq!(filmic([0.0; 3]), [0.0; 3]);
        assert!(filmic([3e12, 1e12, 1e12]).iter().all(|&band| band > 0.9999));
    }

    #[test]
    fn a_colour_out_of_gamut_keeps_its_luminance_and_hue() {
        let luminance = |colour: Bands| DVec3::from_array(colour).dot(LUMINANCE);
        let deep_blue = [-0.05, 0.1, 1.5];
        let shown = into_gamut(deep_blue);
        assert!((luminance(shown) - luminance(deep_blue)).abs() < 1e-12 && shown[0].abs() < 1e-12, "{shown:?}");
        // On the way to grey the differences between the primaries keep their ratio.
        let ratio = |[r, g, b]: Bands| (g - r) / (b - r);
        assert!((ratio(shown) - ratio(deep_blue)).abs() < 1e-12);
        assert_eq!(into_gamut([0.2, 0.0, 3.0]), [0.2, 0.0, 3.0]);
        assert_eq!(into_gamut([-1.0, 0.1, 0.1]), [0.0; 3]);
    }

    #[test]
    fn srgb_has_its_published_values() {
        // Linear 0.5 is 188/255 to rounding, and both branches meet.
        assert_eq!((255.0 * srgb_encoded(0.5)).round(), 188.0);
        assert!((srgb_encoded(0.003_130_8) - srgb_encoded(0.003_130_81)).abs() < 1e-6);
    }
}
