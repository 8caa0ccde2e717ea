//! Images in device memory.

use std::sync::{Arc, Mutex};

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;
use welkin_shaders::Dimension;

use super::barrier::State;
use super::census::{Counted, Kind};
use super::context::Context;
use super::error::{During, GpuError};
use super::format::ImageFormat;

/// Shapes of images, in texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageShape {
    /// Width.
    D1(u32),
    /// Width and height.
    D2(u32, u32),
    /// Width, height and layers.
    D2Array(u32, u32, u32),
    /// Width, height and depth.
    D3(u32, u32, u32),
}

impl ImageShape {
    /// Width, height and depth; a layer counts as 1 deep.
    pub const fn extent(self) -> [u32; 3] {
        match self {
            Self::D1(width) => [width, 1, 1],
            Self::D2(width, height) | Self::D2Array(width, height, _) => [width, height, 1],
            Self::D3(width, height, depth) => [width, height, depth],
        }
    }

    /// Number of layers, 1 unless it is an array.
    pub const fn layers(self) -> u32 {
        match self {
            Self::D2Array(_, _, layers) => layers,
            _ => 1,
        }
    }

    /// Number of texels.
    pub const fn texels(self) -> u64 {
        let [width, height, depth] = self.extent();
        width as u64 * height as u64 * depth as u64 * self.layers() as u64
    }

    /// The WGSL texture dimension.
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::D1(_) => Dimension::D1,
            Self::D2(..) => Dimension::D2,
            Self::D2Array(..) => Dimension::D2Array,
            Self::D3(..) => Dimension::D3,
        }
    }

    const fn types(self) -> (vk::ImageType, vk::ImageViewType) {
        match self {
            Self::D1(_) => (vk::ImageType::TYPE_1D, vk::ImageViewType::TYPE_1D),
            Self::D2(..) => (vk::ImageType::TYPE_2D, vk::ImageViewType::TYPE_2D),
            Self::D2Array(..) => (vk::ImageType::TYPE_2D, vk::ImageViewType::TYPE_2D_ARRAY),
            Self::D3(..) => (vk::ImageType::TYPE_3D, vk::ImageViewType::TYPE_3D),
        }
    }

    pub(crate) fn vulkan_extent(self) -> vk::Extent3D {
        let [width, height, depth] = self.extent();
        vk::Extent3D { width, height, depth }
    }
}

/// What those outside of a recording do next with an image that it has written; the image is left in the layout for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NextUse {
    /// Shaders sample it: `VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL`.
    Sample,
    /// It is copied or blitted from: `VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL`.
    Copy,
}

impl NextUse {
    pub(crate) const fn layout(self) -> vk::ImageLayout {
        match self {
            Self::Sample => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
            Self::Copy => vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        }
    }
}

/// An image that shaders can sample and store to. Clones are the same image.
#[derive(Clone)]
pub struct GpuImage(pub(crate) Arc<ImageInner>);

impl GpuImage {
    /// Its name in messages.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// Its shape.
    pub fn shape(&self) -> ImageShape {
        self.0.shape
    }

    /// Its format.
    pub fn format(&self) -> ImageFormat {
        self.0.format
    }

    /// Whether anyone else holds it.
    pub fn is_shared(&self) -> bool {
        Arc::strong_count(&self.0) > 1
    }

    /// Bytes of its texels, without what the device adds.
    pub fn bytes(&self) -> u64 {
        self.0.shape.texels() * self.0.format.texel_bytes()
    }
}

pub(crate) struct ImageInner {
    context: Arc<Context>,
    name: String,
    shape: ImageShape,
    format: ImageFormat,
    pub(crate) raw: vk::Image,
    pub(crate) view: vk::ImageView,
    allocation: Option<Allocation>,
    /// Whose it is: a host destroys its own.
    is_hosts: bool,
    /// After all that has been submitted.
    pub(crate) state: Mutex<State>,
    _counted: Counted,
}

impl ImageInner {
    pub(crate) fn new(
        context: &Arc<Context>,
        name: &str,
        shape: ImageShape,
        format: ImageFormat,
    ) -> Result<Self, GpuError> {
        check(context, name, shape, format)?;
        let device = &context.device;
        // SAFETY: shape and format are within the device's limits.
        let raw = unsafe { device.create_image(&image_info(shape, format), None) }.during("vkCreateImage")?;
        // From here on, an early return destroys what there is.
        let mut image = Self {
            context: context.clone(),
            name: name.to_owned(),
            shape,
            format,
            raw,
            view: vk::ImageView::null(),
            allocation: None,
            is_hosts: false,
            state: Mutex::default(),
            _counted: context.census.count(Kind::Image),
        };
        context.name(raw, name);
        // SAFETY: the image is alive; its memory is of the size and type it requires, and is not used by others.
        unsafe {
            let requirements = device.get_image_memory_requirements(raw);
            let allocation = context.allocate(name, requirements, MemoryLocation::GpuOnly, false)?;
            let allocation = image.allocation.insert(allocation);
            device.bind_image_memory(raw, allocation.memory(), allocation.offset()).during("vkBindImageMemory")?;
        }
        image.make_view()?;
        Ok(image)
    }

