//! One command buffer with its pool and fence.

use std::sync::Arc;

use ash::vk;

use super::census::{Counted, Kind};
use super::context::Context;
use super::error::{During, GpuError};

/// A command buffer that is being recorded. A host's has no pool and no fence of ours, and is never submitted here.
pub(crate) struct CommandList {
    context: Arc<Context>,
    pool: vk::CommandPool,
    pub(crate) raw: vk::CommandBuffer,
    fence: vk::Fence,
    _counted: Counted,
}

impl CommandList {
    pub(crate) fn new(context: &Arc<Context>) -> Result<Self, GpuError> {
        if context.is_hosts() {
            return Err(GpuError::HostsQueue { action: "submit commands".to_owned() });
        }
        let device = &context.device;
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(context.queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: the queue family is the device's.
        let pool = unsafe { device.create_command_pool(&info, None) }.during("vkCreateCommandPool")?;
        // From here on, an early return destroys what there is.
        let (raw, fence) = (vk::CommandBuffer::null(), vk::Fence::null());
        let counted = context.census.count(Kind::CommandList);
        let mut list = Self { context: context.clone(), pool, raw, fence, _counted: counted };
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        // SAFETY: the pool is alive.
        let buffers = unsafe { device.allocate_command_buffers(&info) }.during("vkAllocateCommandBuffers")?;
        list.raw = buffers[0];
        // SAFETY: no preconditions.
        list.fence = unsafe { device.create_fence(&Default::default(), None) }.during("vkCreateFence")?;
        list.begin()?;
        Ok(list)
    }

    /// A host's command buffer, which it has begun, ends and submits.
    pub(crate) fn of_host(context: &Arc<Context>, raw: vk::CommandBuffer) -> Self {
        let (pool, fence) = (vk::CommandPool::null(), vk::Fence::null());
        Self { context: context.clone(), pool, raw, fence, _counted: context.census.count(Kind::CommandList) }
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
        if self.pool == vk::CommandPool::null() {
            return Err(GpuError::HostsQueue { action: "submit its command buffer".to_owned() });
        }
        // SAFETY: the list is being recorded, and its fence is not signalled.
        unsafe { self.context.device.end_command_buffer(self.raw) }.during("vkEndCommandBuffer")?;
        self.context.submit(self.raw, self.fence, waits, signals)
    }

    /// Waits until the device has done what was submitted.
    pub(crate) fn wait(&self) -> Result<(), GpuError> {
        // SAFETY: the fence was submitted.
        unsafe { self.context.device.wait_for_fences(&[self.fence], true, u64::MAX) }.during("vkWaitForFences")
    }

    /// Starts an empty list again, after [`CommandList::wait`].
    pub(crate) fn restart(&mut self) -> Result<(), GpuError> {
        let device = &self.context.device;
        // SAFETY: the device has finished with both.
        unsafe {
            device.reset_fences(&[self.fence]).during("vkResetFences")?;
            device.reset_command_pool(self.pool, Default::default()).during("vkResetCommandPool")?;
        }
        self.begin()
    }
}

impl Drop for CommandList {
    fn drop(&mut self) {
        let device = &self.context.device;
        // SAFETY: the list was never submitted, or was waited for; waiting can only fail when the device is lost, and
        // then it uses nothing any more. Null handles are ignored, and the buffer goes with its pool.
        unsafe {
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
        }
    }
}
