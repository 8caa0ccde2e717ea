//! The Vulkan loader and instance.

use std::ffi::{CStr, c_char};

#[cfg(feature = "window")]
use std::sync::Arc;

use ash::{ext, vk};

use super::error::{During, GpuError};
#[cfg(feature = "window")]
use super::surface::{Surface, Window};
use super::validation::{LAYER, Validation, ValidationLog};

/// A Vulkan instance with its messenger; destroys both, but for a host's.
pub(crate) struct Instance {
    pub(crate) raw: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Whether labels and names can be given.
    pub(crate) debug_utils: bool,
    /// Kept for the messenger, which points into it.
    pub(crate) log: ValidationLog,
    /// Where pictures are shown, if anywhere.
    #[cfg(feature = "window")]
    pub(crate) surface: Option<Surface>,
    /// Keeps the loader's library open; none for a host's instance.
    pub(crate) entry: Option<ash::Entry>,
}

impl Instance {
    /// Loads Vulkan and makes an instance.
    pub(crate) fn new(validation: Validation) -> Result<Self, GpuError> {
        Self::with_extensions(validation, &[])
    }

    /// The same for pictures in a window.
    #[cfg(feature = "window")]
    pub(crate) fn with_window(validation: Validation, window: Arc<dyn Window>) -> Result<Self, GpuError> {
        let mut instance = Self::with_extensions(validation, Surface::extensions(window.as_ref())?)?;
        if let Some(entry) = &instance.entry {
            instance.surface = Some(Surface::new(entry, &instance.raw, window)?);
        }
        Ok(instance)
    }

    /// One that a host has made, keeps alive and destroys. `debug_utils`: whether it has `VK_EXT_debug_utils`.
    pub(crate) fn of_host(raw: ash::Instance, debug_utils: bool) -> Self {
        Self {
            raw,
            messenger: None,
            debug_utils,
            log: ValidationLog::default(),
            #[cfg(feature = "window")]
            surface: None,
            entry: None,
        }
    }

    /// Whether pictures are shown.
    pub(crate) fn has_window(&self) -> bool {
        #[cfg(feature = "window")]
        return self.surface.is_some();
        #[cfg(not(feature = "window"))]
        return false;
    }

    /// Whether a queue family of a device can show pictures, where any are to be shown.
    pub(crate) fn can_show(&self, _device: vk::PhysicalDevice, _family: u32) -> bool {
        #[cfg(feature = "window")]
        return self.surface.as_ref().is_none_or(|surface| surface.is_served_by(_device, _family));
        #[cfg(not(feature = "window"))]
        return true;
    }

    fn with_extensions(validation: Validation, needed: &'static [*const c_char]) -> Result<Self, GpuError> {
        // SAFETY: the loader of the system is a Vulkan loader.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| GpuError::NoLoader(error.to_string()))?;
        let layer_version = match validation {
            Validation::Off => None,
            Validation::On => Some(layer_version(&entry)?.ok_or(GpuError::NoValidationLayer)?),
        };
        let validate = layer_version.is_some();
        let debug_utils = has_extension(&entry, None, ext::debug_utils::NAME)?;
        let features = validate && has_extension(&entry, Some(LAYER), ext::validation_features::NAME)?;
        let settings = layer_version.is_some_and(|version| version >= SHADER_ACCESSES_VERSION)
            && has_extension(&entry, Some(LAYER), ext::layer_settings::NAME)?;
        let log = ValidationLog::default();
        let colour_spaces = !needed.is_empty() && has_extension(&entry, None, ext::swapchain_colorspace::NAME)?;
        let extras = Extras { validate, debug_utils, features, settings, colour_spaces, needed };
        let raw = create(&entry, extras, &log)?;
        let mut instance = Self {
            raw,
            messenger: None,
            debug_utils,
            log,
            #[cfg(feature = "window")]
            surface: None,
            entry: None,
        };
        let entry = instance.entry.insert(entry);
        if validate && debug_utils {
            let functions = ext::debug_utils::Instance::new(entry, &instance.raw);
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
        #[cfg(feature = "window")]
        if let Some(surface) = &self.surface {
            surface.destroy();
        }
        // SAFETY: devices are gone; nothing uses the messenger or the instance any more.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            if self.entry.is_some() {
                self.raw.destroy_instance(None);
            }
        }
    }
}

