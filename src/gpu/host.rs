//! Devices, images and command buffers of a host: an engine that draws with Vulkan itself.
//!
//! On a host's device nothing is submitted, waited for or read back here, and nothing of the host's is ever destroyed.
//! [`Gpu::on_host`] checks that the device has what is needed; [`Gpu::host_image`] takes an image in;
//! [`HostCommands`] are what a frame is recorded into, and [`HostRecorded`] is what must live until the device has done it.

use std::ffi::CStr;
use std::path::PathBuf;
use std::sync::Arc;

use ash::vk;
use welkin_shaders::Dimension;

use super::Gpu;
use super::barrier::Use;
use super::buffer::GpuBuffer;
use super::command_list::CommandList;
use super::context::Context;
use super::device::{self, Limits};
use super::error::GpuError;
use super::format::ImageFormat;
use super::image::{GpuImage, ImageInner, ImageShape};
use super::instance::Instance;
use super::recorder::{Commands, Kept};

/// Extensions that a host's device must have: none. Of the instance neither.
pub const HOST_EXTENSIONS: [&CStr; 0] = [];

/// Features that a host's device must have been made with. Vulkan 1.3 requires every device to offer them.
///
/// Synchronization2 is what barriers are recorded with; robust access is what WGSL promises for indices out of bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HostFeatures {
    /// `VkPhysicalDeviceVulkan13Features::synchronization2`.
    pub synchronization2: bool,
    /// `VkPhysicalDeviceFeatures::robustBufferAccess`.
    pub robust_buffer_access: bool,
    /// `VkPhysicalDeviceVulkan13Features::robustImageAccess`.
    pub robust_image_access: bool,
}

impl HostFeatures {
    /// Those that a device was made with.
    pub fn of(features: &vk::PhysicalDeviceFeatures, features_1_3: &vk::PhysicalDeviceVulkan13Features) -> Self {
        Self {
            synchronization2: features_1_3.synchronization2 == vk::TRUE,
            robust_buffer_access: features.robust_buffer_access == vk::TRUE,
            robust_image_access: features_1_3.robust_image_access == vk::TRUE,
        }
    }

    /// Turns on what is needed, beside what the host wants, before it makes its device.
    pub fn enable(features: &mut vk::PhysicalDeviceFeatures, features_1_3: &mut vk::PhysicalDeviceVulkan13Features) {
        features_1_3.synchronization2 = vk::TRUE;
        features.robust_buffer_access = vk::TRUE;
        features_1_3.robust_image_access = vk::TRUE;
    }

    fn missing(self) -> impl Iterator<Item = &'static str> {
        let all = [
            (self.synchronization2, "the feature synchronization2"),
            (self.robust_buffer_access, "the feature robustBufferAccess"),
            (self.robust_image_access, "the feature robustImageAccess"),
        ];
        all.into_iter().filter(|(has, _)| !has).map(|(_, name)| name)
    }
}

/// A device that a host has made, keeps alive and destroys.
#[derive(Clone)]
pub struct HostDevice {
    /// Its instance.
    pub instance: ash::Instance,
    /// `VkApplicationInfo::apiVersion` of the instance: at least Vulkan 1.3.
    pub api_version: u32,
    /// The hardware.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: ash::Device,
    /// The family of the queue that frames are submitted to, which must compute.
    pub queue_family: u32,
    /// What the device was made with.
    pub features: HostFeatures,
    /// Whether the instance has `VK_EXT_debug_utils`, so that objects and passes get names.
    pub debug_utils: bool,
    /// A folder in which compiled pipelines are kept for the next run; without one they are not.
    pub pipeline_cache: Option<PathBuf>,
}

/// How a host uses an image before or after a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HostUse {
    /// Stages.
    pub stage: vk::PipelineStageFlags2,
    /// Accesses in them.
    pub access: vk::AccessFlags2,
    /// The image's layout for them.
    pub layout: vk::ImageLayout,
}

impl From<HostUse> for Use {
    fn from(HostUse { stage, access, layout }: HostUse) -> Self {
        Self { stage, reads: access, writes: access & WRITES, layout }
    }
}

