//! Where the picture is taken from and how it is shown.

use super::Direction;

/// A pinhole camera on the vertical through the local frame's origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Height of the pinhole above the ground, m; negative is below ground.
    pub altitude_m: f64,
    /// Where the centre of the picture looks.
    pub direction: Direction,
    /// Angle between the picture's lower and upper edge, rad.
    pub vertical_field_of_view_rad: f64,
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
}

/// From linear radiance to a picture on a screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Display {
    /// Exposure: radiance is multiplied by 2^exposure_ev before the tone map.
    pub exposure_ev: f64,
    /// The curve that brings it into [0, 1].
    pub tone_map: ToneMap,
}

/// Curves from [0, ∞) to [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToneMap {
    /// Clip at 1.
    None,
    /// AgX-like filmic curve, which keeps hue towards white.
    Filmic,
}
