//! The little engine's images, and how it reads them.

use anyhow::Context as _;
use ash::vk;
use ash::vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stage};

/// An image of the engine's.
pub struct Image {
    pub raw: vk::Image,
    pub format: vk::Format,
    pub view: vk::ImageView,
    memory: vk::DeviceMemory,
}

impl Image {
    /// Destroys it; the device must have done with it.
    pub fn destroy(&self, device: &ash::Device) {
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.raw, None);
            device.free_memory(self.memory, None);
        }
    }
}

/// Memory that the device copies texels to and the engine reads.
pub struct Copied {
    raw: vk::Buffer,
    memory: vk::DeviceMemory,
    format: vk::Format,
    size: [u32; 3],
}

impl Copied {
    pub fn new(
        device: &ash::Device,
        memory: &vk::PhysicalDeviceMemoryProperties,
        format: vk::Format,
        size: [u32; 3],
    ) -> anyhow::Result<Self> {
        let bytes = size.iter().map(|&side| u64::from(side)).product::<u64>() * texel_bytes(format);
        let info = vk::BufferCreateInfo::default().size(bytes).usage(vk::BufferUsageFlags::TRANSFER_DST);
        unsafe {
            let raw = device.create_buffer(&info, None)?;
            let needs = device.get_buffer_memory_requirements(raw);
            let seen = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let memory = allocate(device, memory, needs, seen)?;
            device.bind_buffer_memory(raw, memory, 0)?;
            Ok(Self { raw, memory, format, size })
        }
    }

    /// Copies an image of this format and size, which is in `TRANSFER_SRC_OPTIMAL`.
    pub fn record(&self, device: &ash::Device, commands: vk::CommandBuffer, image: &Image) {
        let [width, height, depth] = self.size;
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let extent = vk::Extent3D { width, height, depth };
        let region = vk::BufferImageCopy::default().image_subresource(layers).image_extent(extent);
        let to_host = [vk::MemoryBarrier2::default()
            .src_stage_mask(Stage::COPY)
            .src_access_mask(Access::TRANSFER_WRITE)
            .dst_stage_mask(Stage::HOST)
            .dst_access_mask(Access::HOST_READ)];
        let dependency = vk::DependencyInfo::default().memory_barriers(&to_host);
        unsafe {
            device.cmd_copy_image_to_buffer(
                commands,
                image.raw,
                vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                self.raw,
                &[region],
            );
            device.cmd_pipeline_barrier2(commands, &dependency);
        }
    }

    /// The texels, when the device has copied them: rows from the top.
    pub fn read(&self, device: &ash::Device) -> anyhow::Result<Vec<[f32; 4]>> {
        let texels = self.size.iter().product::<u32>() as usize;
        unsafe {
            let bytes = texels as u64 * texel_bytes(self.format);
            let mapped = device.map_memory(self.memory, 0, bytes, Default::default())?;
            let read = match self.format {
                vk::Format::R16G16B16A16_SFLOAT => {
                    let halves = std::slice::from_raw_parts(mapped.cast::<[half::f16; 4]>(), texels);
                    halves.iter().map(|texel| texel.map(half::f16::to_f32)).collect()
                }
                _ => std::slice::from_raw_parts(mapped.cast::<[f32; 4]>(), texels).to_vec(),
            };
            device.unmap_memory(self.memory);
            Ok(read)
        }
    }

    pub fn destroy(&self, device: &ash::Device) {
        unsafe {
            device.destroy_buffer(self.raw, None);
            device.free_memory(self.memory, None);
        }
    }
}

fn texel_bytes(format: vk::Format) -> u64 {
    if format == vk::Format::R16G16B16A16_SFLOAT { 8 } else { 16 }
}

pub fn whole(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default().aspect_mask(aspect).level_count(1).layer_count(1)
}

fn allocate(
    device: &ash::Device,
    memory: &vk::PhysicalDeviceMemoryProperties,
    needs: vk::MemoryRequirements,
    wanted: vk::MemoryPropertyFlags,
) -> anyhow::Result<vk::DeviceMemory> {
    let fits = |index: &u32| {
        needs.memory_type_bits & (1 << index) != 0
            && memory.memory_types[*index as usize].property_flags.contains(wanted)
    };
    let index = (0..memory.memory_type_count).find(fits).context("no such memory")?;
    let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(index);
    Ok(unsafe { device.allocate_memory(&info, None) }?)
}

/// An image of two dimensions, or of three where it is deeper than one texel.
pub fn image(
    device: &ash::Device,
    memory: &vk::PhysicalDeviceMemoryProperties,
    [width, height, depth]: [u32; 3],
    format: vk::Format,
    usage: vk::ImageUsageFlags,
) -> anyhow::Result<Image> {
    let (image_type, view_type) = match depth {
        1 => (vk::ImageType::TYPE_2D, vk::ImageViewType::TYPE_2D),
        _ => (vk::ImageType::TYPE_3D, vk::ImageViewType::TYPE_3D),
    };
    let info = vk::ImageCreateInfo::default()
        .image_type(image_type)
        .format(format)
        .extent(vk::Extent3D { width, height, depth })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(usage);
    let is_depth = usage.contains(vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT);
    let aspect = if is_depth { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR };
    unsafe {
        let raw = device.create_image(&info, None)?;
        let needs = device.get_image_memory_requirements(raw);
        let memory = allocate(device, memory, needs, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
        device.bind_image_memory(raw, memory, 0)?;
        let view = vk::ImageViewCreateInfo::default()
            .image(raw)
            .view_type(view_type)
            .format(format)
            .subresource_range(whole(aspect));
        Ok(Image { raw, format, memory, view: device.create_image_view(&view, None)? })
    }
}
