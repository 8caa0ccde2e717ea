//! Compute on Vulkan 1.3: device, memory, images, pipelines, barriers, timers, readback.
//!
//! A [`Gpu`] makes images, buffers, samplers and pipelines. [`Gpu::record`] starts a list of dispatches, which bind
//! resources by the names of the WGSL's variables; the barriers between them follow from what the passes declare.
//! With the feature `window`, a `Presenter` shows images in a window. A [`HostDevice`] is one that an engine owns.
//! Knows nothing of what is computed.

mod barrier;
mod buffer;
mod census;
mod command_list;
mod context;
mod descriptors;
mod device;
mod error;
mod format;
mod heap;
mod host;
mod image;
mod instance;
mod pace;
mod pending;
mod pipeline;
mod pipeline_cache;
#[cfg(feature = "window")]
mod presenter;
mod recorder;
mod resource;
mod sampler;
#[cfg(feature = "window")]
mod surface;
#[cfg(feature = "window")]
mod swapchain;
mod timer;
mod transfer;
mod validation;

use std::sync::Arc;

use bytemuck::{AnyBitPattern, NoUninit};
use welkin_shaders::{ParameterBuffers, Shader};

pub use buffer::{BufferKind, GpuBuffer};
pub use census::Population;
pub use device::{DeviceInfo, DeviceKind, DeviceRequest, Limits, ResourceLimits};
pub use error::GpuError;
pub use format::{Filtering, ImageFormat, ScreenEncoding};
pub use heap::give_back_freed_memory;
pub use host::{HOST_EXTENSIONS, HostCommands, HostDevice, HostFeatures, HostImage, HostRecorded, HostUse};
pub use image::{GpuImage, ImageShape, NextUse};
pub use pace::Pace;
pub use pending::PendingImage;
pub use pipeline::{MAX_UNIFORM_BUFFERS, Pipeline};
#[cfg(feature = "window")]
pub use presenter::{FRAMES_IN_FLIGHT, OverlayTarget, Placed, Presenter, RawDevice};
pub use recorder::{Commands, Completed, Work};
pub use resource::Resource;
pub use sampler::{AddressMode, Filter, Sampler};
#[cfg(feature = "window")]
pub use surface::Window;
pub use timer::{Clock, DispatchTime};
pub use validation::{Validation, ValidationLog, ValidationMessage};

use buffer::BufferInner;
use context::Context;
use image::ImageInner;
use instance::Instance;
use pipeline::PipelineInner;
use sampler::SamplerInner;

/// An open device. Clones are the same device; it is closed when they and all its resources are gone.
#[derive(Clone)]
pub struct Gpu(Arc<Context>);

impl Gpu {
    /// Opens a device: the one that is asked for, else the best GPU, else a driver that computes on the CPU.
    ///
    /// # Errors
    /// When there is no loader, no device, no such device, none with Vulkan 1.3, or no validation layer where one is
    /// asked for. [`GpuError::is_no_usable_device`] tells those that installing a driver mends.
    pub fn new(request: &DeviceRequest) -> Result<Self, GpuError> {
        let instance = Instance::new(request.validation)?;
        let candidate = device::choose(&instance, request.device.as_deref())?;
        let info = &candidate.info;
        tracing::info!("device: {} ({} {})", info.name, info.driver, info.driver_version);
        if request.device.is_none() && !matches!(info.kind, DeviceKind::DiscreteGpu | DeviceKind::IntegratedGpu) {
            tracing::info!("no GPU found: {} computes on the CPU", info.name);
        }
        let mut context = Context::new(instance, candidate, request.pipeline_cache.as_deref())?;
        context.poisons = request.poisons_memory || request.validation == Validation::On;
        Ok(Self(Arc::new(context)))
    }

    /// What the device says of itself.
    pub fn info(&self) -> &DeviceInfo {
        &self.0.info
    }

    /// The messages of the validation layer so far and from now on; empty without the layer.
    pub fn validation_log(&self) -> ValidationLog {
        self.0.instance.log.clone()
    }

    /// Where shaders should look for their parameters.
    ///
    /// lavapipe writes what lies in uniform buffers into the code where branches and loops depend on it, so that a dispatch
    /// with new parameters is compiled anew, and Mesa 22 never gives the code of earlier ones back: half a megabyte each
    /// time. Storage buffers it leaves alone, and dispatches take no longer with them.
    pub fn parameter_buffers(&self) -> ParameterBuffers {
        match self.info().kind {
            DeviceKind::Cpu => ParameterBuffers::Storage,
            _ => ParameterBuffers::Uniform,
        }
    }

