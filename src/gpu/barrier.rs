//! Which accesses to a resource must wait for which: the least barrier between two uses of it.

use ash::vk;
use ash::vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};

/// How a command uses a resource.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Use {
    pub(crate) stage: Stage,
    pub(crate) reads: Access,
    pub(crate) writes: Access,
    /// The image layout it needs; `UNDEFINED` for a buffer, which has none.
    pub(crate) layout: Layout,
}

impl Use {
    pub(crate) const fn compute(reads: Access, writes: Access, layout: Layout) -> Self {
        Self { stage: Stage::COMPUTE_SHADER, reads, writes, layout }
    }

    pub(crate) const fn copy_from(layout: Layout) -> Self {
        Self { stage: Stage::COPY, reads: Access::TRANSFER_READ, writes: Access::NONE, layout }
    }

    pub(crate) const fn copy_to(layout: Layout) -> Self {
        Self { stage: Stage::COPY, reads: Access::NONE, writes: Access::TRANSFER_WRITE, layout }
    }

    /// Numbers of workgroups, for a dispatch.
    pub(crate) const fn counts() -> Self {
        let (stage, reads) = (Stage::DRAW_INDIRECT, Access::INDIRECT_COMMAND_READ);
        Self { stage, reads, writes: Access::NONE, layout: Layout::UNDEFINED }
    }

    pub(crate) const fn clear(layout: Layout) -> Self {
        let (stage, writes) = (Stage::ALL_TRANSFER, Access::TRANSFER_WRITE);
        Self { stage, reads: Access::NONE, writes, layout }
    }

    /// Whatever comes next and does not write: another submission, of the host's own.
    pub(crate) const fn read_by_others(layout: Layout) -> Self {
        Self { stage: Stage::ALL_COMMANDS, reads: Access::MEMORY_READ, writes: Access::NONE, layout }
    }

    pub(crate) fn is_write(&self) -> bool {
        !self.writes.is_empty()
    }
}

/// What a command must wait for before it uses a resource.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Barrier {
    pub(crate) from_stage: Stage,
    pub(crate) from_access: Access,
    pub(crate) to_stage: Stage,
    pub(crate) to_access: Access,
    pub(crate) from_layout: Layout,
    pub(crate) to_layout: Layout,
}

/// What has been done to a resource.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct State {
    layout: Layout,
    /// The last write, or the last layout transition.
    write_stage: Stage,
    write_access: Access,
    /// Stages that have read it since.
    read_stages: Stage,
    /// Stages and accesses that see the last write.
    visible_stages: Stage,
    visible_access: Access,
    /// Whether it holds anything.
    written: bool,
}

impl State {
    /// The state of a buffer that the host has filled: the next submission makes that visible by itself.
    pub(crate) fn filled_by_host() -> Self {
        Self { written: true, ..Self::default() }
    }

    /// The state of an image that somebody else has used last, and has filled.
    pub(crate) fn left_by(last: Use) -> Self {
        let (layout, write_stage, write_access) = (last.layout, last.stage, last.writes);
        Self { layout, write_stage, write_access, written: true, ..Self::default() }
    }

    /// The layout, and what whoever comes next must wait for.
    pub(crate) fn last_use(&self) -> Use {
        let stage = self.write_stage | self.read_stages;
        Use { stage, reads: Access::NONE, writes: self.write_access, layout: self.layout }
    }

    /// Whether anything has been written to the resource.
    pub(crate) fn is_written(&self) -> bool {
        self.written
    }

    /// Notes a use and returns what must be waited for before it, if anything.
    pub(crate) fn next(&mut self, next: Use) -> Option<Barrier> {
        let moves = self.layout != next.layout;
        if next.is_write() || moves { self.exclusive(next, moves) } else { self.shared(next) }
    }

    /// A write or a layout transition: after all reads and writes so far.
    fn exclusive(&mut self, next: Use, moves: bool) -> Option<Barrier> {
        let from_stage = self.write_stage | self.read_stages;
        let needed = moves || !from_stage.is_empty();
        let barrier = self.barrier(from_stage, next);
        let (visible_stages, visible_access, read_stages) = if next.is_write() {
            (Stage::NONE, Access::NONE, Stage::NONE)
        } else {
            (next.stage, next.reads, next.stage)
        };
        *self = Self {
            layout: next.layout,
            write_stage: next.stage,
            write_access: next.writes,
            read_stages,
            visible_stages,
            visible_access,
            written: self.written || next.is_write(),
        };
        needed.then_some(barrier)
    }

    /// A read: after the last write, unless that is visible already.
    fn shared(&mut self, next: Use) -> Option<Barrier> {
        let visible = self.visible_stages.contains(next.stage) && self.visible_access.contains(next.reads);
        let needed = !self.write_stage.is_empty() && !visible;
        let barrier = self.barrier(self.write_stage, next);
        self.read_stages |= next.stage;
        self.visible_stages |= next.stage;
        self.visible_access |= next.reads;
        needed.then_some(barrier)
    }