    /// An image that a host has made and destroys.
    ///
    /// # Safety
    /// The image is of the context's device, has this shape and format and one mip level, and outlives what is returned.
    pub(super) unsafe fn of_host(
        context: &Arc<Context>,
        name: &str,
        raw: vk::Image,
        shape: ImageShape,
        format: ImageFormat,
    ) -> Result<Self, GpuError> {
        let mut image = Self {
            context: context.clone(),
            name: name.to_owned(),
            shape,
            format,
            raw,
            view: vk::ImageView::null(),
            allocation: None,
            is_hosts: true,
            state: Mutex::default(),
            _counted: context.census.count(Kind::Image),
        };
        image.make_view()?;
        Ok(image)
    }

    fn make_view(&mut self) -> Result<(), GpuError> {
        let whole = vk::ImageSubresourceRange::default()
            .aspect_mask(self.format.sampled_aspect())
            .level_count(1)
            .layer_count(self.shape.layers());
        let view = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(self.shape.types().1)
            .format(self.format.vulkan())
            .subresource_range(whole);
        // SAFETY: the image is alive, has memory, and is of this shape and format.
        self.view = unsafe { self.context.device.create_image_view(&view, None) }.during("vkCreateImageView")?;
        self.context.name(self.view, &self.name);
        Ok(())
    }

    /// What a barrier covers.
    pub(crate) fn aspects(&self) -> vk::ImageAspectFlags {
        self.format.aspects()
    }
}

impl Drop for ImageInner {
    fn drop(&mut self) {
        // SAFETY: recordings keep what they use until it is done; null handles are ignored.
        unsafe {
            self.context.device.destroy_image_view(self.view, None);
            if !self.is_hosts {
                self.context.device.destroy_image(self.raw, None);
            }
        }
        if let Some(allocation) = self.allocation.take() {
            self.context.free(allocation);
        }
    }
}

fn image_info(shape: ImageShape, format: ImageFormat) -> vk::ImageCreateInfo<'static> {
    use vk::ImageUsageFlags as Usage;
    vk::ImageCreateInfo::default()
        .image_type(shape.types().0)
        .format(format.vulkan())
        .extent(shape.vulkan_extent())
        .mip_levels(1)
        .array_layers(shape.layers())
        .samples(vk::SampleCountFlags::TYPE_1)
        .tiling(vk::ImageTiling::OPTIMAL)
        .usage(Usage::SAMPLED | Usage::STORAGE | Usage::TRANSFER_SRC | Usage::TRANSFER_DST)
        .sharing_mode(vk::SharingMode::EXCLUSIVE)
        .initial_layout(vk::ImageLayout::UNDEFINED)
}

/// What the device can do with a format in images of optimal tiling.
pub(crate) fn format_features(context: &Context, format: ImageFormat) -> vk::FormatFeatureFlags {
    let instance = &context.instance.raw;
    // SAFETY: the physical device is of this instance.
    let properties =
        unsafe { instance.get_physical_device_format_properties(context.physical_device, format.vulkan()) };
    properties.optimal_tiling_features
}

fn check(context: &Context, name: &str, shape: ImageShape, format: ImageFormat) -> Result<(), GpuError> {
    let refuse = |reason: String| Err(GpuError::Resource { name: name.to_owned(), reason });
    let limits = &context.info.limits;
    let side = match shape.dimension() {
        Dimension::D1 => limits.image_side[0],
        Dimension::D2 | Dimension::D2Array => limits.image_side[1],
        Dimension::D3 => limits.image_side[2],
    };
    if shape.extent().iter().any(|&texels| texels == 0 || texels > side) {
        return refuse(format!("an image of {shape:?} texels; each side must be in 1..={side}"));
    }
    if shape.layers() == 0 || shape.layers() > limits.image_layers {
        return refuse(format!("an image of {shape:?}; its layers must be in 1..={}", limits.image_layers));
    }
    use vk::FormatFeatureFlags as Feature;
    let needed = Feature::SAMPLED_IMAGE | Feature::STORAGE_IMAGE | Feature::TRANSFER_SRC | Feature::TRANSFER_DST;
    if !format_features(context, format).contains(needed) {
        return refuse(format!("{} cannot sample and store {format:?}", context.info.name));
    }
    Ok(())
}
