//! Buffers in device memory.

use std::sync::{Arc, Mutex};

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;

use super::barrier::State;
use super::census::{Counted, Kind};
use super::context::{Context, lock};
use super::error::{During, GpuError};

/// What a buffer is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BufferKind {
    /// Small and read by shaders; the host writes it directly.
    Uniform,
    /// Read and written by shaders, in the device's own memory.
    Storage,
}

/// A uniform or storage buffer. Clones are the same buffer.
#[derive(Clone)]
pub struct GpuBuffer(pub(crate) Arc<BufferInner>);

impl GpuBuffer {
    /// Its name in messages.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// Its size in bytes.
    pub fn bytes(&self) -> u64 {
        self.0.bytes
    }

    /// What it is for.
    pub fn kind(&self) -> BufferKind {
        self.0.kind
    }
}

pub(crate) struct BufferInner {
    context: Arc<Context>,
    pub(crate) name: String,
    pub(crate) bytes: u64,
    pub(crate) kind: BufferKind,
    pub(crate) raw: vk::Buffer,
    /// `None` only while the buffer is made and destroyed; the lock is for writes by the host.
    allocation: Mutex<Option<Allocation>>,
    /// After all that has been submitted.
    pub(crate) state: Mutex<State>,
    _counted: Counted,
}

impl BufferInner {
    /// A uniform or storage buffer, which holds nothing yet.
    pub(crate) fn new(context: &Arc<Context>, name: &str, kind: BufferKind, bytes: u64) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let limits = &context.info.limits;
        let (usage, location, limit) = match kind {
            // Parameters may be read as either kind: see `Gpu::parameter_buffers`.
            BufferKind::Uniform => {
                (Usage::UNIFORM_BUFFER | Usage::STORAGE_BUFFER, MemoryLocation::CpuToGpu, limits.uniform_bytes)
            }
            BufferKind::Storage => (
                Usage::STORAGE_BUFFER | Usage::INDIRECT_BUFFER | Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
                MemoryLocation::GpuOnly,
                limits.storage_bytes,
            ),
        };
        if bytes == 0 || bytes > u64::from(limit) {
            let reason = format!("a buffer of {bytes} bytes; {kind:?} buffers must have 1..={limit} bytes");
            return Err(GpuError::Resource { name: name.to_owned(), reason });
        }
        Self::with_usage(context, name, kind, bytes, usage, location)
    }

    /// A buffer for copies between the host and the device.
    pub(crate) fn staging(context: &Arc<Context>, name: &str, bytes: u64, upload: bool) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let (usage, location) = match upload {
            true => (Usage::TRANSFER_SRC, MemoryLocation::CpuToGpu),
            false => (Usage::TRANSFER_DST, MemoryLocation::GpuToCpu),
        };
        Self::with_usage(context, name, BufferKind::Storage, bytes, usage, location)
    }

    fn with_usage(
        context: &Arc<Context>,
        name: &str,
        kind: BufferKind,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Self, GpuError> {
        let device = &context.device;
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        // SAFETY: the size is not zero.
        let raw = unsafe { device.create_buffer(&info, None) }.during("vkCreateBuffer")?;
        // From here on, an early return destroys what there is.
        let buffer = Self {
            context: context.clone(),
            name: name.to_owned(),
            bytes,
            kind,
            raw,
            allocation: Mutex::new(None),
            state: Mutex::default(),
            _counted: context.census.count(Kind::Buffer),
        };
        context.name(raw, name);
        // SAFETY: the buffer is alive; its memory is of the size and type it requires, and is not used by others.
        unsafe {
            let requirements = device.get_buffer_memory_requirements(raw);
            let allocation = context.allocate(name, requirements, location, true)?;
            let mut slot = lock(&buffer.allocation);
            let allocation = slot.insert(allocation);
            device.bind_buffer_memory(raw, allocation.memory(), allocation.offset()).during("vkBindBufferMemory")?;
        }
        Ok(buffer)
    }

    /// Copies bytes into memory that the host sees. The device must not be using the buffer.
    pub(crate) fn write_mapped(&self, data: &[u8]) -> Result<(), GpuError> {
        self.check_size(data.len() as u64)?;
        let mut slot = lock(&self.allocation);
        let mapped = slot.as_mut().and_then(Allocation::mapped_slice_mut).ok_or_else(|| self.not_mapped())?;
        mapped[..data.len()].copy_from_slice(data);
        *lock(&self.state) = State::filled_by_host();
        Ok(())
    }

    /// Copies bytes out of memory that the host sees. The device must have finished writing them.
    pub(crate) fn read_mapped(&self, data: &mut [u8]) -> Result<(), GpuError> {
        self.check_size(data.len() as u64)?;
        let slot = lock(&self.allocation);
        let mapped = slot.as_ref().and_then(Allocation::mapped_slice).ok_or_else(|| self.not_mapped())?;
        data.copy_from_slice(&mapped[..data.len()]);
        Ok(())
    }

    pub(crate) fn check_size(&self, found: u64) -> Result<(), GpuError> {
        let size = || GpuError::Size { name: self.name.clone(), expected: self.bytes, found };
        if found == self.bytes { Ok(()) } else { Err(size()) }
    }

    fn not_mapped(&self) -> GpuError {
        GpuError::Resource { name: self.name.clone(), reason: "its memory cannot be seen by the host".to_owned() }
    }
}

impl Drop for BufferInner {
    fn drop(&mut self) {
        // SAFETY: recordings keep what they use until it is done.
        unsafe { self.context.device.destroy_buffer(self.raw, None) };
        if let Some(allocation) = lock(&self.allocation).take() {
            self.context.free(allocation);
        }
    }
}
