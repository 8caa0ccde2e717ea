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
