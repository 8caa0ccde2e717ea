//! A scene through its camera, pixel by pixel, for the path tracer.

use glam::DVec3;
use welkin_lut::{BAND_COUNT, Bands};

use super::exposure::Subject;
use super::film::Film;
use crate::frame::Frame;
use crate::reference::path::{Budget, FirstOrderBy, View};
use crate::reference::shape::End;
use crate::reference::transport;
use crate::reference::world::World;
use crate::scene::{Camera, Scene};

/// Rays across a pixel, in each direction, over which a light's disc is averaged.
const DISC_RAYS: u32 = 8;

/// What the camera of a scene sees. The radiance of a pixel is that of the ray through its centre; only the discs of
/// lights are averaged over the pixel.
#[derive(Debug)]
pub struct CameraView {
    world: World,
    camera: Camera,
    seed: u64,
    walks_per_batch: u64,
}

impl CameraView {
    /// Prepares a scene for pictures with a seed and so many walks in a batch.
    pub fn new(scene: &Scene, seed: u64, walks_per_batch: u64) -> Self {
        Self { world: World::from_scene(scene), camera: scene.camera, seed, walks_per_batch }
    }

    /// Pixels of the whole picture.
    pub fn pixels(&self) -> usize {
        self.camera.width as usize * self.camera.height as usize
    }

    /// The picture on a film. Pixels of other parts stay black, in vacuum and with an infinite standard error.
    pub fn develop(&self, film: &Film) -> Frame {
        let mut frame = Frame::new(self.camera.width, self.camera.height);
        let mut errors = vec![[f32::INFINITY; BAND_COUNT]; self.pixels()];
        for (number, mean) in film.pixels.iter().enumerate() {
            let pixel = film.shard.pixel(number);
            let direction = self.direction(pixel, 0.0, 0.0);
            let transmittance = transport::transmittance(&self.world, self.position(), direction);
            let span = self.world.shape.span(self.position(), direction).filter(|span| span.end == End::Ground);
            if let Some(span) = span {
                frame.distance_m[pixel] = span.end_m as f32;
            }
            let disc = if span.is_none() { self.discs(pixel) } else { [0.0; BAND_COUNT] };
            for j in 0..BAND_COUNT {
                frame.radiance[pixel][j] = (mean.mean[j] + transmittance[j] * disc[j]) as f32;
                frame.transmittance[pixel][j] = transmittance[j] as f32;
                errors[pixel][j] = mean.standard_error()[j] as f32;
            }
        }
        frame.standard_error = Some(errors);
        frame
    }

    fn position(&self) -> DVec3 {
        DVec3::new(0.0, 0.0, self.camera.altitude_m.max(0.0))
    }

    /// Through a point of a pixel, in pixels from its centre.
    fn direction(&self, pixel: usize, right: f64, down: f64) -> DVec3 {
        let width = self.camera.width as usize;
        self.camera.direction_through((pixel % width) as f64 + 0.5 + right, (pixel / width) as f64 + 0.5 + down)
    }

    /// Radiance of the lights' discs outside the air, averaged over a pixel.
    fn discs(&self, pixel: usize) -> Bands {
        let offset = |i: u32| (f64::from(i) + 0.5) / f64::from(DISC_RAYS) - 0.5;
        let mut sum = [0.0; BAND_COUNT];
        for light in self.world.lights.iter().filter(|light| light.toward().is_some()) {
            for ray in 0..DISC_RAYS * DISC_RAYS {
                let direction = self.direction(pixel, offset(ray % DISC_RAYS), offset(ray / DISC_RAYS));
                let Some((radiance, _)) = light.radiance(direction) else { continue };
                for j in 0..BAND_COUNT {
                    sum[j] += radiance[j] / f64::from(DISC_RAYS * DISC_RAYS);
                }
            }
        }
        sum
    }
}

/// A pixel's ray.
pub struct PixelRay<'a> {
    view: View<'a>,
    pixel: usize,
}

impl<'a> Subject for &'a CameraView {
    type Ray = PixelRay<'a>;

    fn ray(&self, pixel: usize) -> PixelRay<'a> {
        let direction = self.direction(pixel, 0.0, 0.0);
        PixelRay { view: View::new(&self.world, self.position(), direction, FirstOrderBy::Quadrature), pixel }
    }

    fn batch(&self, ray: &PixelRay<'a>, batch: u64) -> Bands {
        let budget = Budget {
            batches: 1,
            walks_per_batch: self.walks_per_batch,
            seed: self.seed,
            stream: ray.pixel as u64,
            first_batch: batch,
        };
        ray.view.batch(&budget, batch).total()
    }
}
