//! Copies between the host and the device's memory.

use std::sync::Arc;

use ash::vk;
use ash::vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};

use super::barrier::{Barrier, Barriers, State, Use};
use super::buffer::{BufferInner, BufferKind, GpuBuffer};
use super::command_list::CommandList;
use super::context::{Context, lock};
use super::error::GpuError;
use super::image::GpuImage;

/// Before the host reads what a copy has written.
const COPY_TO_HOST: Barrier = Barrier {
    from_stage: Stage::COPY,
    from_access: Access::TRANSFER_WRITE,
    to_stage: Stage::HOST,
    to_access: Access::HOST_READ,
    from_layout: Layout::UNDEFINED,
    to_layout: Layout::UNDEFINED,
};

/// Fills an image from the host.
pub(crate) fn write_image(context: &Arc<Context>, image: &GpuImage, data: &[u8]) -> Result<(), GpuError> {
    context.check_idle(&format!("write the image `{}`", image.name()))?;
    check_image_size(image, data.len() as u64)?;
    let staging = BufferInner::staging(context, image.name(), image.bytes(), true)?;
    staging.write_mapped(data)?;
    let layout = Layout::TRANSFER_DST_OPTIMAL;
    let list = submit_with_image(context, image, Use::copy_to(layout), |list| {
        // SAFETY: the list is being recorded; image and staging buffer live until it is done and are of one size.
        unsafe {
            let regions = [whole_image(image)];
            context.device.cmd_copy_buffer_to_image(list.raw, staging.raw, image.0.raw, layout, &regions);
        }
    })?;
    list.wait()
}

/// Has the device copy an image to memory that the host sees; whoever reads it waits for the list.
pub(crate) fn submit_image_copy(
    context: &Arc<Context>,
    image: &GpuImage,
) -> Result<(CommandList, BufferInner), GpuError> {
    context.check_idle(&format!("read the image `{}`", image.name()))?;
    check_written(image.name(), &lock(&image.0.state))?;
    let staging = BufferInner::staging(context, image.name(), image.bytes(), false)?;
    let layout = Layout::TRANSFER_SRC_OPTIMAL;
    let list = submit_with_image(context, image, Use::copy_from(layout), |list| {
        // SAFETY: the list is being recorded; the caller keeps image and staging buffer, which are of one size, until it is done.
        unsafe {
            let regions = [whole_image(image)];
            context.device.cmd_copy_image_to_buffer(list.raw, image.0.raw, layout, staging.raw, &regions);
        }
        record_barrier(context, list, COPY_TO_HOST);
    })?;
    Ok((list, staging))
}

/// Fills a buffer from the host.
pub(crate) fn write_buffer(context: &Arc<Context>, buffer: &GpuBuffer, data: &[u8]) -> Result<(), GpuError> {
    context.check_idle(&format!("write the buffer `{}`", buffer.name()))?;
    if buffer.kind() == BufferKind::Uniform {
        return buffer.0.write_mapped(data);
    }
    buffer.0.check_size(data.len() as u64)?;
    let staging = BufferInner::staging(context, buffer.name(), buffer.bytes(), true)?;
    staging.write_mapped(data)?;
    with_buffer(context, buffer, Use::copy_to(Layout::UNDEFINED), |list| {
        copy_buffer(context, list, &staging, &buffer.0);
    })
}

/// Reads a storage buffer to the host.
pub(crate) fn read_buffer(context: &Arc<Context>, buffer: &GpuBuffer, data: &mut [u8]) -> Result<(), GpuError> {
    context.check_idle(&format!("read the buffer `{}`", buffer.name()))?;
    buffer.0.check_size(data.len() as u64)?;
    check_written(buffer.name(), &lock(&buffer.0.state))?;
    if buffer.kind() == BufferKind::Uniform {
        return buffer.0.read_mapped(data);
    }
    let staging = BufferInner::staging(context, buffer.name(), buffer.bytes(), false)?;
    with_buffer(context, buffer, Use::copy_from(Layout::UNDEFINED), |list| {
        copy_buffer(context, list, &buffer.0, &staging);
        record_barrier(context, list, COPY_TO_HOST);
    })?;
    staging.read_mapped(data)
}

fn submit_with_image(
    context: &Arc<Context>,
    image: &GpuImage,
    next: Use,
    record: impl FnOnce(&CommandList),
) -> Result<CommandList, GpuError> {
    let mut list = CommandList::new(context)?;
    let mut state = *lock(&image.0.state);
    let mut barriers = Barriers::default();
    if let Some(barrier) = state.next(next) {
        barriers.image(image.0.raw, image.0.aspects(), barrier);
    }
    barriers.record(&context.device, list.raw);
    record(&list);
    list.submit(&[], &[])?;
    *lock(&image.0.state) = state;
    Ok(list)
}

fn with_buffer(
    context: &Arc<Context>,
    buffer: &GpuBuffer,
    next: Use,
    record: impl FnOnce(&CommandList),
) -> Result<(), GpuError> {
    let mut list = CommandList::new(context)?;
    let mut state = *lock(&buffer.0.state);
    if let Some(barrier) = state.next(next) {
        record_barrier(context, &list, barrier);
    }
    record(&list);
    list.submit_and_wait()?;
    *lock(&buffer.0.state) = state;
    Ok(())
}

fn record_barrier(context: &Context, list: &CommandList, barrier: Barrier) {
    let mut barriers = Barriers::default();
    barriers.buffer(barrier);
    barriers.record(&context.device, list.raw);
}

fn copy_buffer(context: &Context, list: &CommandList, from: &BufferInner, to: &BufferInner) {
    let region = vk::BufferCopy::default().size(from.bytes);
    // SAFETY: the list is being recorded; both buffers live until it is done and are of one size.
    unsafe { context.device.cmd_copy_buffer(list.raw, from.raw, to.raw, &[region]) };
}

fn whole_image(image: &GpuImage) -> vk::BufferImageCopy {
    let layers = vk::ImageSubresourceLayers::default()
        .aspect_mask(vk::ImageAspectFlags::COLOR)
        .layer_count(image.shape().layers());
    vk::BufferImageCopy::default().image_subresource(layers).image_extent(image.shape().vulkan_extent())
}

fn check_image_size(image: &GpuImage, found: u64) -> Result<(), GpuError> {
    let expected = image.bytes();
    let size = || GpuError::Size { name: image.name().to_owned(), expected, found };
    if found == expected { Ok(()) } else { Err(size()) }
}

fn check_written(name: &str, state: &State) -> Result<(), GpuError> {
    if state.is_written() {
        return Ok(());
    }
    let reason = "nothing has written it yet, so there is nothing to read";
    Err(GpuError::Resource { name: name.to_owned(), reason: reason.to_owned() })
}