    /// What is alive on the device at the moment.
    pub fn population(&self) -> Population {
        self.0.population()
    }

    /// How the device samples a format.
    pub fn filtering(&self, format: ImageFormat) -> Filtering {
        let linear = ash::vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
        let features = image::format_features(&self.0, format);
        if features.contains(linear) { Filtering::Linear } else { Filtering::NearestOnly }
    }

    /// An image that holds nothing yet.
    ///
    /// # Errors
    /// When shape or format are beyond the device, or memory is short.
    pub fn image(&self, name: &str, shape: ImageShape, format: ImageFormat) -> Result<GpuImage, GpuError> {
        ImageInner::new(&self.0, name, shape, format).map(|inner| GpuImage(Arc::new(inner)))
    }

    /// A storage buffer that holds nothing yet.
    ///
    /// # Errors
    /// When it is empty, beyond the device, or memory is short.
    pub fn storage_buffer(&self, name: &str, bytes: u64) -> Result<GpuBuffer, GpuError> {
        self.buffer(name, BufferKind::Storage, bytes)
    }

    /// A storage buffer with content.
    ///
    /// # Errors
    /// As [`Gpu::storage_buffer`]; [`GpuError::Recording`].
    pub fn storage_buffer_of<T: NoUninit>(&self, name: &str, content: &[T]) -> Result<GpuBuffer, GpuError> {
        let buffer = self.storage_buffer(name, size_of_val(content) as u64)?;
        self.write_buffer(&buffer, content)?;
        Ok(buffer)
    }

    /// A uniform buffer with content, whose layout must be the WGSL struct's.
    ///
    /// # Errors
    /// When it is empty, beyond the device, or memory is short; [`GpuError::Recording`].
    pub fn uniform_buffer<T: NoUninit>(&self, name: &str, content: &T) -> Result<GpuBuffer, GpuError> {
        let buffer = self.buffer(name, BufferKind::Uniform, size_of::<T>() as u64)?;
        self.write_buffer(&buffer, std::slice::from_ref(content))?;
        Ok(buffer)
    }

    fn buffer(&self, name: &str, kind: BufferKind, bytes: u64) -> Result<GpuBuffer, GpuError> {
        BufferInner::new(&self.0, name, kind, bytes).map(|inner| GpuBuffer(Arc::new(inner)))
    }

    /// A sampler; `address` is for u, v and w.
    ///
    /// # Errors
    /// When the device cannot make one.
    pub fn sampler(&self, filter: Filter, address: [AddressMode; 3]) -> Result<Sampler, GpuError> {
        SamplerInner::new(&self.0, filter, address).map(|inner| Sampler(Arc::new(inner)))
    }

    /// A pipeline for a compiled pass.
    ///
    /// # Errors
    /// When the pass needs more than the device or [`MAX_UNIFORM_BUFFERS`] allow.
    pub fn pipeline(&self, shader: &Shader) -> Result<Pipeline, GpuError> {
        if !shader.is_trusted() {
            let reason = "another compiler has made it; see `Gpu::foreign_pipeline`".to_owned();
            return Err(GpuError::Pipeline { pass: shader.name.clone(), reason });
        }
        PipelineInner::new(&self.0, shader).map(|inner| Pipeline(Arc::new(inner)))
    }

    /// A pipeline for a shader that another compiler has made ([`Shader::foreign`]).
    ///
    /// # Errors
    /// As [`Gpu::pipeline`].
    ///
    /// # Safety
    /// The SPIR-V is valid for Vulkan 1.3, has a compute entry point `main` of this workgroup size and uses just these
    /// bindings.
    pub unsafe fn foreign_pipeline(&self, shader: &Shader) -> Result<Pipeline, GpuError> {
        PipelineInner::new(&self.0, shader).map(|inner| Pipeline(Arc::new(inner)))
    }

    /// Starts a list of dispatches. Until it is submitted or dropped, nothing else may be recorded, written or read.
    ///
    /// # Errors
    /// [`GpuError::Recording`] when another list is open.
    pub fn record(&self, label: &str) -> Result<Commands, GpuError> {
        Commands::new(&self.0, label, None, None)
    }

