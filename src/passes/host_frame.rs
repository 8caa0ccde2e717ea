//! A frame that is recorded for a host: what of it is read and written, and what is left behind. Not a pass.

use glam::DMat3;

use super::{RenderError, Resources};
use crate::foreground::ForegroundError;
use crate::gpu::{HostCommands, HostImage, HostRecorded, HostUse, ImageFormat, ImageShape};
use crate::plan::FroxelGrid;
use crate::scene::{Camera, Scene};

/// Formats of a host's images that hold light.
const FLOATS: [ImageFormat; 2] = [ImageFormat::Rgba16Float, ImageFormat::Rgba32Float];

/// What the numbers of a host's depth image are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DepthBuffer {
    /// Those of a perspective projection into [0, 1]. What was cleared, 1 or reversed 0, is sky.
    Perspective {
        /// Distance of the near plane, m.
        near_m: f64,
        /// Distance of the far plane, m; it may be infinite.
        far_m: f64,
        /// Whether depth falls with distance.
        reversed: bool,
    },
    /// Distance from the camera's plane, m: linear or eye-space depth. Infinite, or not above 0, for the sky.
    Planar,
    /// Distance along each pixel's ray, m. Infinite, or not above 0, for the sky.
    Distance,
}

/// What a host has drawn.
#[derive(Clone)]
pub struct HostDepth {
    /// Depth of the camera's size: a depth format, or `R32_SFLOAT`.
    pub image: HostImage,
    /// What its numbers are.
    pub buffer: DepthBuffer,
}

/// Images of a host's that are to hold what lies before the camera up to many distances, so that what light passes through (smoke, glass,
/// water) can be drawn after the frame: `colour * transmittance + radiance` at its place.
///
/// Both are three-dimensional and of one size, which is the host's choice: columns and rows over the whole picture, and slices of
/// [`FroxelGrid`]; `R16G16B16A16_SFLOAT` or `R32G32B32A32_SFLOAT`. Linear filters between texels do.
#[derive(Clone)]
pub struct HostFroxels {
    /// Light that air, clouds, fog and volumes send from before a froxel, in the unit and the channels of the picture. The fourth
    /// component is the mean of the transmittances.
    pub radiance: HostImage,
    /// What they let through, of each channel of the scene's three; the fourth component as above.
    pub transmittance: HostImage,
    /// [`FroxelGrid::near_m`].
    pub near_m: f64,
    /// [`FroxelGrid::far_m`].
    pub far_m: f64,
}

impl HostFroxels {
    /// Where the froxels lie.
    pub fn grid(&self) -> FroxelGrid {
        FroxelGrid { size: self.radiance.image.shape().extent(), near_m: self.near_m, far_m: self.far_m }
    }

    fn check(&self) -> Result<(), RenderError> {
        let images = [
            ("the host's froxels' radiance", &self.radiance),
            ("the host's froxels' transmittance", &self.transmittance),
        ];
        for (what, image) in images {
            let (shape, format) = (image.image.shape(), image.image.format());
            let is_volume = matches!(shape, ImageShape::D3(_, _, slices) if slices >= 2);
            let fits = is_volume && FLOATS.contains(&format);
            if !fits || (shape, format) != (self.radiance.image.shape(), self.radiance.image.format()) {
                let expected = format!("D3 of two slices or more, both alike, of one of {FLOATS:?}");
                return Err(RenderError::Target { what, found: format!("{shape:?} of {format:?}"), expected });
            }
        }
        let distances = [self.near_m, self.far_m];
        if !distances.iter().all(|&distance_m| distance_m > 0.0 && distance_m.is_finite()) {
            let found = format!("grid from {} to {} m", self.near_m, self.far_m);
            let expected = "grid between finite distances above 0".to_owned();
            return Err(RenderError::Target { what: "the host's froxels", found, expected });
        }
        Ok(())
    }
}

/// The images of one frame of a host's.
#[derive(Clone)]
pub struct HostFrame {
    /// The picture, of the camera's size: read where there are surfaces, and written everywhere; `R16G16B16A16_SFLOAT` or
    /// `R32G32B32A32_SFLOAT`. Linear, in the channels that the scene asks for (`[spectrum] channels`).
    pub colour: HostImage,
    /// The surfaces that the host has drawn; without it there are none, and the picture is sky and ground alone.
    pub depth: Option<HostDepth>,
    /// What lies before the camera, for what the host draws afterwards.
    pub froxels: Option<HostFroxels>,
    /// The host's number for a radiance of 1 W·m⁻²·sr⁻¹·nm⁻¹: its exposure.
    pub units_per_radiance: f64,
}

/// How a frame leaves the images of the host's: what its next use of them must wait for, and in which layouts they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HostLeft {
    /// The picture.
    pub colour: HostUse,
    /// The depth image.
    pub depth: Option<HostUse>,
    /// Radiance and transmittance of the froxels.
    pub froxels: Option<[HostUse; 2]>,
}

