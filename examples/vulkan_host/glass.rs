//! What light passes through: the engine's froxels, which welkin fills, and panes of glass that it draws with them.

use ash::vk;
use welkin::gpu::{Gpu, HostImage, HostUse};
use welkin::plan::FroxelGrid;
use welkin::renderer::HostFroxels;

use super::engine::{COPIED_COLOUR, Engine, Slot, WALLS};
use super::images::{Copied, Image, image};

/// The engine's froxels: 16 pixels wide, and of distances up to 50 km.
pub struct Froxels {
    pub grid: FroxelGrid,
    format: vk::Format,
    /// Radiance and transmittance.
    images: [Image; 2],
    copies: [Copied; 2],
}

/// A round pane of glass that faces the camera.
pub struct Pane {
    /// Its middle, as shares of the picture.
    pub place: [f32; 2],
    /// Its radius, as a share of the picture's height.
    pub radius: f32,
    /// Its distance along the rays through it, m.
    pub distance_m: f64,
    /// What it lets through, of each colour.
    pub transmittance: [f32; 3],
}

/// Panes of one kind from near to far.
pub const PANES: [Pane; 3] = [
    Pane { place: [0.2, 0.45], radius: 0.15, distance_m: 50.0, transmittance: GLASS },
    Pane { place: [0.5, 0.45], radius: 0.15, distance_m: 5_000.0, transmittance: GLASS },
    Pane { place: [0.8, 0.45], radius: 0.15, distance_m: 30_000.0, transmittance: GLASS },
];
const GLASS: [f32; 3] = [0.2, 0.3, 0.6];

impl Froxels {
    pub fn new(engine: &Engine, format: vk::Format) -> anyhow::Result<Self> {
        let [columns, rows] = engine.size.map(|pixels| pixels.div_ceil(16));
        Self::of_grid(engine, format, FroxelGrid { size: [columns, rows, 32], near_m: 100.0, far_m: 50_000.0 })
    }

    pub fn of_grid(engine: &Engine, format: vk::Format, grid: FroxelGrid) -> anyhow::Result<Self> {
        // SAFETY: the hardware is the instance's.
        let memory = unsafe { engine.instance.get_physical_device_memory_properties(engine.physical_device) };
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::SAMPLED | Usage::STORAGE | Usage::TRANSFER_SRC;
        let make = || image(&engine.device, &memory, grid.size, format, usage);
        let copy = || Copied::new(&engine.device, &memory, format, grid.size);
        Ok(Self { grid, format, images: [make()?, make()?], copies: [copy()?, copy()?] })
    }

    /// The images as welkin knows them: of nothing that was in them, and copied next.
    pub fn for_welkin(&self, gpu: &Gpu) -> anyhow::Result<HostFroxels> {
        let names = ["froxels' radiance", "froxels' transmittance"];
        let of = |index: usize| -> anyhow::Result<HostImage> {
            // SAFETY: the images are the engine's, which destroys them when all frames are done and welkin is gone.
            let image = unsafe { gpu.host_volume(names[index], self.images[index].raw, self.format, self.grid.size) }?;
            // A frame before it may still be copying.
            let before = HostUse { layout: vk::ImageLayout::UNDEFINED, ..COPIED_COLOUR };
            Ok(HostImage { image, before, after: Some(COPIED_COLOUR) })
        };
        let FroxelGrid { near_m, far_m, .. } = self.grid;
        Ok(HostFroxels { radiance: of(0)?, transmittance: of(1)?, near_m, far_m })
    }

    /// Copies what a frame has found, before it is submitted.
    pub fn copy(&self, engine: &Engine, slot: &Slot) {
        for (image, copy) in self.images.iter().zip(&self.copies) {
            copy.record(&engine.device, slot.commands, image);
        }
    }

    /// Radiance and transmittance of a frame that the device has done: columns, then rows, then slices.
    pub fn read(&self, engine: &Engine) -> anyhow::Result<[Vec<[f32; 4]>; 2]> {
        Ok([self.copies[0].read(&engine.device)?, self.copies[1].read(&engine.device)?])
    }

    pub fn destroy(&self, engine: &Engine) {
        self.images.iter().for_each(|image| image.destroy(&engine.device));
        self.copies.iter().for_each(|copy| copy.destroy(&engine.device));
    }
}

/// What a linear sampler that clamps at the edges reads from such images: at a place in the picture, as shares of it, and at a distance, m.
pub fn sample(grid: &FroxelGrid, texels: &[[f32; 4]], place: [f32; 2], distance_m: f64) -> [f32; 4] {
    let coordinates = [place[0], place[1], grid.coordinate(distance_m) as f32];
    let axis = |i: usize| {
        let last = grid.size[i] - 1;
        let at = (coordinates[i] * grid.size[i] as f32 - 0.5).clamp(0.0, last as f32);
        let first = (at as u32).min(last.saturating_sub(1));
        [(first, 1.0 - (at - first as f32)), ((first + 1).min(last), at - first as f32)]
    };
    let mut sum = [0.0; 4];
    for (x, share_x) in axis(0) {
        for (y, share_y) in axis(1) {
            for (z, share_z) in axis(2) {
                let texel = texels[((z * grid.size[1] + y) * grid.size[0] + x) as usize];
                (0..4).for_each(|i| sum[i] += share_x * share_y * share_z * texel[i]);
            }
        }
    }
    sum
}

/// Draws panes over a picture, those far away first, where no wall hides them: each dims what is behind it, but not what the air
/// before it sends.
pub fn draw(engine: &Engine, picture: &mut [[f32; 4]], panes: &[Pane], grid: &FroxelGrid, radiance: &[[f32; 4]]) {
    let [width, height] = engine.size;
    let is_hidden = |pane: &Pane, x: u32, y: u32| {
        WALLS.iter().filter(|wall| f64::from(wall.planar_m) < pane.distance_m).any(|wall| {
            let [left, top, right, bottom] = engine.pixels(wall);
            (left..right).contains(&x) && (top..bottom).contains(&y)
        })
    };
    for (index, pixel) in picture.iter_mut().enumerate() {
        let [x, y] = [index as u32 % width, index as u32 / width];
        let place = [(x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32];
        for pane in panes.iter().rev() {
            let across = (place[0] - pane.place[0]) * width as f32 / height as f32;
            if across.hypot(place[1] - pane.place[1]) > pane.radius || is_hidden(pane, x, y) {
                continue;
            }
            let before = sample(grid, radiance, place, pane.distance_m);
            for channel in 0..3 {
                // What is behind arrives dimmed by the air before the pane already.
                let behind = pixel[channel] - before[channel];
                pixel[channel] = before[channel] + pane.transmittance[channel] * behind;
            }
        }
    }
}
