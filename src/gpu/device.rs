//! Which device: what there is, what can be used, and which of them is taken.

use std::path::PathBuf;

use ash::vk;

use super::error::{During, GpuError};
use super::instance::Instance;
use super::validation::Validation;

/// What is asked of a device.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DeviceRequest {
    /// A part of the device's name in any case, or its index; without one, the best device.
    pub device: Option<String>,
    /// Whether the validation layer watches.
    pub validation: Validation,
    /// Whether images and buffers hold NaN before shaders write them, so that reading what nobody has written shows. It is so too
    /// where the validation layer watches.
    pub poisons_memory: bool,
    /// A folder in which compiled pipelines are kept for the next run; without one they are not.
    pub pipeline_cache: Option<PathBuf>,
}

/// The kinds of devices, the best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum DeviceKind {
    /// A graphics card.
    DiscreteGpu,
    /// A GPU that shares the processor's memory.
    IntegratedGpu,
    /// A part of another machine's GPU.
    VirtualGpu,
    /// A driver that computes on the CPU.
    Cpu,
    /// Anything else.
    Other,
}

/// What a device says of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceInfo {
    /// The device's name.
    pub name: String,
    /// Its kind.
    pub kind: DeviceKind,
    /// The driver's name.
    pub driver: String,
    /// The driver's version in its own words.
    pub driver_version: String,
    /// The Vulkan version it serves: major, minor, patch.
    pub vulkan_version: [u32; 3],
    /// What it can hold.
    pub limits: Limits,
}

/// Limits that callers may run into.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Texels along the longest side of a 1D, 2D and 3D image.
    pub image_side: [u32; 3],
    /// Layers of an image.
    pub image_layers: u32,
    /// Workgroups of a dispatch.
    pub workgroups: [u32; 3],
    /// Invocations of a workgroup along each axis.
    pub workgroup_size: [u32; 3],
    /// Invocations of a workgroup.
    pub workgroup_invocations: u32,
    /// Memory that a workgroup shares, bytes.
    pub workgroup_bytes: u32,
    /// Resources that a pass may use, by kind.
    pub resources: ResourceLimits,
    /// Bytes of a uniform buffer.
    pub uniform_bytes: u32,
    /// Bytes of a storage buffer.
    pub storage_bytes: u32,
    /// Nanoseconds of a timestamp's tick.
    pub timestamp_period_ns: f32,
    /// Bits of a timestamp that count; 0 where the queue has none.
    pub timestamp_bits: u32,
}

/// Resources that a stage may use of each kind, and of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResourceLimits {
    /// Uniform buffers.
    pub uniform_buffers: u32,
    /// Storage buffers.
    pub storage_buffers: u32,
    /// Images that are read through samplers or loaded.
    pub sampled_images: u32,
    /// Images that are written.
    pub storage_images: u32,
    /// Samplers.
    pub samplers: u32,
    /// All but samplers.
    pub all: u32,
}

/// A device that was found, before it is opened.
pub(crate) struct Candidate {
    pub(crate) raw: vk::PhysicalDevice,
    pub(crate) info: DeviceInfo,
    pub(crate) queue_family: u32,
    /// Optional features that it has.
    pub(crate) extended_storage_formats: bool,
    /// Tells devices and drivers apart whose compiled pipelines differ.
    pub(crate) pipeline_cache_id: [u8; vk::UUID_SIZE],
    /// Why it cannot be used.
    unusable: Option<String>,
}

/// Takes the device that is asked for, or the best one.
pub(crate) fn choose(instance: &Instance, requested: Option<&str>) -> Result<Candidate, GpuError> {
    // SAFETY: the instance is alive.
    let devices = unsafe { instance.raw.enumerate_physical_devices() }.during("vkEnumeratePhysicalDevices")?;
    let candidates: Vec<_> = devices.into_iter().map(|device| candidate(instance, device)).collect();
    select(candidates, requested)
}