impl From<Use> for HostUse {
    fn from(Use { stage, reads, writes, layout }: Use) -> Self {
        Self { stage, access: reads | writes, layout }
    }
}

/// Accesses that write.
const WRITES: vk::AccessFlags2 = vk::AccessFlags2::from_raw(
    vk::AccessFlags2::SHADER_WRITE.as_raw()
        | vk::AccessFlags2::SHADER_STORAGE_WRITE.as_raw()
        | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw()
        | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()
        | vk::AccessFlags2::TRANSFER_WRITE.as_raw()
        | vk::AccessFlags2::HOST_WRITE.as_raw()
        | vk::AccessFlags2::MEMORY_WRITE.as_raw(),
);

/// An image of a host's in one frame.
#[derive(Clone)]
pub struct HostImage {
    /// From [`Gpu::host_image`].
    pub image: GpuImage,
    /// What the host has done with it last.
    pub before: HostUse,
    /// What it does with it next; without one, the image stays as the frame has used it.
    pub after: Option<HostUse>,
}

/// A command buffer of a host's, and its promises.
pub struct HostCommands(vk::CommandBuffer);

impl HostCommands {
    /// A command buffer to record one frame into.
    ///
    /// # Safety
    /// - It is being recorded, outside of a rendering, and is of a pool of the queue family of [`HostDevice`].
    /// - Command buffers with frames are submitted to one queue of that family, in the order in which they were recorded,
    ///   each once. One that is not submitted is given up with `Renderer::abandon`, before another is recorded.
    /// - Images are in the states that [`HostImage::before`] says when the commands run.
    /// - The [`HostRecorded`] of the frame lives until the device has done it: until a fence or semaphore says so.
    pub unsafe fn new(commands: vk::CommandBuffer) -> Self {
        Self(commands)
    }
}

/// What the device uses until it has done a frame: keep it as long as the frame is in flight, and drop it then. It may
/// outlive the renderer, and must not outlive the device.
#[must_use = "dropped at once, it takes from the device what the frame is made with"]
pub struct HostRecorded {
    _kept: Kept,
    _images: Vec<GpuImage>,
    _buffers: Vec<GpuBuffer>,
}

impl Gpu {
    /// Works on a device that a host owns. No queue is ever touched: frames are recorded into the host's command buffers.
    ///
    /// # Errors
    /// [`GpuError::HostLacks`] with everything that the device lacks; Vulkan's errors.
    ///
    /// # Safety
    /// The handles are valid and belong together, and what is said of them is true. The device outlives what is returned,
    /// its clones, everything made of them and every [`HostRecorded`].
    pub unsafe fn on_host(host: HostDevice) -> Result<Self, GpuError> {
        let instance = Instance::of_host(host.instance, host.debug_utils);
        let mut missing: Vec<String> = Vec::new();
        if host.api_version < vk::API_VERSION_1_3 {
            missing.push("an instance of Vulkan 1.3 (VkApplicationInfo::apiVersion)".to_owned());
        }
        let mut candidate = device::candidate(&instance, host.physical_device);
        let [major, minor, _] = candidate.info.vulkan_version;
        if (major, minor) < (1, 3) {
            missing.push(format!("Vulkan 1.3 (it serves {major}.{minor})"));
        }
        // SAFETY: the hardware is of this instance.
        let families = unsafe { instance.raw.get_physical_device_queue_family_properties(host.physical_device) };
        let family = families.get(host.queue_family as usize);
        if !family.is_some_and(|family| family.queue_flags.contains(vk::QueueFlags::COMPUTE)) {
            missing.push(format!("a queue family {} that computes", host.queue_family));
        }
        missing.extend(host.features.missing().map(str::to_owned));
        if !missing.is_empty() {
            return Err(GpuError::HostLacks { device: candidate.info.name, missing });
        }
        candidate.queue_family = host.queue_family;
        let folder = host.pipeline_cache.as_deref();
        Context::around(host.device, None, instance, candidate, folder).map(|context| Self(Arc::new(context)))
    }

