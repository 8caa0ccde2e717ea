//! A little engine: a device with what the engine itself wants, a colour and a depth image, and boxes that it draws.
//! Nothing here knows of skies.

use std::ffi::{CStr, c_char, c_void};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context as _, anyhow};
use ash::vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
use ash::{ext, vk};
use welkin::gpu::{HostFeatures, HostUse};

use super::images::{Copied, Image, image, whole};

/// Distance of the engine's near plane, m; its depth is reversed and has no far plane.
pub const NEAR_M: f64 = 0.1;

/// A wall that the engine draws, facing the camera.
pub struct Wall {
    /// Left, top, right and bottom, as shares of the picture.
    pub place: [f32; 4],
    /// Distance from the camera's plane, m.
    pub planar_m: f32,
    /// The light that it sends, in the engine's unit.
    pub colour: [f32; 3],
}

/// A near tower before a far ridge.
pub const WALLS: [Wall; 2] = [
    Wall { place: [0.0, 0.5, 1.0, 0.75], planar_m: 30_000.0, colour: [0.02, 0.03, 0.02] },
    Wall { place: [0.6, 0.25, 0.75, 1.0], planar_m: 800.0, colour: [0.10, 0.06, 0.04] },
];

/// What one frame in flight has of its own.
pub struct Slot {
    pub commands: vk::CommandBuffer,
    pub done: vk::Fence,
    /// What the frame's picture is copied to.
    copy: Copied,
}

/// The messages of the validation layer.
type Messages = Mutex<Vec<String>>;

/// The engine.
pub struct Engine {
    pub instance: ash::Instance,
    pub physical_device: vk::PhysicalDevice,
    pub device: ash::Device,
    pub queue_family: u32,
    pub features: HostFeatures,
    pub size: [u32; 2],
    pub colour: Image,
    pub depth: Image,
    pub slots: [Slot; 2],
    queue: vk::Queue,
    pool: vk::CommandPool,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Messages>,
    _entry: ash::Entry,
}

const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

