//! One command buffer with its pool and fence, which the next recording takes over.

use std::sync::Arc;

use ash::vk;

use super::census::{Counted, Kind};
use super::context::{Context, lock};
use super::error::{During, GpuError};

/// What a list is made of. The device keeps those that no recording uses ([`Context::idle_lists`]): a frame makes none.
#[derive(Clone, Copy, Default)]
pub(crate) struct RawList {
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
}

impl RawList {
    fn new(context: &Context) -> Result<Self, GpuError> {
        let mut list = Self::default();
        let filled = list.fill(context);
        // An early return destroys what there is.
        filled.inspect_err(|_| list.destroy(&context.device)).map(|()| list)
    }

    fn fill(&mut self, context: &Context) -> Result<(), GpuError> {
        let device = &context.device;
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(context.queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: the queue family is the device's.
        self.pool = unsafe { device.create_command_pool(&info, None) }.during("vkCreateCommandPool")?;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: the pool is alive.
        self.commands = unsafe { device.allocate_command_buffers(&info) }.during("vkAllocateCommandBuffers")?[0];
        // SAFETY: no preconditions.
        self.fence = unsafe { device.create_fence(&Default::default(), None) }.during("vkCreateFence")?;
        Ok(())
    }

    /// Makes the list empty and its fence unsignalled.
    ///
    /// # Safety
    /// The device uses neither.
    unsafe fn reset(&self, device: &ash::Device) -> Result<(), GpuError> {
        // SAFETY: the caller's promise.
        unsafe {
            device.reset_fences(&[self.fence]).during("vkResetFences")?;
            device.reset_command_pool(self.pool, Default::default()).during("vkResetCommandPool")
        }
    }

    /// Destroys what the device no longer uses.
    pub(crate) fn destroy(&self, device: &ash::Device) {
        // SAFETY: only lists that the device is done with, or has never seen, are idle or fail. Null handles are ignored,
        // and the buffer goes with its pool.
        unsafe {
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
        }
    }
}

/// A command buffer that is being recorded.
pub(crate) struct CommandList {
    context: Arc<Context>,
    list: RawList,
    pub(crate) raw: vk::CommandBuffer,
    _counted: Counted,
}

impl CommandList {
    pub(crate) fn new(context: &Arc<Context>) -> Result<Self, GpuError> {
        let idle = lock(&context.idle_lists).pop();
        let list = idle.map_or_else(|| RawList::new(context), Ok)?;
        let counted = context.census.count(Kind::CommandList);
        let list = Self { context: context.clone(), list, raw: list.commands, _counted: counted };
        list.begin()?;
        Ok(list)
    }

    fn begin(&self) -> Result<(), GpuError> {
        let once = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the command buffer is new or has been reset.
        unsafe { self.context.device.begin_command_buffer(self.raw, &once) }.during("vkBeginCommandBuffer")
    }

    /// Ends the list, submits it and waits until the device has done it.
    pub(crate) fn submit_and_wait(&mut self) -> Result<(), GpuError> {
        self.submit(&[], &[])?;
        self.wait()
    }

    /// Ends the list and submits it; it waits for semaphores and signals others.
    pub(crate) fn submit(
        &mut self,
        waits: &[vk::SemaphoreSubmitInfo],
        signals: &[vk::SemaphoreSubmitInfo],
    ) -> Result<(), GpuError> {
        // SAFETY: the list is being recorded, and its fence is not signalled.
        unsafe { self.context.device.end_command_buffer(self.raw) }.during("vkEndCommandBuffer")?;
        self.context.submit(self.raw, self.list.fence, waits, signals)
    }

    /// Waits until the device has done what was submitted.
    pub(crate) fn wait(&self) -> Result<(), GpuError> {
        // SAFETY: the fence was submitted.
        unsafe { self.context.device.wait_for_fences(&[self.list.fence], true, u64::MAX) }.during("vkWaitForFences")
    }

    /// Starts an empty list again, after [`CommandList::wait`].
    pub(crate) fn restart(&mut self) -> Result<(), GpuError> {
        // SAFETY: the device has finished with both.
        unsafe { self.list.reset(&self.context.device) }?;
        self.begin()
    }
}

impl Drop for CommandList {
    fn drop(&mut self) {
        // SAFETY: the list was never submitted, or was waited for; waiting can only fail when the device is lost, and then it
        // uses nothing any more.
        match unsafe { self.list.reset(&self.context.device) } {
            Ok(()) => lock(&self.context.idle_lists).push(self.list),
            Err(_) => self.list.destroy(&self.context.device),
        }
    }
}
