//! The Khronos validation layer and what it says.

use std::ffi::{CStr, c_void};
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

/// Name of the layer.
pub(crate) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Whether the validation layer watches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Validation {
    /// No layer.
    #[default]
    Off,
    /// The layer with its synchronisation checks; an error where it is not installed.
    On,
}

/// One warning or error of the validation layer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ValidationMessage {
    /// Whether the layer calls it an error rather than a warning.
    pub is_error: bool,
    /// The rule's name, such as `VUID-VkBufferCreateInfo-size-00912`.
    pub rule: String,
    /// The layer's text.
    pub text: String,
}

impl fmt::Display for ValidationMessage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = if self.is_error { "error" } else { "warning" };
        write!(formatter, "validation {severity} {}: {}", self.rule, self.text)
    }
}

/// All messages so far. Clones share one list, which outlives the device: it also holds what the layer says when the
/// device is destroyed, such as leaks.
#[derive(Debug, Clone, Default)]
pub struct ValidationLog(Arc<Mutex<Vec<ValidationMessage>>>);

impl ValidationLog {
    /// The messages, oldest first.
    pub fn messages(&self) -> Vec<ValidationMessage> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn push(&self, message: ValidationMessage) {
        tracing::warn!("{message}");
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    }

    /// A messenger that adds to this list. The list must outlive it.
    pub(crate) fn messenger(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::WARNING | Severity::ERROR)
            .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
            .pfn_user_callback(Some(receive))
            .user_data(Arc::as_ptr(&self.0).cast_mut().cast())
    }
}

/// # Safety
/// Vulkan passes valid data, and `log` is what [`ValidationLog::messenger`] set.
unsafe extern "system" fn receive(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    log: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the pointer came from an Arc that the instance keeps; one more count for the time of this call.
    let log = unsafe {
        let list = log.cast_const().cast::<Mutex<Vec<ValidationMessage>>>();
        Arc::increment_strong_count(list);
        ValidationLog(Arc::from_raw(list))
    };
    // SAFETY: valid for the time of this call; both strings may be null.
    let (rule, text) = unsafe { (text((*data).p_message_id_name), text((*data).p_message)) };
    let is_error = severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR);
    log.push(ValidationMessage { is_error, rule, text });
    vk::FALSE
}

/// # Safety
/// Null, or a string that ends in zero.
unsafe fn text(pointer: *const std::ffi::c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: as the caller promises.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use ash::vk;

    use super::*;
    use crate::gpu::{DeviceRequest, Gpu, Resource, Work};

    /// What the layer says of calls that bypass the engine's own checks, until the device is closed.
    fn messages_of(wrong: impl FnOnce(&Gpu)) -> Vec<ValidationMessage> {
        let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
        let gpu = Gpu::new(&request).unwrap_or_else(|error| panic!("{error}"));
        let log = gpu.validation_log();
        wrong(&gpu);
        drop(gpu);
        log.messages()
    }

    fn storage_buffer(gpu: &Gpu, bytes: u64) -> Result<vk::Buffer, vk::Result> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        // SAFETY: the layer is told of what is wrong; lavapipe and other drivers survive it.
        unsafe { gpu.0.device.create_buffer(&info, None) }
    }

    #[test]
    fn a_correct_use_gives_no_message_and_a_wrong_one_gives_its_rule() {
        assert_eq!(messages_of(|_| ()), []);
        let messages = messages_of(|gpu| {
            if let Ok(buffer) = storage_buffer(gpu, 0) {
                // SAFETY: the buffer is new.
                unsafe { gpu.0.device.destroy_buffer(buffer, None) };
            }
        });
        let rules: Vec<_> = messages.iter().map(|message| message.rule.as_str()).collect();
        assert_eq!(rules, ["VUID-VkBufferCreateInfo-size-00912"]);
        assert!(messages[0].is_error);
    }

    #[test]
    fn what_is_not_destroyed_is_reported_when_the_device_is_closed() {
        let messages = messages_of(|gpu| {
            storage_buffer(gpu, 64).unwrap();
        });
        assert!(messages.iter().any(|message| message.rule.contains("vkDestroyDevice")), "{messages:?}");
    }

    // The layer of Debian 12 (1.3.239) takes a dispatch's writes for reads, so that it cannot see two dispatches that
    // write one resource; `barrier.rs` holds those apart. It does see a dispatch that does not wait for a copy.
    #[test]
    fn a_dispatch_that_does_not_wait_for_a_copy_is_a_hazard() {
        const WRITE: &str = "@group(0) @binding(0) var<storage, read_write> values: array<u32, 64>;
            @compute @workgroup_size(64) fn main(@builtin(local_invocation_index) i: u32) { values[i] += 1u; }";
        let sources = welkin_shaders::Sources::default().with("add.wgsl", WRITE);
        let shader = welkin_shaders::Shader::from_sources(&sources, "add", &Default::default()).unwrap();
        let messages_with = |unordered_copy: bool| {
            messages_of(|gpu| {
                let pipeline = gpu.pipeline(&shader).unwrap();
                let buffer = gpu.storage_buffer("target", 256).unwrap();
                let mut commands = gpu.record("hazard").unwrap();
                if unordered_copy {
                    // SAFETY: the buffer lives until the list is done; the hazard is what is tested.
                    unsafe { gpu.0.device.cmd_fill_buffer(commands.list.raw, buffer.0.raw, 0, 256, 1) };
                }
                for _ in 0..2 {
                    let resources = [("values", Resource::Buffer(&buffer))];
                    commands.dispatch(&pipeline, &resources, Work::Workgroups([1, 1, 1])).unwrap();
                }
                commands.submit_and_wait().unwrap();
            })
        };
        assert_eq!(messages_with(false), []);
        let messages = messages_with(true);
        assert!(messages.iter().any(|message| message.rule.starts_with("SYNC-HAZARD")), "{messages:?}");
    }
}
