//! What others have done to images before a recording, and will do after it.

use super::{Commands, Kept};
use crate::gpu::barrier::{Barriers, State, Use};
use crate::gpu::buffer::GpuBuffer;
use crate::gpu::image::{GpuImage, NextUse};
use crate::gpu::resource::Resource;

impl Commands {
    /// Puts an image that the recording has written into the layout for what others do with it next.
    pub fn leave_for(&mut self, image: &GpuImage, next: NextUse) {
        let barrier =
            self.state(Resource::Image(image)).and_then(|state| state.next(Use::read_by_others(next.layout())));
        let mut barriers = Barriers::default();
        if let Some(barrier) = barrier {
            barriers.image(image.0.raw, image.0.aspects(), barrier);
        }
        barriers.record(&self.context.device, self.list.raw);
    }

    /// Starts from what somebody else has done to an image.
    pub(in crate::gpu) fn take_over(&mut self, image: &GpuImage, last: Use) {
        self.images.insert(image.0.raw, (image.clone(), State::left_by(last)));
    }

    /// Makes an image ready for what somebody else does with it, or leaves it as it is; says how that is.
    pub(in crate::gpu) fn hand_back(&mut self, image: &GpuImage, next: Option<Use>) -> Use {
        let mut barriers = Barriers::default();
        let aspects = image.0.aspects();
        let Some(state) = self.state(Resource::Image(image)) else { return Use::default() };
        let barrier = next.and_then(|next| state.next(next));
        let left = next.unwrap_or_else(|| state.last_use());
        if let Some(barrier) = barrier {
            barriers.image(image.0.raw, aspects, barrier);
        }
        barriers.record(&self.context.device, self.list.raw);
        left
    }

    /// Ends a recording into a host's command buffer; what the device will use must be kept until it has.
    pub(in crate::gpu) fn hand_over(mut self) -> (Kept, Vec<GpuImage>, Vec<GpuBuffer>) {
        self.context.end_label(self.list.raw);
        self.note_states();
        let images = std::mem::take(&mut self.images).into_values().map(|(image, _)| image).collect();
        let buffers = std::mem::take(&mut self.buffers).into_values().map(|(buffer, _)| buffer).collect();
        (std::mem::take(&mut self.kept), images, buffers)
    }
}