fn select(candidates: Vec<Candidate>, requested: Option<&str>) -> Result<Candidate, GpuError> {
    if candidates.is_empty() {
        return Err(GpuError::NoDevice);
    }
    let list = || {
        let line = |(index, candidate): (usize, &Candidate)| format!("{index}: {}", candidate.info.name);
        candidates.iter().enumerate().map(line).collect::<Vec<_>>().join("; ")
    };
    let Some(requested) = requested else {
        let usable = candidates.iter().enumerate().filter(|(_, candidate)| candidate.unusable.is_none());
        let Some((best, _)) = usable.min_by_key(|(_, candidate)| candidate.info.kind) else {
            return Err(GpuError::NoUsableDevice(list()));
        };
        return Ok(candidates.into_iter().nth(best).expect("an index of this list"));
    };
    let position = match requested.parse::<usize>() {
        Ok(index) => (index < candidates.len()).then_some(index),
        Err(_) => candidates.iter().position(|candidate| {
            !requested.is_empty() && candidate.info.name.to_lowercase().contains(&requested.to_lowercase())
        }),
    };
    let Some(position) = position else {
        return Err(GpuError::UnknownDevice { requested: requested.to_owned(), available: list() });
    };
    let candidate = candidates.into_iter().nth(position).expect("an index of this list");
    match &candidate.unusable {
        Some(reason) => Err(GpuError::UnusableDevice { device: candidate.info.name, reason: reason.clone() }),
        None => Ok(candidate),
    }
}

pub(super) fn candidate(owner: &Instance, device: vk::PhysicalDevice) -> Candidate {
    let instance = &owner.raw;
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: the device is of this instance, as in the calls below.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    let properties = properties.properties;
    let families = unsafe { instance.get_physical_device_queue_family_properties(device) };
    let in_window = owner.has_window();
    let flags = if in_window { vk::QueueFlags::COMPUTE | vk::QueueFlags::GRAPHICS } else { vk::QueueFlags::COMPUTE };
    let serves = |(index, family): (usize, &vk::QueueFamilyProperties)| {
        family.queue_flags.contains(flags) && owner.can_show(device, index as u32)
    };
    let queue = families.iter().enumerate().position(serves);
    let timestamp_bits = queue.map_or(0, |queue| families[queue].timestamp_valid_bits);
    let version = properties.api_version;
    let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
    let unusable = if version < vk::API_VERSION_1_3 {
        Some(format!("it serves Vulkan {major}.{minor}; 1.3 is needed"))
    } else if queue.is_none() {
        Some(if in_window { "it cannot draw in this window" } else { "it has no compute queue" }.to_owned())
    } else {
        None
    };
    let info = DeviceInfo {
        name: text(properties.device_name_as_c_str()),
        kind: kind(properties.device_type),
        driver: text(driver.driver_name_as_c_str()),
        driver_version: text(driver.driver_info_as_c_str()),
        vulkan_version: [major, minor, vk::api_version_patch(version)],
        limits: limits(&properties.limits, timestamp_bits),
    };
    let features = unsafe { instance.get_physical_device_features(device) };
    let extended_storage_formats = features.shader_storage_image_extended_formats == vk::TRUE;
    Candidate {
        raw: device,
        info,
        queue_family: queue.unwrap_or(0) as u32,
        extended_storage_formats,
        pipeline_cache_id: properties.pipeline_cache_uuid,
        unusable,
    }
}

fn text(name: Result<&std::ffi::CStr, std::ffi::FromBytesUntilNulError>) -> String {
    name.map_or_else(|_| String::new(), |name| name.to_string_lossy().into_owned())
}

fn kind(kind: vk::PhysicalDeviceType) -> DeviceKind {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::DiscreteGpu,
        vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::IntegratedGpu,
        vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::VirtualGpu,
        vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
        _ => DeviceKind::Other,
    }
}