/// A frame that is being recorded for a host.
pub struct HostRecording {
    /// Where to, until recording begins.
    pub commands: Option<HostCommands>,
    /// With what.
    pub frame: HostFrame,
    /// What came of it.
    pub recorded: Option<(HostRecorded, HostLeft)>,
}

impl DepthBuffer {
    /// Depth from the camera's plane is a / (b + c depth): a in m, b and c.
    pub(super) fn to_planar(self) -> [f64; 3] {
        let Self::Perspective { near_m, far_m, reversed } = self else { return [0.0, 1.0, 0.0] };
        // Shares of the range between the planes; that of an infinite one has its limit.
        let (scale_m, near_share) = match far_m.is_finite() {
            true => (near_m * far_m / (far_m - near_m), near_m / (far_m - near_m)),
            false => (near_m, 0.0),
        };
        if reversed { [scale_m, near_share, 1.0] } else { [scale_m, 1.0 + near_share, -1.0] }
    }

    fn check(self) -> Result<(), ForegroundError> {
        match self {
            Self::Perspective { near_m, far_m, .. } if !(near_m > 0.0 && near_m.is_finite() && far_m > near_m) => {
                Err(ForegroundError::Projection { near_m, far_m })
            }
            _ => Ok(()),
        }
    }
}

impl HostFrame {
    pub(super) fn images(&self) -> impl Iterator<Item = &HostImage> {
        let froxels = self.froxels.iter().flat_map(|froxels| [&froxels.radiance, &froxels.transmittance]);
        self.depth.iter().map(|depth| &depth.image).chain([&self.colour]).chain(froxels)
    }

    /// From spectral radiance to the host's colour.
    pub(super) fn colour_matrix(&self, scene: &Scene) -> DMat3 {
        scene.colour()[0].radiance * self.units_per_radiance
    }

    /// Whether the images are what a frame of a camera needs.
    ///
    /// # Errors
    /// [`RenderError::Target`]; [`RenderError::Foreground`] for an impossible projection.
    pub fn check(&self, camera: &Camera) -> Result<(), RenderError> {
        let shape = ImageShape::D2(camera.width, camera.height);
        let fits = |what: &'static str, image: &HostImage, formats: &[ImageFormat]| {
            let (found_shape, found) = (image.image.shape(), image.image.format());
            if found_shape == shape && formats.contains(&found) {
                return Ok(());
            }
            let expected = format!("{shape:?} of one of {formats:?}");
            Err(RenderError::Target { what, found: format!("{found_shape:?} of {found:?}"), expected })
        };
        fits("the host's colour", &self.colour, &FLOATS)?;
        if !(self.units_per_radiance > 0.0 && self.units_per_radiance.is_finite()) {
            let found = format!("unit of {} for each radiance", self.units_per_radiance);
            return Err(RenderError::Target {
                what: "the host's colour",
                found,
                expected: "number above 0".to_owned(),
            });
        }
        self.froxels.as_ref().map_or(Ok(()), HostFroxels::check)?;
        let Some(depth) = &self.depth else { return Ok(()) };
        depth.buffer.check()?;
        use ImageFormat as F;
        let formats = match depth.buffer {
            DepthBuffer::Perspective { .. } => {
                &[F::Depth32Float, F::Depth16Unorm, F::Depth24UnormStencil8, F::Depth32FloatStencil8, F::R32Float][..]
            }
            DepthBuffer::Planar | DepthBuffer::Distance => &[F::R32Float],
        };
        fits("the host's depth", &depth.image, formats)
    }
}

impl Resources {
    /// The frame of a host's that is being recorded.
    pub(super) fn host_frame(&self) -> Option<&HostFrame> {
        self.host.as_ref().map(|host| &host.frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_of_every_projection_is_the_distance_that_was_projected() {
        for far_m in [5e4, f64::INFINITY] {
            for reversed in [false, true] {
                let near_m = 0.5;
                let [numerator_m, offset, slope] = DepthBuffer::Perspective { near_m, far_m, reversed }.to_planar();
                for planar_m in [0.5, 3.0, 400.0, 4e4] {
                    // The projection of Vulkan and Direct3D: depth 0 at the near plane, 1 at the far.
                    let from_near: f64 = match far_m.is_finite() {
                        true => far_m / (far_m - near_m) * (1.0 - near_m / planar_m),
                        false => 1.0 - near_m / planar_m,
                    };
                    let depth = if reversed { 1.0 - from_near } else { from_near };
                    let found = numerator_m / (offset + slope * depth);
                    assert!((found / planar_m - 1.0).abs() < 1e-6, "{far_m} {reversed}: {found} for {planar_m}");
                }
            }
        }
    }
}