    /// Takes in an image that a host has made, destroys, and goes on using. It is sampled, and stored to where a frame
    /// says so; its usage must have been made for both (`VK_IMAGE_USAGE_SAMPLED_BIT`, `VK_IMAGE_USAGE_STORAGE_BIT`).
    ///
    /// # Errors
    /// [`GpuError::HostImage`] for a format that is not known here, or a size beyond the device; Vulkan's errors.
    ///
    /// # Safety
    /// The image is of this device, two-dimensional, of that format and size, with one mip level, one layer, one sample and
    /// optimal tiling, exclusive to the queue family of [`HostDevice`] or shared with it. It outlives what is returned, its
    /// clones and every [`HostRecorded`] of a frame with it.
    pub unsafe fn host_image(
        &self,
        name: &str,
        image: vk::Image,
        format: vk::Format,
        [width, height]: [u32; 2],
    ) -> Result<GpuImage, GpuError> {
        // SAFETY: as the caller promises.
        unsafe { self.image_of_host(name, image, format, ImageShape::D2(width, height)) }
    }

    /// Takes in a three-dimensional image of a host's, as [`Gpu::host_image`].
    ///
    /// # Errors
    /// As [`Gpu::host_image`].
    ///
    /// # Safety
    /// As [`Gpu::host_image`], but for three dimensions.
    pub unsafe fn host_volume(
        &self,
        name: &str,
        image: vk::Image,
        format: vk::Format,
        [width, height, depth]: [u32; 3],
    ) -> Result<GpuImage, GpuError> {
        // SAFETY: as the caller promises.
        unsafe { self.image_of_host(name, image, format, ImageShape::D3(width, height, depth)) }
    }

    /// # Safety
    /// As [`Gpu::host_image`], of this shape.
    unsafe fn image_of_host(
        &self,
        name: &str,
        image: vk::Image,
        format: vk::Format,
        shape: ImageShape,
    ) -> Result<GpuImage, GpuError> {
        let refuse = |reason: String| GpuError::HostImage { name: name.to_owned(), reason };
        let known = ImageFormat::of(format).ok_or_else(|| {
            refuse(format!(
                "its format is {format:?}; known are R32G32B32A32_SFLOAT, R16G16B16A16_SFLOAT, B10G11R11_UFLOAT_PACK32, \
                 R8G8B8A8_UNORM, R32_SFLOAT, D32_SFLOAT, D16_UNORM, D24_UNORM_S8_UINT and D32_SFLOAT_S8_UINT"
            ))
        })?;
        let Limits { image_side: [_, flat, deep], .. } = self.info().limits;
        let side = if shape.dimension() == Dimension::D3 { deep } else { flat };
        if shape.extent().iter().any(|&texels| texels == 0 || texels > side) {
            let [width, height, depth] = shape.extent();
            return Err(refuse(format!("{width} x {height} x {depth} texels; each side must be in 1..={side}")));
        }
        // SAFETY: as the caller promises.
        unsafe { ImageInner::of_host(&self.0, name, image, shape, known) }.map(|inner| GpuImage(Arc::new(inner)))
    }

    /// Starts a list of dispatches in a command buffer of a host's.
    ///
    /// # Errors
    /// [`GpuError::Recording`] when another list is open.
    pub(crate) fn record_for_host(&self, label: &str, commands: HostCommands) -> Result<Commands, GpuError> {
        Commands::into_list(&self.0, CommandList::of_host(&self.0, commands.0), label, None, None)
    }
}

impl Commands {
    /// Starts from what the host has done to an image.
    pub(crate) fn take_over_from_host(&mut self, image: &HostImage) {
        self.take_over(&image.image, image.before.into());
    }

    /// Leaves an image to the host; how it is left.
    pub(crate) fn hand_back_to_host(&mut self, image: &HostImage) -> HostUse {
        self.hand_back(&image.image, image.after.map(Use::from)).into()
    }

    /// Ends a recording into a host's command buffer.
    pub(crate) fn hand_over_to_host(self) -> HostRecorded {
        let (kept, images, buffers) = self.hand_over();
        HostRecorded { _kept: kept, _images: images, _buffers: buffers }
    }
}