pub(super) fn limits(limits: &vk::PhysicalDeviceLimits, timestamp_bits: u32) -> Limits {
    Limits {
        image_side: [limits.max_image_dimension1_d, limits.max_image_dimension2_d, limits.max_image_dimension3_d],
        image_layers: limits.max_image_array_layers,
        workgroups: limits.max_compute_work_group_count,
        workgroup_size: limits.max_compute_work_group_size,
        workgroup_invocations: limits.max_compute_work_group_invocations,
        workgroup_bytes: limits.max_compute_shared_memory_size,
        resources: ResourceLimits {
            uniform_buffers: limits.max_per_stage_descriptor_uniform_buffers,
            storage_buffers: limits.max_per_stage_descriptor_storage_buffers,
            sampled_images: limits.max_per_stage_descriptor_sampled_images,
            storage_images: limits.max_per_stage_descriptor_storage_images,
            samplers: limits.max_per_stage_descriptor_samplers,
            all: limits.max_per_stage_resources,
        },
        uniform_bytes: limits.max_uniform_buffer_range,
        storage_bytes: limits.max_storage_buffer_range,
        timestamp_period_ns: limits.timestamp_period,
        timestamp_bits,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn device(name: &str, kind: DeviceKind, unusable: Option<&str>) -> Candidate {
        let info = DeviceInfo {
            name: name.to_owned(),
            kind,
            driver: String::new(),
            driver_version: String::new(),
            vulkan_version: [1, 3, 0],
            limits: limits(&vk::PhysicalDeviceLimits::default(), 0),
        };
        let unusable = unusable.map(str::to_owned);
        let raw = vk::PhysicalDevice::null();
        Candidate { raw, info, queue_family: 0, extended_storage_formats: true, pipeline_cache_id: [0; 16], unusable }
    }

    fn machine() -> Vec<Candidate> {
        vec![
            device("llvmpipe", DeviceKind::Cpu, None),
            device("Old Card", DeviceKind::DiscreteGpu, Some("it serves Vulkan 1.1")),
            device("Laptop GPU", DeviceKind::IntegratedGpu, None),
            device("New Card", DeviceKind::DiscreteGpu, None),
        ]
    }

    fn chosen(devices: Vec<Candidate>, requested: Option<&str>) -> Result<String, GpuError> {
        select(devices, requested).map(|candidate| candidate.info.name)
    }

    #[test]
    fn the_best_usable_device_is_taken_unless_another_is_asked_for() {
        assert_eq!(chosen(machine(), None).unwrap(), "New Card");
        assert_eq!(chosen(machine(), Some("laptop")).unwrap(), "Laptop GPU");
        assert_eq!(chosen(machine(), Some("0")).unwrap(), "llvmpipe");
    }

    #[test]
    fn a_device_that_is_not_there_is_an_error_that_lists_those_that_are() {
        for requested in ["voodoo", "4", ""] {
            let error = chosen(machine(), Some(requested)).unwrap_err();
            assert!(!error.is_no_usable_device(), "the machine has devices; the request is wrong");
            let text = error.to_string();
            assert!(text.contains("0: llvmpipe; 1: Old Card; 2: Laptop GPU; 3: New Card"), "{text}");
        }
    }

    #[test]
    fn without_a_usable_device_the_error_says_what_to_install() {
        let old = || vec![device("Old Card", DeviceKind::DiscreteGpu, Some("it serves Vulkan 1.1"))];
        for error in [chosen(vec![], None).unwrap_err(), chosen(old(), None).unwrap_err()] {
            assert!(error.is_no_usable_device());
            assert!(error.to_string().contains("libvulkan1 mesa-vulkan-drivers"), "{error}");
        }
        let error = chosen(old(), Some("old")).unwrap_err();
        assert!(error.is_no_usable_device() && error.to_string().contains("Vulkan 1.1"), "{error}");
    }
}
