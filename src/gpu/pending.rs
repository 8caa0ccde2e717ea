//! Images on their way to the host.

use std::sync::Arc;

use bytemuck::{AnyBitPattern, NoUninit};

use super::buffer::BufferInner;
use super::command_list::CommandList;
use super::context::Context;
use super::error::GpuError;
use super::image::GpuImage;
use super::{elements, transfer};

/// An image's texels, which the device copies while the host goes on: it may record and submit what overwrites the image, as the
/// copy comes first on the queue. Any thread may wait for them.
pub struct PendingImage {
    list: CommandList,
    staging: BufferInner,
    /// Lives until the device has copied it.
    image: GpuImage,
}

impl PendingImage {
    pub(crate) fn new(context: &Arc<Context>, image: &GpuImage) -> Result<Self, GpuError> {
        let (list, staging) = transfer::submit_image_copy(context, image)?;
        Ok(Self { list, staging, image: image.clone() })
    }

    /// Waits until the texels are there: in rows from the first, then slices or layers.
    ///
    /// # Errors
    /// [`GpuError::Size`] unless the image has a whole number of elements; that of a lost device.
    pub fn wait<T: AnyBitPattern + NoUninit>(self) -> Result<Vec<T>, GpuError> {
        let mut texels = elements::<T>(self.image.name(), self.image.bytes())?;
        self.list.wait()?;
        self.staging.read_mapped(bytemuck::cast_slice_mut(&mut texels))?;
        Ok(texels)
    }
}

impl Drop for PendingImage {
    fn drop(&mut self) {
        // Who no longer wants the texels must not take the memory from under the copy. A lost device copies nothing any more.
        let _ = self.list.wait();
    }
}
