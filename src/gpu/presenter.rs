//! Draws frames of a window: pictures from images, and on top whatever an overlay records.

use std::sync::Arc;
use std::time::{Duration, Instant};

use ash::vk;
use ash::vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};

use super::Gpu;
use super::barrier::{Barrier, Barriers};
use super::command_list::CommandList;
use super::context::Context;
use super::error::{During, GpuError};
use super::format::ScreenEncoding;
use super::image::GpuImage;
use super::surface::Surface;
use super::swapchain::{Swapchain, in_words, shows_above_white};

/// Frames that the host may be ahead of the device.
pub const FRAMES_IN_FLIGHT: usize = 2;

/// Longest wait for an image to draw in: a hidden window may give none.
const ACQUIRE_NS: u64 = 50_000_000;

/// A part of an image in a part of the window. The image was left for [`super::NextUse::Copy`].
pub struct Placed<'a> {
    /// The image.
    pub image: &'a GpuImage,
    /// Left, top, right and bottom in the image, in [0, 1].
    pub from: [f32; 4],
    /// Left, top, right and bottom in the window, in [0, 1].
    pub to: [f32; 4],
}

/// What an overlay records into: a rendering to the window's image, which holds the pictures.
pub struct OverlayTarget {
    /// The command buffer.
    pub commands: vk::CommandBuffer,
    /// The window's size, pixels.
    pub extent: vk::Extent2D,
}

/// What libraries that draw overlays need of a device. It lives as long as its [`Gpu`].
pub struct RawDevice<'a> {
    /// The instance.
    pub instance: &'a ash::Instance,
    /// The device's hardware.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: &'a ash::Device,
}

/// Shows frames in the window that its device was opened for.
pub struct Presenter {
    context: Arc<Context>,
    swapchain: Option<Swapchain>,
    /// The window has changed, or the swapchain does not fit well.
    stale: bool,
    /// Light above white is wanted.
    bright: bool,
    slots: Vec<Slot>,
    next: usize,
    cost: Duration,
    upload_pool: vk::CommandPool,
}

/// What one frame in flight has of its own.
struct Slot {
    list: CommandList,
    in_flight: bool,
    acquired: vk::Semaphore,
    /// Images that the device reads until the frame is done.
    kept: Vec<GpuImage>,
}

impl Presenter {
    /// For the window of [`Gpu::for_window`].
    ///
    /// # Errors
    /// [`GpuError::NoSurface`] for a device that was opened without a window; Vulkan's errors.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let context = gpu.0.clone();
        surface(&context)?;
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(context.queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: the queue family is the device's.
        let upload_pool = unsafe { context.device.create_command_pool(&info, None) }.during("vkCreateCommandPool")?;
        let mut presenter = Self {
            context,
            swapchain: None,
            stale: true,
            bright: false,
            slots: Vec::new(),
            next: 0,
            cost: Duration::ZERO,
            upload_pool,
        };
        for _ in 0..FRAMES_IN_FLIGHT {
            let list = CommandList::new(&presenter.context)?;
            // SAFETY: no preconditions.
            let acquired = unsafe { presenter.context.device.create_semaphore(&Default::default(), None) };
            let acquired = acquired.during("vkCreateSemaphore")?;
            presenter.slots.push(Slot { list, in_flight: false, acquired, kept: Vec::new() });
        }
        Ok(presenter)
    }

    /// Makes sure that there are images of the window's size, in pixels; false while the window has no area.
    ///
    /// # Errors
    /// Vulkan's errors. A lost surface is made anew.
    pub fn prepare(&mut self, size: [u32; 2]) -> Result<bool, GpuError> {
        if size.contains(&0) {
            return Ok(false);
        }
        let fits = |swapchain: &Swapchain| [swapchain.extent.width, swapchain.extent.height] == size;
        if self.stale || !self.swapchain.as_ref().is_some_and(fits) {
            self.wait_idle()?;
            let context = self.context.clone();
            let old = self.swapchain.take();
            let made = Swapchain::new(&context, surface(&context)?, size, self.bright, old.as_ref());
            drop(old);
            match made {
                Err(GpuError::Vulkan { result: vk::Result::ERROR_SURFACE_LOST_KHR, .. }) => {
                    surface(&context)?.renew(&context.instance)?;
                    self.swapchain = Swapchain::new(&context, surface(&context)?, size, self.bright, None)?;
                }
                made => self.swapchain = made?,
            }
            self.stale = false;
        }
        Ok(self.swapchain.is_some())
    }

    /// Format of the window's images; after [`Presenter::prepare`].
    pub fn format(&self) -> Option<vk::Format> {
        self.swapchain.as_ref().map(|swapchain| swapchain.format.format)
    }

