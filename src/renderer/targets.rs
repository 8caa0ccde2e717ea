//! Frames drawn into images of the host's, which stay on the device.

use super::{Renderer, Timings};
use crate::gpu::{GpuImage, ImageFormat, ImageShape, NextUse, ScreenEncoding};
use crate::passes::{FRAME, RenderError};
use crate::plan::{Outputs, Settings};
use crate::scene::Scene;

/// Images that a frame is drawn into, each of the camera's size. What is left out is not computed, but radiance, which then
/// stays with the renderer.
#[derive(Clone, Default)]
pub struct Targets {
    /// Linear radiance or colour, W·m⁻²·sr⁻¹·nm⁻¹; `Rgba32Float`.
    pub radiance: Option<GpuImage>,
    /// Transmittance of the air; `Rgba32Float`.
    pub transmittance: Option<GpuImage>,
    /// Distance along each pixel's ray, m; `R32Float`.
    pub distance: Option<GpuImage>,
    /// What a screen shows; of its encoding's format, `Rgba8Unorm` for sRGB.
    pub picture: Option<GpuImage>,
    /// How the picture is encoded.
    pub encoding: ScreenEncoding,
}

impl Targets {
    /// What they ask for.
    pub fn outputs(&self) -> Outputs {
        let capture = self.transmittance.is_some() || self.distance.is_some();
        Outputs { capture, picture: self.picture.is_some() }
    }

    /// Each by what it is, the name that passes know it by, its image and the format that it must have.
    fn all(&self, spectral: bool) -> impl Iterator<Item = (&'static str, &'static str, &GpuImage, ImageFormat)> {
        let [radiance, transmittance] = match spectral {
            true => ["colour_image", "colour_transmittance_image"],
            false => ["radiance_image", "transmittance_image"],
        };
        let all = [
            ("radiance", radiance, &self.radiance, ImageFormat::Rgba32Float),
            ("transmittance", transmittance, &self.transmittance, ImageFormat::Rgba32Float),
            ("distance", "distance_image", &self.distance, ImageFormat::R32Float),
            ("the picture", "picture_image", &self.picture, self.encoding.image_format()),
        ];
        all.into_iter().filter_map(|(what, name, image, format)| Some((what, name, image.as_ref()?, format)))
    }
}

impl Renderer {
    /// Renders what the scene's camera sees into images on the device, reads nothing back, and leaves the images in the
    /// layout of `next`, visible to whatever is submitted to the device's queue afterwards. Returns when the device is done.
    ///
    /// # Errors
    /// As [`Renderer::render`]; [`RenderError::Target`] for an image of another size or format.
    pub fn render_to(
        &mut self,
        scene: &Scene,
        settings: Settings,
        targets: &Targets,
        next: NextUse,
    ) -> Result<Timings, RenderError> {
        let spectral = scene.spectrum.group_count() > 1;
        let shape = ImageShape::D2(scene.camera.width, scene.camera.height);
        for (what, _, image, format) in targets.all(spectral) {
            if (image.shape(), image.format()) != (shape, format) {
                let found = format!("{:?} of {:?}", image.shape(), image.format());
                return Err(RenderError::Target { what, found, expected: format!("{shape:?} of {format:?}") });
            }
        }
        for (_, name, image, _) in targets.all(spectral) {
            self.resources.keep(name, image.clone());
            self.forget_writers_of(name);
        }
        self.resources.targets = targets.all(spectral).map(|(_, name, image, _)| (name, image.clone(), next)).collect();
        self.resources.screen = targets.encoding;
        let timings = self.compute(scene, settings, targets.outputs());
        self.resources.screen = ScreenEncoding::Srgb;
        // They are the host's again: the next frame must not draw into them unasked.
        self.resources.targets.clear();
        for (_, name, _, _) in targets.all(spectral) {
            self.resources.release(name);
            self.forget_writers_of(name);
        }
        timings
    }

    fn forget_writers_of(&mut self, name: &str) {
        for pass in FRAME.iter().filter(|pass| pass.declaration.writes.contains(&name)) {
            self.history.forget(pass.declaration.name);
        }
    }
}
