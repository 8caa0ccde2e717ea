//! The picture that every backend returns: one type at the door to files, comparisons and windows.

/// Linear radiance and what belongs to it, row by row from the top left pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Spectral radiance in the scene's bands, W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Vec<[f32; 3]>,
    /// Transmittance of the air between the camera and the ground or space, in [0, 1].
    pub transmittance: Vec<[f32; 3]>,
    /// Distance to the ground along the pixel's ray, m; infinite where the ray ends in space.
    pub distance_m: Vec<f32>,
    /// One standard error of `radiance`, from backends that sample.
    pub standard_error: Option<Vec<[f32; 3]>>,
}

impl Frame {
    /// A black frame in vacuum, in which every ray ends in space.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            radiance: vec![[0.0; 3]; pixels],
            transmittance: vec![[1.0; 3]; pixels],
            distance_m: vec![f32::INFINITY; pixels],
            standard_error: None,
        }
    }
}