    fn barrier(&self, from_stage: Stage, next: Use) -> Barrier {
        Barrier {
            from_stage,
            from_access: self.write_access,
            to_stage: next.stage,
            to_access: next.reads | next.writes,
            from_layout: self.layout,
            to_layout: next.layout,
        }
    }
}

/// The barriers before one command, recorded as one call.
#[derive(Default)]
pub(crate) struct Barriers {
    buffers: Option<vk::MemoryBarrier2<'static>>,
    images: Vec<vk::ImageMemoryBarrier2<'static>>,
}

impl Barriers {
    /// Buffers need no barrier of their own: one for all memory is cheaper than several.
    pub(crate) fn buffer(&mut self, barrier: Barrier) {
        let all = self.buffers.get_or_insert_default();
        all.src_stage_mask |= barrier.from_stage;
        all.src_access_mask |= barrier.from_access;
        all.dst_stage_mask |= barrier.to_stage;
        all.dst_access_mask |= barrier.to_access;
    }

    pub(crate) fn image(&mut self, image: vk::Image, aspects: vk::ImageAspectFlags, barrier: Barrier) {
        let whole = vk::ImageSubresourceRange::default()
            .aspect_mask(aspects)
            .level_count(1)
            .layer_count(vk::REMAINING_ARRAY_LAYERS);
        self.images.push(
            vk::ImageMemoryBarrier2::default()
                .image(image)
                .subresource_range(whole)
                .src_stage_mask(barrier.from_stage)
                .src_access_mask(barrier.from_access)
                .dst_stage_mask(barrier.to_stage)
                .dst_access_mask(barrier.to_access)
                .old_layout(barrier.from_layout)
                .new_layout(barrier.to_layout)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED),
        );
    }

    /// Records the barriers, if there are any.
    pub(crate) fn record(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        if self.buffers.is_none() && self.images.is_empty() {
            return;
        }
        let buffers = self.buffers.as_slice();
        let dependency = vk::DependencyInfo::default().memory_barriers(buffers).image_memory_barriers(&self.images);
        // SAFETY: the command buffer is being recorded, and the images are kept alive by whoever records it.
        unsafe { device.cmd_pipeline_barrier2(commands, &dependency) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WRITE: Use = Use::compute(Access::NONE, Access::SHADER_STORAGE_WRITE, Layout::GENERAL);
    const READ: Use = Use::compute(Access::SHADER_STORAGE_READ, Access::NONE, Layout::GENERAL);
    const SAMPLE: Use = Use::compute(Access::SHADER_SAMPLED_READ, Access::NONE, Layout::SHADER_READ_ONLY_OPTIMAL);

    #[test]
    fn a_first_write_only_leaves_the_undefined_layout() {
        let barrier = State::default().next(WRITE).expect("a transition");
        assert_eq!((barrier.from_stage, barrier.from_access), (Stage::NONE, Access::NONE));
        assert_eq!((barrier.from_layout, barrier.to_layout), (Layout::UNDEFINED, Layout::GENERAL));
    }

    #[test]
    fn a_read_waits_for_the_write_before_it_and_the_next_read_for_nothing() {
        let mut state = State::default();
        state.next(WRITE);
        let barrier = state.next(READ).expect("read after write");
        assert_eq!((barrier.from_access, barrier.to_access), (WRITE.writes, READ.reads));
        assert_eq!(state.next(READ), None);
    }

    #[test]
    fn sampling_moves_the_layout_once() {
        let mut state = State::default();
        state.next(WRITE);
        let barrier = state.next(SAMPLE).expect("another layout");
        assert_eq!((barrier.from_layout, barrier.to_layout), (Layout::GENERAL, Layout::SHADER_READ_ONLY_OPTIMAL));
        assert_eq!(state.next(SAMPLE), None);
    }

    #[test]
    fn a_write_waits_for_the_reads_and_for_the_write_before_it() {
        let mut state = State::default();
        state.next(WRITE);
        assert!(state.next(WRITE).is_some(), "write after write");
        state.next(READ);
        let barrier = state.next(WRITE).expect("write after read");
        assert_eq!(barrier.from_stage, Stage::COMPUTE_SHADER);
    }

    #[test]
    fn a_copy_must_see_the_write_even_when_a_shader_has_seen_it() {
        let copy = Use::copy_from(Layout::GENERAL);
        let mut state = State::default();
        state.next(WRITE);
        state.next(READ);
        let barrier = state.next(copy).expect("not yet visible to copies");
        assert_eq!((barrier.from_access, barrier.to_stage), (WRITE.writes, Stage::COPY));
        assert_eq!(state.next(copy), None);
        assert_eq!(state.next(READ), None, "still visible to shaders");
    }

    #[test]
    fn what_the_host_has_filled_is_read_without_a_barrier() {
        let mut state = State::filled_by_host();
        let read = Use { layout: Layout::UNDEFINED, ..READ };
        assert_eq!(state.next(read), None);
        let write = Use { layout: Layout::UNDEFINED, ..WRITE };
        assert!(state.next(write).is_some(), "write after read");
    }
}
