//! The open device with what every resource needs of it: queue, memory, names.

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationSizes, MemoryLocation};

use super::census::{Census, Population};
use super::device::{Candidate, DeviceInfo};
use super::error::{During, GpuError};
use super::instance::Instance;
use super::pipeline_cache::PipelineCache;

const MEBIBYTE: u64 = 1 << 20;

/// A logical device. Every resource keeps it alive; it goes when the last of them is gone, unless it is a host's.
pub(crate) struct Context {
    pub(crate) device: ash::Device,
    pub(crate) info: DeviceInfo,
    pub(crate) queue_family: u32,
    /// `None` on a host's device, whose queues are the host's alone.
    queue: Option<Mutex<vk::Queue>>,
    /// `None` only while the device is being destroyed.
    allocator: Mutex<Option<Allocator>>,
    debug: Option<ext::debug_utils::Device>,
    pub(crate) census: Census,
    pub(crate) pipeline_cache: PipelineCache,
    /// Whether what shaders are the first to write is filled with NaN before: [`super::DeviceRequest::poisons_memory`].
    pub(crate) poisons: bool,
    /// Label of the recording that is open.
    recording: Mutex<Option<String>>,
    pub(crate) physical_device: vk::PhysicalDevice,
    /// Last, so that it is destroyed after the device.
    pub(crate) instance: Instance,
}

impl Context {
    pub(crate) fn new(
        instance: Instance,
        candidate: Candidate,
        pipeline_cache: Option<&Path>,
    ) -> Result<Self, GpuError> {
        let device = create_device(&instance, &candidate)?;
        // SAFETY: the device was created with one queue of this family.
        let queue = unsafe { device.get_device_queue(candidate.queue_family, 0) };
        Self::around(device, Some(queue), instance, candidate, pipeline_cache)
    }