    /// As [`Gpu::record`], and each dispatch's time is taken with the best clock ([`Clock::of`]).
    ///
    /// # Errors
    /// As [`Gpu::record`].
    pub fn record_timed(&self, label: &str) -> Result<Commands, GpuError> {
        self.record_timed_by(label, Clock::of(self.info()))
    }

    /// As [`Gpu::record_timed`], with a certain clock. With the host's, each dispatch is run by itself, at once, and
    /// its time includes the submission.
    ///
    /// # Errors
    /// As [`Gpu::record`]; [`GpuError::NoTimestamps`].
    pub fn record_timed_by(&self, label: &str, clock: Clock) -> Result<Commands, GpuError> {
        if clock == Clock::Timestamps && Clock::of(self.info()) != clock {
            return Err(GpuError::NoTimestamps { device: self.info().name.clone() });
        }
        Commands::new(&self.0, label, Some(clock), None)
    }

    /// As [`Gpu::record_timed`], in pieces short enough that others who share the queue hardly wait: see [`Pace`].
    ///
    /// # Errors
    /// As [`Gpu::record`].
    pub fn record_paced(&self, label: &str, pace: &Pace) -> Result<Commands, GpuError> {
        // A driver that computes on the CPU stamps a dispatch when it is taken up, not when it is done.
        let clock = if self.info().kind == DeviceKind::Cpu { Clock::Host } else { Clock::of(self.info()) };
        Commands::new(&self.0, label, Some(clock), Some(pace.clone()))
    }

    /// Fills an image with texels in rows from the first, then slices or layers.
    ///
    /// # Errors
    /// [`GpuError::Size`] unless the elements have as many bytes as the image; [`GpuError::Recording`].
    pub fn write_image<T: NoUninit>(&self, image: &GpuImage, texels: &[T]) -> Result<(), GpuError> {
        transfer::write_image(&self.0, image, bytemuck::cast_slice(texels))
    }

    /// An image's texels, in rows from the first, then slices or layers.
    ///
    /// # Errors
    /// [`GpuError::Size`] unless the image has a whole number of elements; [`GpuError::Recording`];
    /// [`GpuError::Resource`] when nothing has been written to it.
    pub fn read_image<T: AnyBitPattern + NoUninit>(&self, image: &GpuImage) -> Result<Vec<T>, GpuError> {
        // Before the device copies what then does not fit.
        element_count::<T>(image.name(), image.bytes())?;
        self.start_reading_image(image)?.wait()
    }

    /// The same without waiting: the texels as all that has been submitted so far leaves them.
    ///
    /// # Errors
    /// [`GpuError::Recording`]; [`GpuError::Resource`] when nothing has been written to it.
    pub fn start_reading_image(&self, image: &GpuImage) -> Result<PendingImage, GpuError> {
        PendingImage::new(&self.0, image)
    }

    /// Replaces a buffer's whole content.
    ///
    /// # Errors
    /// [`GpuError::Size`] unless the elements have as many bytes as the buffer; [`GpuError::Recording`].
    pub fn write_buffer<T: NoUninit>(&self, buffer: &GpuBuffer, content: &[T]) -> Result<(), GpuError> {
        transfer::write_buffer(&self.0, buffer, bytemuck::cast_slice(content))
    }

    /// A buffer's whole content.
    ///
    /// # Errors
    /// As [`Gpu::read_image`].
    pub fn read_buffer<T: AnyBitPattern + NoUninit>(&self, buffer: &GpuBuffer) -> Result<Vec<T>, GpuError> {
        let mut content = elements::<T>(buffer.name(), buffer.bytes())?;
        transfer::read_buffer(&self.0, buffer, bytemuck::cast_slice_mut(&mut content))?;
        Ok(content)
    }
}

/// As many zeroed elements as fill so many bytes.
fn elements<T: AnyBitPattern>(name: &str, bytes: u64) -> Result<Vec<T>, GpuError> {
    Ok(vec![T::zeroed(); element_count::<T>(name, bytes)?])
}

/// How many elements fill so many bytes.
fn element_count<T>(name: &str, bytes: u64) -> Result<usize, GpuError> {
    let size = size_of::<T>() as u64;
    if size == 0 || !bytes.is_multiple_of(size) {
        return Err(GpuError::Size { name: name.to_owned(), expected: bytes, found: size });
    }
    Ok((bytes / size) as usize)
}
