//! Memory that nobody has written yet, made to show.

use ash::vk;
use ash::vk::ImageLayout as Layout;

use super::Commands;
use crate::gpu::barrier::{Barriers, Use};
use crate::gpu::resource::{Bound, Resource};

/// All bits set: a float that is no number, of 16 and of 32 bits.
const ALL_BITS: u32 = u32::MAX;

impl Commands {
    /// Fills what a dispatch is the first to write with NaN, where that was asked for: drivers often hand out zeros, with which a
    /// shader that reads more than was written looks right until memory is used a second time.
    pub(super) fn poison(&mut self, bound: &[Bound]) {
        if !self.context.poisons {
            return;
        }
        for bound in bound.iter().filter(|bound| bound.needs.is_some_and(|needs| needs.is_write())) {
            if self.state(bound.resource).is_some_and(|state| !state.is_written()) {
                self.fill_with_nan(bound.resource);
            }
        }
    }

    fn fill_with_nan(&mut self, resource: Resource) {
        let next = match resource {
            Resource::Image(_) | Resource::Sampled(..) => Use::clear(Layout::TRANSFER_DST_OPTIMAL),
            _ => Use::clear(Layout::UNDEFINED),
        };
        let barrier = self.state(resource).and_then(|state| state.next(next));
        let (device, list, mut barriers) = (&self.context.device, self.list.raw, Barriers::default());
        match resource {
            Resource::Image(image) | Resource::Sampled(image, _) => {
                barrier.into_iter().for_each(|barrier| barriers.image(image.0.raw, image.0.aspects(), barrier));
                barriers.record(device, list);
                let whole = vk::ImageSubresourceRange::default()
                    .aspect_mask(image.0.aspects())
                    .level_count(1)
                    .layer_count(image.shape().layers());
                let nan = vk::ClearColorValue { float32: [f32::from_bits(ALL_BITS); 4] };
                // SAFETY: the list is being recorded and keeps the image, which is in this layout; shaders write colour alone.
                unsafe {
                    device.cmd_clear_color_image(list, image.0.raw, Layout::TRANSFER_DST_OPTIMAL, &nan, &[whole]);
                }
            }
            Resource::Buffer(buffer) => {
                barrier.into_iter().for_each(|barrier| barriers.buffer(barrier));
                barriers.record(device, list);
                // SAFETY: as in `Commands::clear`.
                unsafe { device.cmd_fill_buffer(list, buffer.0.raw, 0, vk::WHOLE_SIZE, ALL_BITS) };
            }
            Resource::Data(_) | Resource::Sampler(_) => {}
        }
    }
}