impl Engine {
    /// Opens the first device that draws and computes. `validate`: the validation layer watches, synchronisation too.
    pub fn new(size: [u32; 2], colour_format: vk::Format, validate: bool) -> anyhow::Result<Self> {
        // SAFETY: here and below: the calls follow Vulkan's rules, of which the validation layer is witness.
        let entry = unsafe { ash::Entry::load() }?;
        let messages = Box::new(Messages::default());
        let instance = create_instance(&entry, validate, &messages)?;
        let messenger = if validate {
            let functions = ext::debug_utils::Instance::new(&entry, &instance);
            let messenger = unsafe { functions.create_debug_utils_messenger(&messenger_info(&messages), None) }?;
            Some((functions, messenger))
        } else {
            None
        };
        let (physical_device, queue_family) = choose(&instance)?;
        // What the engine wants for itself, and what welkin needs beside it.
        let mut features = vk::PhysicalDeviceFeatures::default();
        let mut features_1_3 = vk::PhysicalDeviceVulkan13Features::default().dynamic_rendering(true);
        HostFeatures::enable(&mut features, &mut features_1_3);
        let enabled = HostFeatures::of(&features, &features_1_3);
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&[1.0])];
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&features)
            .push_next(&mut features_1_3);
        let device = unsafe { instance.create_device(physical_device, &info, None) }?;
        let memory = unsafe { instance.get_physical_device_memory_properties(physical_device) };
        let queue = unsafe { device.get_device_queue(queue_family, 0) };
        let flags = vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER;
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(queue_family).flags(flags);
        let pool = unsafe { device.create_command_pool(&pool, None) }?;
        use vk::ImageUsageFlags as Usage;
        let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED | Usage::STORAGE | Usage::TRANSFER_SRC;
        let extent = [size[0], size[1], 1];
        let colour = image(&device, &memory, extent, colour_format, usage)?;
        let usage = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED;
        let depth = image(&device, &memory, extent, vk::Format::D32_SFLOAT, usage)?;
        let new_slot = || slot(&device, pool, Copied::new(&device, &memory, colour_format, extent)?);
        let slots = [new_slot()?, new_slot()?];
        Ok(Self {
            instance,
            physical_device,
            device,
            queue_family,
            features: enabled,
            size,
            colour,
            depth,
            slots,
            queue,
            pool,
            messenger,
            messages,
            _entry: entry,
        })
    }

    /// Waits until the device has done a slot's last frame, and begins the next. A fence is made signalled.
    pub fn begin(&self, slot: &Slot) -> anyhow::Result<()> {
        let once = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        unsafe {
            self.device.wait_for_fences(&[slot.done], true, u64::MAX)?;
            self.device.reset_command_buffer(slot.commands, Default::default())?;
            self.device.begin_command_buffer(slot.commands, &once)?;
        }
        Ok(())
    }

    /// Draws the walls into colour and depth, which is reversed: 0 is the sky. `colour_before` and `depth_before` are the
    /// last uses of the images, of which nothing is kept.
    pub fn draw_walls(&self, slot: &Slot, [colour_before, depth_before]: [HostUse; 2]) {
        let [width, height] = self.size;
        let from = |image: vk::Image, aspect, before: HostUse, to: HostUse| {
            vk::ImageMemoryBarrier2::default()
                .image(image)
                .subresource_range(whole(aspect))
                .src_stage_mask(before.stage)
                .src_access_mask(before.access)
                .dst_stage_mask(to.stage)
                .dst_access_mask(to.access)
                .old_layout(Layout::UNDEFINED)
                .new_layout(to.layout)
        };
        let barriers = [
            from(self.colour.raw, vk::ImageAspectFlags::COLOR, colour_before, DRAWN_COLOUR),
            from(self.depth.raw, vk::ImageAspectFlags::DEPTH, depth_before, DRAWN_DEPTH),
        ];
        let dependency = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        let attachment = |image: &Image, layout| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.view)
                .image_layout(layout)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
        };
        let colour = [attachment(&self.colour, DRAWN_COLOUR.layout)];
        let depth = attachment(&self.depth, DRAWN_DEPTH.layout);
        let area = vk::Extent2D { width, height }.into();
        let rendering = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colour)
            .depth_attachment(&depth);
        unsafe {
            self.device.cmd_pipeline_barrier2(slot.commands, &dependency);
            self.device.cmd_begin_rendering(slot.commands, &rendering);
            for wall in &WALLS {
                self.draw(slot, wall);
            }
            self.device.cmd_end_rendering(slot.commands);
        }
    }

    /// A wall faces the camera, so that its pixels share a colour and a depth.
    unsafe fn draw(&self, slot: &Slot, wall: &Wall) {
        let [left, top, right, bottom] = self.pixels(wall);
        let rect = vk::Rect2D {
            offset: vk::Offset2D { x: left as i32, y: top as i32 },
            extent: vk::Extent2D { width: right - left, height: bottom - top },
        };
        let [r, g, b] = wall.colour;
        let colour = vk::ClearValue { color: vk::ClearColorValue { float32: [r, g, b, 1.0] } };
        let depth = NEAR_M as f32 / wall.planar_m;
        let depth = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } };
        let clears = [
            vk::ClearAttachment { aspect_mask: vk::ImageAspectFlags::COLOR, color_attachment: 0, clear_value: colour },
            vk::ClearAttachment { aspect_mask: vk::ImageAspectFlags::DEPTH, color_attachment: 0, clear_value: depth },
        ];
        let rects = [vk::ClearRect { rect, base_array_layer: 0, layer_count: 1 }];
        unsafe { self.device.cmd_clear_attachments(slot.commands, &clears, &rects) };
    }

    /// Left, top, right and bottom of a wall, pixels.
    pub fn pixels(&self, wall: &Wall) -> [u32; 4] {
        let [width, height] = self.size.map(|side| side as f32);
        let [left, top, right, bottom] = wall.place;
        [left * width, top * height, right * width, bottom * height].map(|edge| edge.round() as u32)
    }

    /// Copies the picture, which is in `TRANSFER_SRC_OPTIMAL`, to what the engine reads, and submits the frame.
    pub fn submit(&self, slot: &Slot) -> anyhow::Result<()> {
        slot.copy.record(&self.device, slot.commands, &self.colour);
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(slot.commands)];
        let submission = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        unsafe {
            self.device.end_command_buffer(slot.commands)?;
            self.device.reset_fences(&[slot.done])?;
            self.device.queue_submit2(self.queue, &[submission], slot.done)?;
        }
        Ok(())
    }

    /// The picture of a slot's last frame, when the device has done it: rows from the top.
    pub fn picture(&self, slot: &Slot) -> anyhow::Result<Vec<[f32; 4]>> {
        unsafe { self.device.wait_for_fences(&[slot.done], true, u64::MAX) }?;
        slot.copy.read(&self.device)
    }

    /// Waits until the device is idle.
    pub fn finish(&self) -> anyhow::Result<()> {
        Ok(unsafe { self.device.device_wait_idle() }?)
    }

    /// Destroys everything; the messages of the validation layer, also on what was left.
    pub fn close(mut self) -> Vec<String> {
        let device = &self.device;
        unsafe {
            let _ = device.device_wait_idle();
            for slot in &self.slots {
                device.destroy_fence(slot.done, None);
                slot.copy.destroy(device);
            }
            self.colour.destroy(device);
            self.depth.destroy(device);
            device.destroy_command_pool(self.pool, None);
            device.destroy_device(None);
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.instance.destroy_instance(None);
        }
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// How the engine uses its images when it draws, and its picture when it copies it.
pub const DRAWN_COLOUR: HostUse = HostUse {
    stage: Stage::COLOR_ATTACHMENT_OUTPUT,
    access: Access::COLOR_ATTACHMENT_WRITE,
    layout: Layout::COLOR_ATTACHMENT_OPTIMAL,
};
pub const DRAWN_DEPTH: HostUse = HostUse {
    stage: Stage::from_raw(Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw()),
    access: Access::from_raw(
        Access::DEPTH_STENCIL_ATTACHMENT_READ.as_raw() | Access::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    layout: Layout::DEPTH_ATTACHMENT_OPTIMAL,
};
pub const COPIED_COLOUR: HostUse =
    HostUse { stage: Stage::COPY, access: Access::TRANSFER_READ, layout: Layout::TRANSFER_SRC_OPTIMAL };

fn create_instance(entry: &ash::Entry, validate: bool, messages: &Messages) -> anyhow::Result<ash::Instance> {
    let application = vk::ApplicationInfo::default().application_name(c"an engine").api_version(vk::API_VERSION_1_3);
    let layers: &[*const c_char] = if validate { &[LAYER.as_ptr()] } else { &[] };
    let extensions: &[*const c_char] =
        if validate { &[ext::debug_utils::NAME.as_ptr(), ext::validation_features::NAME.as_ptr()] } else { &[] };
    let synchronisation = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut checks = vk::ValidationFeaturesEXT::default().enabled_validation_features(&synchronisation);
    let mut messenger = messenger_info(messages);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_layer_names(layers)
        .enabled_extension_names(extensions);
    if validate {
        info = info.push_next(&mut checks).push_next(&mut messenger);
    }
    unsafe { entry.create_instance(&info, None) }.context("vkCreateInstance")
}

fn messenger_info(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
        .pfn_user_callback(Some(receive))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast())
}

unsafe extern "system" fn receive(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the text is valid for the time of this call, and the messages live as long as the instance.
    let (text, messages) = unsafe { (CStr::from_ptr((*data).p_message), &*messages.cast::<Messages>()) };
    messages.lock().unwrap_or_else(PoisonError::into_inner).push(text.to_string_lossy().into_owned());
    vk::FALSE
}

fn choose(instance: &ash::Instance) -> anyhow::Result<(vk::PhysicalDevice, u32)> {
    let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    for device in unsafe { instance.enumerate_physical_devices() }? {
        let families = unsafe { instance.get_physical_device_queue_family_properties(device) };
        if let Some(family) = families.iter().position(|family| family.queue_flags.contains(wanted)) {
            return Ok((device, family as u32));
        }
    }
    Err(anyhow!("no Vulkan device that draws and computes"))
}

fn slot(device: &ash::Device, pool: vk::CommandPool, copy: Copied) -> anyhow::Result<Slot> {
    let buffers = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
    let signalled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
    unsafe {
        let commands = device.allocate_command_buffers(&buffers)?[0];
        let done = device.create_fence(&signalled, None)?;
        Ok(Slot { commands, done, copy })
    }
}
