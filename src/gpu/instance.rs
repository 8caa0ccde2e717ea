//! The Vulkan loader and instance.

use std::ffi::{CStr, c_char};

use ash::{ext, vk};

use super::error::{During, GpuError};
use super::validation::{LAYER, Validation, ValidationLog};

/// A Vulkan instance with its messenger; destroys both.
pub(crate) struct Instance {
    pub(crate) raw: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Whether labels and names can be given.
    pub(crate) debug_utils: bool,
    /// Kept for the messenger, which points into it.
    pub(crate) log: ValidationLog,
    /// Keeps the loader's library open.
    _entry: ash::Entry,
}

impl Instance {
    /// Loads Vulkan and makes an instance.
    pub(crate) fn new(validation: Validation) -> Result<Self, GpuError> {
        // SAFETY: the loader of the system is a Vulkan loader.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| GpuError::NoLoader(error.to_string()))?;
        let validate = validation == Validation::On;
        if validate && !has_layer(&entry)? {
            return Err(GpuError::NoValidationLayer);
        }
        let debug_utils = has_extension(&entry, None, ext::debug_utils::NAME)?;
        let features = validate && has_extension(&entry, Some(LAYER), ext::validation_features::NAME)?;
        let log = ValidationLog::default();
        let raw = create(&entry, validate, debug_utils, features, &log)?;
        let mut instance = Self { raw, messenger: None, debug_utils, log, _entry: entry };
        if validate && debug_utils {
            let functions = ext::debug_utils::Instance::new(&instance._entry, &instance.raw);
            // SAFETY: the log lives as long as the instance.
            let messenger = unsafe { functions.create_debug_utils_messenger(&instance.log.messenger(), None) }
                .during("vkCreateDebugUtilsMessengerEXT")?;
            instance.messenger = Some((functions, messenger));
        }
        Ok(instance)
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: devices are gone; nothing uses the messenger or the instance any more.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

fn create(
    entry: &ash::Entry,
    validate: bool,
    debug_utils: bool,
    features: bool,
    log: &ValidationLog,
) -> Result<ash::Instance, GpuError> {
    let application = vk::ApplicationInfo::default().application_name(c"welkin").api_version(vk::API_VERSION_1_3);
    let layers: &[*const c_char] = if validate { &[LAYER.as_ptr()] } else { &[] };
    let mut extensions = Vec::new();
    extensions.extend(debug_utils.then_some(ext::debug_utils::NAME.as_ptr()));
    extensions.extend(features.then_some(ext::validation_features::NAME.as_ptr()));
    let synchronisation = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut checks = vk::ValidationFeaturesEXT::default().enabled_validation_features(&synchronisation);
    // A messenger in the chain hears of the instance's own creation and destruction.
    let mut messenger = log.messenger();
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_layer_names(layers)
        .enabled_extension_names(&extensions);
    if features {
        info = info.push_next(&mut checks);
    }
    if validate && debug_utils {
        info = info.push_next(&mut messenger);
    }
    // SAFETY: layers and extensions are there; the chain lives as long as the call, and the log as the instance.
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => GpuError::NoDevice,
        result => GpuError::Vulkan { call: "vkCreateInstance", result },
    })
}

fn has_layer(entry: &ash::Entry) -> Result<bool, GpuError> {
    // SAFETY: the entry is loaded.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.during("vkEnumerateInstanceLayerProperties")?;
    Ok(layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(LAYER)))
}

fn has_extension(entry: &ash::Entry, layer: Option<&CStr>, name: &CStr) -> Result<bool, GpuError> {
    // SAFETY: the entry is loaded, and the layer, if any, is there.
    let extensions = unsafe { entry.enumerate_instance_extension_properties(layer) };
    let extensions = extensions.during("vkEnumerateInstanceExtensionProperties")?;
    Ok(extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name)))
}