/// From this version on, the layer leaves the accesses of shaders out of its synchronisation checks unless asked.
const SHADER_ACCESSES_VERSION: u32 = vk::make_api_version(0, 1, 4, 304);

/// What is turned on besides Vulkan itself.
struct Extras {
    validate: bool,
    debug_utils: bool,
    /// The layer's synchronisation checks.
    features: bool,
    /// The layer's settings.
    settings: bool,
    /// Windows tell of more than sRGB.
    colour_spaces: bool,
    /// Extensions that must be there.
    needed: &'static [*const c_char],
}

fn create(entry: &ash::Entry, extras: Extras, log: &ValidationLog) -> Result<ash::Instance, GpuError> {
    let Extras { validate, debug_utils, features, settings, colour_spaces, needed } = extras;
    let application = vk::ApplicationInfo::default().application_name(c"welkin").api_version(vk::API_VERSION_1_3);
    let layers: &[*const c_char] = if validate { &[LAYER.as_ptr()] } else { &[] };
    let mut extensions = needed.to_vec();
    extensions.extend(debug_utils.then_some(ext::debug_utils::NAME.as_ptr()));
    extensions.extend(features.then_some(ext::validation_features::NAME.as_ptr()));
    extensions.extend(settings.then_some(ext::layer_settings::NAME.as_ptr()));
    extensions.extend(colour_spaces.then_some(ext::swapchain_colorspace::NAME.as_ptr()));
    let synchronisation = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut checks = vk::ValidationFeaturesEXT::default().enabled_validation_features(&synchronisation);
    let yes = vk::TRUE.to_ne_bytes();
    let mut shader_accesses = vk::LayerSettingEXT::default()
        .layer_name(LAYER)
        .setting_name(c"syncval_shader_accesses_heuristic")
        .ty(vk::LayerSettingTypeEXT::BOOL32)
        .values(&yes);
    // ash counts bytes here; Vulkan counts values.
    shader_accesses.value_count = 1;
    let shader_accesses = [shader_accesses];
    let mut layer_settings = vk::LayerSettingsCreateInfoEXT::default().settings(&shader_accesses);
    // A messenger in the chain hears of the instance's own creation and destruction.
    let mut messenger = log.messenger();
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_layer_names(layers)
        .enabled_extension_names(&extensions);
    if features {
        info = info.push_next(&mut checks);
    }
    if settings {
        info = info.push_next(&mut layer_settings);
    }
    if validate && debug_utils {
        info = info.push_next(&mut messenger);
    }
    // SAFETY: layers and extensions are there; the chain lives as long as the call, and the log as the instance.
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => GpuError::NoDevice,
        vk::Result::ERROR_EXTENSION_NOT_PRESENT => {
            GpuError::NoSurface("no driver of this machine draws in windows of this kind".to_owned())
        }
        result => GpuError::Vulkan { call: "vkCreateInstance", result },
    })
}

/// The Vulkan version that the validation layer was made for, if it is installed.
fn layer_version(entry: &ash::Entry) -> Result<Option<u32>, GpuError> {
    // SAFETY: the entry is loaded.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.during("vkEnumerateInstanceLayerProperties")?;
    let layer = layers.iter().find(|layer| layer.layer_name_as_c_str() == Ok(LAYER));
    Ok(layer.map(|layer| layer.spec_version))
}

fn has_extension(entry: &ash::Entry, layer: Option<&CStr>, name: &CStr) -> Result<bool, GpuError> {
    // SAFETY: the entry is loaded, and the layer, if any, is there.
    let extensions = unsafe { entry.enumerate_instance_extension_properties(layer) };
    let extensions = extensions.during("vkEnumerateInstanceExtensionProperties")?;
    Ok(extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name)))
}