    /// How pictures must be encoded; after [`Presenter::prepare`].
    pub fn encoding(&self) -> ScreenEncoding {
        self.swapchain.as_ref().map_or(ScreenEncoding::Srgb, |swapchain| swapchain.encoding)
    }

    /// Whether the screen shows light above white.
    ///
    /// # Errors
    /// Vulkan's errors.
    pub fn offers_above_white(&self) -> Result<bool, GpuError> {
        let formats = surface(&self.context)?.formats(self.context.physical_device);
        let formats = formats.during("vkGetPhysicalDeviceSurfaceFormatsKHR")?;
        let above_white = shows_above_white(&formats);
        let words = if above_white { "light above white too" } else { "no light above white" };
        tracing::info!("the screen shows {words}; it offers {}", in_words(&formats));
        Ok(above_white)
    }

    /// Asks for light above white, or no more; the next [`Presenter::prepare`] does it where the screen can.
    pub fn want_above_white(&mut self, bright: bool) {
        self.stale |= self.bright != bright;
        self.bright = bright;
    }

    /// Draws pictures and overlay and shows them; after [`Presenter::prepare`]. False where nothing could be shown now,
    /// as the window is hidden or has changed: the next call to `prepare` mends that.
    ///
    /// # Errors
    /// Vulkan's errors, and the overlay's.
    pub fn present<E: From<GpuError>>(
        &mut self,
        pictures: &[Placed],
        overlay: impl FnOnce(&OverlayTarget) -> Result<(), E>,
    ) -> Result<bool, E> {
        let Some(swapchain) = &self.swapchain else { return Ok(false) };
        let slot = &mut self.slots[self.next];
        let started = Instant::now();
        slot.finish()?;
        self.cost = started.elapsed();
        let index = match swapchain.acquire(ACQUIRE_NS, slot.acquired) {
            Ok((index, fits)) => {
                self.stale |= !fits;
                index
            }
            Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => return Ok(false),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR | vk::Result::ERROR_SURFACE_LOST_KHR) => {
                self.stale = true;
                return Ok(false);
            }
            Err(result) => return Err(GpuError::Vulkan { call: "vkAcquireNextImageKHR", result }.into()),
        };
        slot.kept = pictures.iter().map(|placed| placed.image.clone()).collect();
        let started = Instant::now();
        let drawn = record(&self.context, swapchain, index, slot.list.raw, pictures, overlay);
        // The image was acquired: it must be shown, whatever became of the overlay.
        let waits = [vk::SemaphoreSubmitInfo::default()
            .semaphore(slot.acquired)
            .stage_mask(Stage::ALL_TRANSFER | Stage::COLOR_ATTACHMENT_OUTPUT)];
        let signals =
            [vk::SemaphoreSubmitInfo::default().semaphore(swapchain.drawn[index]).stage_mask(Stage::ALL_COMMANDS)];
        slot.list.submit(&waits, &signals)?;
        self.cost += started.elapsed();
        slot.in_flight = true;
        self.next = (self.next + 1) % FRAMES_IN_FLIGHT;
        match self.context.with_queue("show a picture", |queue| swapchain.present(queue, index))? {
            Ok(fits) => self.stale |= !fits,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR | vk::Result::ERROR_SURFACE_LOST_KHR) => self.stale = true,
            Err(result) => return Err(GpuError::Vulkan { call: "vkQueuePresentKHR", result }.into()),
        }
        drawn.map(|()| true)
    }

    /// Time that the last frame took from host and device, without waiting for the display.
    pub fn cost(&self) -> Duration {
        self.cost
    }

    /// What a library that draws the overlay is made with.
    pub fn raw_device(&self) -> RawDevice<'_> {
        let Context { instance, physical_device, device, .. } = &*self.context;
        RawDevice { instance: &instance.raw, physical_device: *physical_device, device }
    }

    /// Lets a library fill its textures, with a queue and a pool that nobody else uses meanwhile.
    pub fn upload<T>(&self, with: impl FnOnce(vk::Queue, vk::CommandPool) -> T) -> T {
        let queue = |queue| with(queue, self.upload_pool);
        self.context.with_queue("fill textures", queue).expect("a presenter's device has a queue")
    }

    /// Waits until the device has drawn everything.
    ///
    /// # Errors
    /// Vulkan's errors.
    pub fn wait_idle(&mut self) -> Result<(), GpuError> {
        self.slots.iter_mut().try_for_each(Slot::finish)?;
        // Showing has no fence: only an idle queue says that it is done with the images.
        // SAFETY: the lock keeps other threads from the queue.
        let wait = |queue| unsafe { self.context.device.queue_wait_idle(queue) };
        self.context.with_queue("wait", wait)?.during("vkQueueWaitIdle")
    }
}

