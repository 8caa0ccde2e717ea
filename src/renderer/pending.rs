//! Frames whose pixels are on their way to the host.

use glam::{DMat3, DVec3};
use welkin_lut::spectrum::Channels;

use super::{Rendered, Renderer, Timings};
use crate::frame::Frame;
use crate::gpu::PendingImage;
use crate::passes::RenderError;
use crate::plan::Outputs;
use crate::scene::{Camera, Scene};

/// A frame that is rendered, and whose pixels the device copies while the host goes on: the renderer may render the next meanwhile.
/// Any thread may wait for them.
pub struct PendingFrame {
    width: u32,
    height: u32,
    radiance: Option<PendingImage>,
    transmittance: Option<PendingImage>,
    distance: Option<PendingImage>,
    picture: Option<PendingImage>,
    channels: ToChannels,
    timings: Timings,
}

/// What makes a frame's channels of what the device has left.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ToChannels {
    /// What radiance and transmittance are multiplied by, if they still are three bands.
    matrices: Option<[DMat3; 2]>,
    channels: Option<Channels>,
}

impl ToChannels {
    /// Of a frame of bands, as its scene asks for.
    pub(super) fn of_bands(scene: &Scene) -> Self {
        let channels = scene.spectrum.channels;
        if channels == Channels::Bands {
            return Self::default();
        }
        let colour = scene.colour()[0];
        Self { matrices: Some([colour.radiance, colour.transmittance]), channels: Some(channels) }
    }

    /// Of a frame that the device has brought to its scene's channels.
    pub(super) fn done(scene: &Scene) -> Self {
        Self { matrices: None, channels: Some(scene.spectrum.channels) }
    }

    fn convert(self, frame: &mut Frame) {
        frame.channels = self.channels.or(frame.channels);
        let Some([radiance, transmittance]) = self.matrices else { return };
        for (pixels, matrix) in [(&mut frame.radiance, radiance), (&mut frame.transmittance, transmittance)] {
            for pixel in pixels {
                *pixel = (matrix * DVec3::from_array(pixel.map(f64::from))).as_vec3().to_array();
            }
        }
    }
}

impl PendingFrame {
    /// What each pass took.
    pub fn timings(&self) -> &Timings {
        &self.timings
    }

    /// Waits until the pixels are there.
    ///
    /// # Errors
    /// [`RenderError::Gpu`], that of a lost device.
    pub fn wait(self) -> Result<Rendered, RenderError> {
        let rgb = |texels: Vec<[f32; 4]>| texels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect::<Vec<_>>();
        let mut frame = Frame::new(self.width, self.height);
        if let Some(radiance) = self.radiance {
            frame.radiance = rgb(radiance.wait()?);
        }
        if let Some(transmittance) = self.transmittance {
            frame.transmittance = rgb(transmittance.wait()?);
        }
        if let Some(distance) = self.distance {
            frame.distance_m = distance.wait()?;
        }
        self.channels.convert(&mut frame);
        let texels: Option<Vec<[u8; 4]>> = self.picture.map(PendingImage::wait).transpose()?;
        let picture = texels.map(|texels| texels.into_iter().flat_map(|[r, g, b, _]| [r, g, b]).collect());
        Ok(Rendered { frame, picture, timings: self.timings })
    }
}

impl Renderer {
    /// Has the device copy radiance and transmittance from the images of those names, distance and the picture.
    pub(super) fn start_reading(
        &self,
        camera: &Camera,
        outputs: Outputs,
        [radiance, transmittance]: [&str; 2],
        channels: ToChannels,
        timings: Timings,
    ) -> Result<PendingFrame, RenderError> {
        let start = |name: &str, wanted: bool| {
            let image = self.resources.existing_image(name).filter(|_| wanted);
            image.map(|image| self.gpu().start_reading_image(image)).transpose()
        };
        Ok(PendingFrame {
            width: camera.width,
            height: camera.height,
            radiance: start(radiance, true)?,
            transmittance: start(transmittance, outputs.capture)?,
            distance: start("distance_image", outputs.capture)?,
            picture: start("picture_image", outputs.picture)?,
            channels,
            timings,
        })
    }
}
