//! A scene through its camera, pixel by pixel, for any solver.

use glam::DVec3;
use welkin_lut::spectrum::Channels;
use welkin_lut::{BAND_COUNT, Bands};

use super::exposure::Subject;
use super::film::Film;
use crate::frame::Frame;
use crate::probe::Orders;
use crate::reference::disc::first_order_with_discs;
use crate::reference::marching::March;
use crate::reference::path::{Budget, FirstOrderBy, View};
use crate::reference::shape::End;
use crate::reference::single::usual_error;
use crate::reference::solver::{Solver, SolverError};
use crate::reference::transport;
use crate::reference::world::World;
use crate::scene::{Camera, GroupColour, Scene};

/// Rays across a pixel, in each direction, over which a light's disc is averaged.
const DISC_RAYS: u32 = 8;

/// What the camera of a scene sees. The radiance of a pixel is that of the ray through its centre; only the discs of
/// lights are averaged over the pixel.
#[derive(Debug)]
pub struct CameraView {
    groups: Vec<Group>,
    channels: Channels,
    camera: Camera,
    solver: Solver,
    seed: u64,
    walks_per_batch: u64,
}

/// Three wavelengths: the world as it is at them, and what they add to the picture's channels.
#[derive(Debug)]
struct Group {
    world: World,
    colour: GroupColour,
}

impl CameraView {
    /// Prepares a scene for pictures by a solver with a seed and so many walks (or marches) in a batch.
    ///
    /// # Errors
    /// [`SolverError`] where the solver has no answer for the scene's lights.
    pub fn new(scene: &Scene, solver: Solver, seed: u64, walks_per_batch: u64) -> Result<Self, SolverError> {
        let wavelengths = scene.spectrum.groups();
        let group = |(wavelengths, colour)| Group { world: World::from_scene(&scene.at(wavelengths)), colour };
        let groups: Vec<_> = wavelengths.iter().zip(scene.colour()).map(group).collect();
        groups.iter().try_for_each(|group| solver.check(&group.world, Orders::All))?;
        let (channels, camera) = (scene.spectrum.channels, scene.camera);
        Ok(Self { groups, channels, camera, solver, seed, walks_per_batch })
    }

    /// Pixels of the whole picture.
    pub fn pixels(&self) -> usize {
        self.camera.width as usize * self.camera.height as usize
    }

    /// The picture on a film. Pixels of other parts stay black, in vacuum and with an infinite standard error.
    pub fn develop(&self, film: &Film) -> Frame {
        let mut frame = Frame::of_channels(self.camera.width, self.camera.height, self.channels);
        let mut errors = vec![[f32::INFINITY; BAND_COUNT]; self.pixels()];
        for (number, mean) in film.pixels.iter().enumerate() {
            let pixel = film.shard.pixel(number);
            let direction = self.direction(pixel, 0.0, 0.0);
            let world = &self.groups[0].world;
            let span = world.span(self.position(), direction).filter(|span| span.end == End::Ground);
            if let Some(span) = span {
                frame.distance_m[pixel] = span.end_m as f32;
            }
            let (mut radiance, mut left) = (DVec3::from_array(mean.mean), DVec3::ZERO);
            for Group { world, colour } in &self.groups {
                let transmittance = DVec3::from_array(transport::transmittance(world, self.position(), direction));
                left += colour.transmittance * transmittance;
                if span.is_none() {
                    radiance += colour.radiance * (transmittance * DVec3::from_array(self.discs(world, pixel)));
                }
            }
            frame.radiance[pixel] = radiance.as_vec3().to_array();
            frame.transmittance[pixel] = left.as_vec3().to_array();
            errors[pixel] = mean.standard_error().map(|error| error as f32);
        }
        frame.standard_error = Some(errors);
        frame
    }

    fn position(&self) -> DVec3 {
        let altitude_m = self.camera.altitude_m.max(0.0);
        let eye_m = self.groups[0].world.relief.as_ref().map_or(altitude_m, |relief| relief.eye_altitude_m(altitude_m));
        DVec3::new(0.0, 0.0, eye_m)
    }

    /// Through a point of a pixel, in pixels from its centre.
    fn direction(&self, pixel: usize, right: f64, down: f64) -> DVec3 {
        let width = self.camera.width as usize;
        self.camera.direction_through((pixel % width) as f64 + 0.5 + right, (pixel / width) as f64 + 0.5 + down)
    }

    /// Radiance of the lights' discs outside the air, averaged over a pixel.
    fn discs(&self, world: &World, pixel: usize) -> Bands {
        let offset = |i: u32| (f64::from(i) + 0.5) / f64::from(DISC_RAYS) - 0.5;
        let mut sum = [0.0; BAND_COUNT];
        for light in world.lights.iter().filter(|light| light.toward().is_some()) {
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

/// A pixel's ray, at each group's wavelengths.
pub struct PixelRay<'a> {
    prepared: Vec<(Prepared<'a>, &'a Group)>,
    pixel: u64,
}

/// What a solver keeps of a ray.
enum Prepared<'a> {
    Quadrature(Bands),
    March(March, DVec3),
    Walks(Box<View<'a>>),
}

impl<'a> Subject for &'a CameraView {
    type Ray = PixelRay<'a>;

    fn ray(&self, pixel: usize) -> PixelRay<'a> {
        let (position, direction) = (self.position(), self.direction(pixel, 0.0, 0.0));
        let prepare = |group: &'a Group| {
            let world = &group.world;
            let prepared = match self.solver {
                Solver::Single => {
                    Prepared::Quadrature(first_order_with_discs(world, position, direction, usual_error(world)).total())
                }
                Solver::Marching(march) => Prepared::March(march, direction),
                Solver::Path => {
                    Prepared::Walks(Box::new(View::new(world, position, direction, FirstOrderBy::Quadrature)))
                }
            };
            (prepared, group)
        };
        PixelRay { prepared: self.groups.iter().map(prepare).collect(), pixel: pixel as u64 }
    }

    /// The channels of the picture: groups share their random numbers, so that noise is mostly of brightness, and batches
    /// of colours have the standard errors of colours, whatever ties the wavelengths together.
    fn batch(&self, ray: &PixelRay<'a>, batch: u64) -> Bands {
        let colour = |(prepared, group): &(Prepared, &Group)| {
            group.colour.radiance * DVec3::from_array(self.bands(prepared, &group.world, ray.pixel, batch))
        };
        ray.prepared.iter().map(colour).sum::<DVec3>().to_array()
    }
}

impl CameraView {
    /// Mean radiance over one batch at a group's wavelengths.
    fn bands(&self, prepared: &Prepared, world: &World, pixel: u64, batch: u64) -> Bands {
        match prepared {
            Prepared::Quadrature(radiance) => *radiance,
            Prepared::March(march, direction) => {
                let mut mean = [0.0; BAND_COUNT];
                for repeat in batch * self.walks_per_batch..(batch + 1) * self.walks_per_batch {
                    let once = march.once(world, self.position(), *direction, [self.seed, pixel, repeat]);
                    (0..BAND_COUNT).for_each(|j| mean[j] += once[j] / self.walks_per_batch as f64);
                }
                mean
            }
            Prepared::Walks(view) => {
                let budget = Budget {
                    batches: 1,
                    walks_per_batch: self.walks_per_batch,
                    seed: self.seed,
                    stream: pixel,
                    first_batch: batch,
                };
                view.batch(&budget, batch).total()
            }
        }
    }
}