impl Slot {
    /// Waits until the device has drawn the slot's last frame, and starts an empty list.
    fn finish(&mut self) -> Result<(), GpuError> {
        if self.in_flight {
            self.list.wait()?;
            self.in_flight = false;
            self.kept.clear();
            self.list.restart()?;
        }
        Ok(())
    }
}

impl Drop for Presenter {
    fn drop(&mut self) {
        let _ = self.wait_idle();
        self.swapchain = None;
        let device = &self.context.device;
        // SAFETY: the device uses none of them any more.
        unsafe {
            self.slots.iter().for_each(|slot| device.destroy_semaphore(slot.acquired, None));
            device.destroy_command_pool(self.upload_pool, None);
        }
    }
}

fn surface(context: &Context) -> Result<&Surface, GpuError> {
    let none = || GpuError::NoSurface("the device was opened without one".to_owned());
    context.instance.surface.as_ref().ok_or_else(none)
}

fn record<E>(
    context: &Context,
    swapchain: &Swapchain,
    index: usize,
    commands: vk::CommandBuffer,
    pictures: &[Placed],
    overlay: impl FnOnce(&OverlayTarget) -> Result<(), E>,
) -> Result<(), E> {
    let (device, image, extent) = (&context.device, swapchain.images[index], swapchain.extent);
    let mut before = (Stage::ALL_TRANSFER | Stage::COLOR_ATTACHMENT_OUTPUT, Access::NONE, Layout::UNDEFINED);
    let mut become_layout = |stage, access, layout| {
        let (from_stage, from_access, from_layout) = std::mem::replace(&mut before, (stage, access, layout));
        let (to_stage, to_access, to_layout) = (stage, access, layout);
        let barrier = Barrier { from_stage, from_access, to_stage, to_access, from_layout, to_layout };
        let mut barriers = Barriers::default();
        barriers.image(image, vk::ImageAspectFlags::COLOR, barrier);
        barriers.record(device, commands);
    };
    become_layout(Stage::ALL_TRANSFER, Access::TRANSFER_WRITE, Layout::TRANSFER_DST_OPTIMAL);
    let whole =
        vk::ImageSubresourceRange::default().aspect_mask(vk::ImageAspectFlags::COLOR).level_count(1).layer_count(1);
    if pictures.is_empty() {
        // SAFETY: here and below the list is being recorded, and the image is acquired and in the layout named.
        unsafe {
            let black = vk::ClearColorValue { float32: [0.0, 0.0, 0.0, 1.0] };
            device.cmd_clear_color_image(commands, image, Layout::TRANSFER_DST_OPTIMAL, &black, &[whole]);
        }
    }
    for placed in pictures {
        let [width, height, _] = placed.image.shape().extent();
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let region = vk::ImageBlit::default()
            .src_subresource(layers)
            .src_offsets(corners(placed.from, width, height))
            .dst_subresource(layers)
            .dst_offsets(corners(placed.to, extent.width, extent.height));
        let (from, to) = (Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL);
        unsafe { device.cmd_blit_image(commands, placed.image.0.raw, from, image, to, &[region], vk::Filter::LINEAR) };
    }
    let drawing = Access::COLOR_ATTACHMENT_READ | Access::COLOR_ATTACHMENT_WRITE;
    become_layout(Stage::COLOR_ATTACHMENT_OUTPUT, drawing, Layout::COLOR_ATTACHMENT_OPTIMAL);
    let attachments = [vk::RenderingAttachmentInfo::default()
        .image_view(swapchain.views[index])
        .image_layout(Layout::COLOR_ATTACHMENT_OPTIMAL)
        .load_op(vk::AttachmentLoadOp::LOAD)
        .store_op(vk::AttachmentStoreOp::STORE)];
    let rendering =
        vk::RenderingInfo::default().render_area(extent.into()).layer_count(1).color_attachments(&attachments);
    unsafe { device.cmd_begin_rendering(commands, &rendering) };
    let drawn = overlay(&OverlayTarget { commands, extent });
    unsafe { device.cmd_end_rendering(commands) };
    become_layout(Stage::NONE, Access::NONE, Layout::PRESENT_SRC_KHR);
    drawn
}

/// Corners in pixels; a blit of no area is one of a pixel.
fn corners([left, top, right, bottom]: [f32; 4], width: u32, height: u32) -> [vk::Offset3D; 2] {
    let pixel = |share: f32, size: u32| ((share * size as f32).round() as i32).clamp(0, size as i32);
    let (x0, y0) = (pixel(left, width).min(width as i32 - 1), pixel(top, height).min(height as i32 - 1));
    let (x1, y1) = (pixel(right, width).max(x0 + 1), pixel(bottom, height).max(y0 + 1));
    [vk::Offset3D { x: x0, y: y0, z: 0 }, vk::Offset3D { x: x1, y: y1, z: 1 }]
}
