//! Where pictures appear: the surface of a window.

use std::ffi::c_char;
use std::sync::{Arc, Mutex};

use ash::{khr, vk};
use raw_window_handle::{HandleError, HasDisplayHandle, HasWindowHandle};

use super::context::{Context, lock};
use super::device;
use super::error::{During, GpuError};
use super::instance::Instance;
use super::{DeviceRequest, Gpu};

/// A window of any library, which must live as long as its surface.
pub trait Window: HasDisplayHandle + HasWindowHandle + Send + Sync {}

impl<T: HasDisplayHandle + HasWindowHandle + Send + Sync> Window for T {}

/// A window's surface, and what makes it anew when it is lost.
pub(crate) struct Surface {
    functions: khr::surface::Instance,
    raw: Mutex<vk::SurfaceKHR>,
    window: Arc<dyn Window>,
}

impl Surface {
    /// Extensions that the instance must have for a window.
    pub(crate) fn extensions(window: &dyn Window) -> Result<&'static [*const c_char], GpuError> {
        let display = window.display_handle().map_err(no_window)?.as_raw();
        ash_window::enumerate_required_extensions(display).during("vkEnumerateInstanceExtensionProperties")
    }

    pub(crate) fn new(entry: &ash::Entry, instance: &ash::Instance, window: Arc<dyn Window>) -> Result<Self, GpuError> {
        let raw = create(entry, instance, window.as_ref())?;
        Ok(Self { functions: khr::surface::Instance::new(entry, instance), raw: Mutex::new(raw), window })
    }

    pub(crate) fn raw(&self) -> vk::SurfaceKHR {
        *lock(&self.raw)
    }

    /// Whether a queue family can show pictures on it.
    pub(crate) fn is_served_by(&self, device: vk::PhysicalDevice, family: u32) -> bool {
        // SAFETY: device and surface are of one instance, and the family is one of the device's.
        unsafe { self.functions.get_physical_device_surface_support(device, family, self.raw()) }.unwrap_or(false)
    }

    pub(crate) fn capabilities(&self, device: vk::PhysicalDevice) -> Result<vk::SurfaceCapabilitiesKHR, vk::Result> {
        // SAFETY: device and surface are of one instance.
        unsafe { self.functions.get_physical_device_surface_capabilities(device, self.raw()) }
    }

    pub(crate) fn formats(&self, device: vk::PhysicalDevice) -> Result<Vec<vk::SurfaceFormatKHR>, vk::Result> {
        // SAFETY: device and surface are of one instance.
        unsafe { self.functions.get_physical_device_surface_formats(device, self.raw()) }
    }

    /// Takes the place of a surface that is lost. Its swapchain must be gone.
    pub(crate) fn renew(&self, instance: &Instance) -> Result<(), GpuError> {
        self.destroy();
        let Some(entry) = &instance.entry else { return Ok(()) };
        *lock(&self.raw) = create(entry, &instance.raw, self.window.as_ref())?;
        Ok(())
    }

    /// Before the instance goes.
    pub(crate) fn destroy(&self) {
        let raw = std::mem::replace(&mut *lock(&self.raw), vk::SurfaceKHR::null());
        // SAFETY: no swapchain is left; null is ignored.
        unsafe { self.functions.destroy_surface(raw, None) };
    }
}

fn create(entry: &ash::Entry, instance: &ash::Instance, window: &dyn Window) -> Result<vk::SurfaceKHR, GpuError> {
    let display = window.display_handle().map_err(no_window)?.as_raw();
    let handle = window.window_handle().map_err(no_window)?.as_raw();
    // SAFETY: the instance has the extensions, and keeps the window longer than the surface.
    unsafe { ash_window::create_surface(entry, instance, display, handle, None) }.during("vkCreateSurfaceKHR")
}

fn no_window(error: HandleError) -> GpuError {
    GpuError::NoSurface(error.to_string())
}

impl Gpu {
    /// Opens a device that can show pictures in a window; otherwise as [`Gpu::new`].
    ///
    /// # Errors
    /// As [`Gpu::new`]; [`GpuError::NoSurface`] where Vulkan cannot draw in that window.
    pub fn for_window(request: &DeviceRequest, window: Arc<dyn Window>) -> Result<Self, GpuError> {
        let instance = Instance::with_window(request.validation, window)?;
        let candidate = device::choose(&instance, request.device.as_deref())?;
        tracing::info!("device: {} ({})", candidate.info.name, candidate.info.driver);
        Ok(Self(Arc::new(Context::new(instance, candidate, request.pipeline_cache.as_deref())?)))
    }
}
