//! The picture that every backend returns: one type at the door to files, comparisons and windows.

use welkin_lut::spectrum::Channels;

/// Linear radiance and what belongs to it, row by row from the top left pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What the three channels hold; none where a file of another program does not say it.
    pub channels: Option<Channels>,
    /// Spectral radiance in the bands, or linear colour, W·m⁻²·sr⁻¹·nm⁻¹; colours that a space cannot mix have negative
    /// values.
    pub radiance: Vec<[f32; 3]>,
    /// Transmittance of the air between the camera and the ground or space: in the bands, in [0, 1], or the colour of
    /// what it leaves of white light.
    pub transmittance: Vec<[f32; 3]>,
    /// Distance to the ground along the pixel's ray, m; infinite where the ray ends in space.
    pub distance_m: Vec<f32>,
    /// One standard error of `radiance`, from backends that sample.
    pub standard_error: Option<Vec<[f32; 3]>>,
}

impl Frame {
    /// A black frame of bands in vacuum, in which every ray ends in space.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            channels: Some(Channels::Bands),
            radiance: vec![[0.0; 3]; pixels],
            transmittance: vec![[1.0; 3]; pixels],
            distance_m: vec![f32::INFINITY; pixels],
            standard_error: None,
        }
    }

    /// A black frame of other channels.
    pub fn of_channels(width: u32, height: u32, channels: Channels) -> Self {
        Self { channels: Some(channels), ..Self::new(width, height) }
    }
}
