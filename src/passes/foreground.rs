//! What the host has drawn, as `compose` reads it. Not a pass: nothing is computed.

use super::{RenderError, Resources};
use crate::foreground::{Foreground, ForegroundError};
use crate::gpu::{ImageFormat, ImageShape};
use crate::scene::Camera;

/// Stands for "no surface": beyond everything, and finite, as shaders may take infinity for undefined, m.
pub(super) const NO_SURFACE_M: f32 = 1e30;

/// Uploads a foreground as `foreground_image`: radiance, and distance in the fourth component.
pub fn upload(resources: &mut Resources, camera: &Camera, foreground: &Foreground) -> Result<(), RenderError> {
    let (width, height) = (camera.width, camera.height);
    let found = foreground.distance_m().len();
    if found != width as usize * height as usize {
        return Err(ForegroundError::Size { what: "depth", found, width, height }.into());
    }
    let texel = |(&[r, g, b], &distance_m): (&[f32; 3], &f32)| match distance_m < NO_SURFACE_M {
        true => [r, g, b, distance_m],
        false => [0.0, 0.0, 0.0, NO_SURFACE_M],
    };
    let texels: Vec<[f32; 4]> = foreground.radiance().iter().zip(foreground.distance_m()).map(texel).collect();
    let image = resources.image("foreground_image", ImageShape::D2(width, height), ImageFormat::Rgba32Float)?;
    Ok(resources.gpu.write_image(&image, &texels)?)
}