    /// A device that is open; without a queue it is a host's.
    pub(crate) fn around(
        device: ash::Device,
        queue: Option<vk::Queue>,
        instance: Instance,
        candidate: Candidate,
        pipeline_cache: Option<&Path>,
    ) -> Result<Self, GpuError> {
        let debug = instance.debug_utils.then(|| ext::debug_utils::Device::new(&instance.raw, &device));
        let pipeline_cache = PipelineCache::new(&device, &candidate, pipeline_cache)?;
        let context = Self {
            device,
            pipeline_cache,
            info: candidate.info,
            queue_family: candidate.queue_family,
            queue: queue.map(Mutex::new),
            allocator: Mutex::new(None),
            debug,
            census: Census::default(),
            poisons: false,
            recording: Mutex::new(None),
            physical_device: candidate.raw,
            instance,
        };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: context.instance.raw.clone(),
            device: context.device.clone(),
            physical_device: candidate.raw,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::new(64 * MEBIBYTE, 16 * MEBIBYTE),
        });
        let failed = |source| GpuError::Memory { name: "allocator".to_owned(), bytes: 0, source };
        *lock(&context.allocator) = Some(allocator.map_err(failed)?);
        Ok(context)
    }

    /// Memory for a resource; freed by [`Context::free`].
    pub(crate) fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Allocation, GpuError> {
        let allocation_scheme = AllocationScheme::GpuAllocatorManaged;
        let description = AllocationCreateDesc { name, requirements, location, linear, allocation_scheme };
        let mut allocator = lock(&self.allocator);
        let allocator = allocator.as_mut().expect("the allocator lives as long as the device");
        let failed = |source| GpuError::Memory { name: name.to_owned(), bytes: requirements.size, source };
        allocator.allocate(&description).map_err(failed)
    }

    pub(crate) fn free(&self, allocation: Allocation) {
        if let Some(allocator) = lock(&self.allocator).as_mut()
            && let Err(error) = allocator.free(allocation)
        {
            tracing::error!("freeing device memory: {error}");
        }
    }

    /// What is alive.
    pub(crate) fn population(&self) -> Population {
        let report = lock(&self.allocator).as_ref().map(Allocator::generate_report);
        self.census
            .population(report.map_or([0; 2], |report| [report.total_allocated_bytes, report.total_capacity_bytes]))
    }

    /// Submits a command buffer that waits for semaphores and signals others; `fence` is signalled when it is done.
    pub(crate) fn submit(
        &self,
        commands: vk::CommandBuffer,
        fence: vk::Fence,
        waits: &[vk::SemaphoreSubmitInfo],
        signals: &[vk::SemaphoreSubmitInfo],
    ) -> Result<(), GpuError> {
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
        let submission = vk::SubmitInfo2::default()
            .command_buffer_infos(&buffers)
            .wait_semaphore_infos(waits)
            .signal_semaphore_infos(signals);
        // SAFETY: nobody else uses the queue meanwhile; the command buffer has ended.
        self.with_queue("submit commands", |queue| unsafe { self.device.queue_submit2(queue, &[submission], fence) })?
            .during("vkQueueSubmit2")
    }

    /// Keeps other threads from the queue while it is used.
    pub(crate) fn with_queue<T>(&self, action: &str, with: impl FnOnce(vk::Queue) -> T) -> Result<T, GpuError> {
        let queue = self.queue.as_ref().ok_or_else(|| GpuError::HostsQueue { action: action.to_owned() })?;
        Ok(with(*lock(queue)))
    }

    /// Whether a host owns the device.
    pub(crate) fn is_hosts(&self) -> bool {
        self.queue.is_none()
    }

    /// Gives a Vulkan object a name in validation messages and debuggers.
    pub(crate) fn name(&self, object: impl vk::Handle, name: &str) {
        let (Some(debug), Ok(name)) = (&self.debug, std::ffi::CString::new(name)) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
        // SAFETY: the object is alive and of this device. A name that cannot be given changes nothing.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    pub(crate) fn begin_label(&self, commands: vk::CommandBuffer, label: &str) {
        let (Some(debug), Ok(label)) = (&self.debug, std::ffi::CString::new(label)) else { return };
        let label = vk::DebugUtilsLabelEXT::default().label_name(&label);
        // SAFETY: the command buffer is being recorded.
        unsafe { debug.cmd_begin_debug_utils_label(commands, &label) };
    }

    pub(crate) fn end_label(&self, commands: vk::CommandBuffer) {
        if let Some(debug) = &self.debug {
            // SAFETY: the command buffer is being recorded and has an open label.
            unsafe { debug.cmd_end_debug_utils_label(commands) };
        }
    }

    /// Marks a recording as open: until it is closed, nothing else may be submitted, as the states of resources that
    /// it starts from would no longer be true.
    pub(crate) fn open_recording(&self, label: &str) -> Result<(), GpuError> {
        let mut recording = lock(&self.recording);
        match recording.as_ref() {
            Some(open) => {
                Err(GpuError::Recording { action: format!("start the recording `{label}`"), open: open.clone() })
            }
            None => {
                *recording = Some(label.to_owned());
                Ok(())
            }
        }
    }

    pub(crate) fn close_recording(&self) {
        *lock(&self.recording) = None;
    }

    /// An error when a recording is open.
    pub(crate) fn check_idle(&self, action: &str) -> Result<(), GpuError> {
        match lock(&self.recording).as_ref() {
            Some(open) => Err(GpuError::Recording { action: action.to_owned(), open: open.clone() }),
            None => Ok(()),
        }
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: no resource is left, as each keeps the context; the allocator's blocks go before the device. A host has
        // promised that its device is alive and uses nothing of ours any more.
        unsafe {
            if !self.is_hosts() {
                let _ = self.device.device_wait_idle();
            }
            self.pipeline_cache.close(&self.device);
            drop(lock(&self.allocator).take());
            if !self.is_hosts() {
                self.device.destroy_device(None);
            }
        }
    }
}

/// The content, also after a panic of another thread: it is only ever replaced as a whole.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn create_device(instance: &Instance, candidate: &Candidate) -> Result<ash::Device, GpuError> {
    let queue =
        [vk::DeviceQueueCreateInfo::default().queue_family_index(candidate.queue_family).queue_priorities(&[1.0])];
    // Robust access defines what WGSL promises for indices out of bounds; Vulkan 1.3 requires both features.
    let features = vk::PhysicalDeviceFeatures::default()
        .robust_buffer_access(true)
        .shader_storage_image_extended_formats(candidate.extended_storage_formats);
    let in_window = instance.has_window();
    let mut features_1_3 = vk::PhysicalDeviceVulkan13Features::default()
        .synchronization2(true)
        .robust_image_access(true)
        .dynamic_rendering(in_window);
    let swapchain = [khr::swapchain::NAME.as_ptr()];
    let extensions = if in_window { &swapchain[..] } else { &[] };
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queue)
        .enabled_features(&features)
        .enabled_extension_names(extensions)
        .push_next(&mut features_1_3);
    // SAFETY: the device is of this instance and has the queue family and the features.
    unsafe { instance.raw.create_device(candidate.raw, &info, None) }.during("vkCreateDevice")
}
