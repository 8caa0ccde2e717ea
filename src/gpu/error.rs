//! What can go wrong on the way to a device and on it.

use ash::vk;

/// Why the device could not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// The Vulkan loader is not installed.
    #[error(
        "no Vulkan loader ({0}); install it and a driver, on Debian and Ubuntu: apt-get install libvulkan1 \
         mesa-vulkan-drivers"
    )]
    NoLoader(String),
    /// Pictures cannot be shown.
    #[error("Vulkan cannot draw in this window: {0}")]
    NoSurface(String),
    /// A loader without any driver.
    #[error(
        "no Vulkan device; install a driver, on Debian and Ubuntu: apt-get install libvulkan1 mesa-vulkan-drivers \
         (mesa-vulkan-drivers renders on the CPU where there is no GPU)"
    )]
    NoDevice,
    /// Devices, but none that can be used.
    #[error(
        "no usable Vulkan 1.3 device among: {0}; install a newer driver, on Debian and Ubuntu: apt-get install \
         libvulkan1 mesa-vulkan-drivers"
    )]
    NoUsableDevice(String),
    /// The requested device is not there.
    #[error("no Vulkan device `{requested}`; there are: {available}")]
    UnknownDevice {
        /// The name or index that was asked for.
        requested: String,
        /// What there is, with indices.
        available: String,
    },
    /// The requested device is there but cannot be used.
    #[error("the device {device} cannot be used: {reason}")]
    UnusableDevice {
        /// The device's name.
        device: String,
        /// What it lacks.
        reason: String,
    },
    /// Validation was asked for and its layer is not installed.
    #[error(
        "the Vulkan validation layer is not installed; on Debian and Ubuntu: apt-get install vulkan-validationlayers"
    )]
    NoValidationLayer,
    /// A Vulkan call failed.
    #[error("{call} failed: {}", words(*result))]
    Vulkan {
        /// The function's name.
        call: &'static str,
        /// What it returned.
        result: vk::Result,
    },
    /// Memory for a resource could not be had.
    #[error("no memory for `{name}` ({bytes} bytes): {source}")]
    Memory {
        /// The resource.
        name: String,
        /// Its size.
        bytes: u64,
        /// The allocator's reason.
        source: gpu_allocator::AllocationError,
    },
    /// A resource cannot be made as asked.
    #[error("cannot make `{name}`: {reason}")]
    Resource {
        /// The resource.
        name: String,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// A pipeline cannot be made from a pass.
    #[error("pass `{pass}`: {reason}")]
    Pipeline {
        /// The pass.
        pass: String,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// A dispatch leaves a resource out.
    #[error("pass `{pass}`: nothing is bound to `{binding}`")]
    MissingBinding {
        /// The pass.
        pass: String,
        /// The WGSL variable.
        binding: String,
    },
    /// A dispatch binds something that the pass does not use.
    #[error("pass `{pass}` uses no `{binding}`; it uses: {expected}")]
    SuperfluousBinding {
        /// The pass.
        pass: String,
        /// The name that was bound.
        binding: String,
        /// The WGSL variables of the pass.
        expected: String,
    },
    /// A dispatch binds one name twice.
    #[error("pass `{pass}`: `{binding}` is bound twice")]
    DuplicateBinding {
        /// The pass.
        pass: String,
        /// The name that was bound.
        binding: String,
    },
    /// What is bound is of another kind than the WGSL variable.
    #[error("pass `{pass}`: `{binding}` is {expected}, but {found} is bound to it")]
    WrongBinding {
        /// The pass.
        pass: String,
        /// The WGSL variable.
        binding: String,
        /// What the pass declares.
        expected: String,
        /// What was bound.
        found: String,
    },
    /// A dispatch binds one resource to two variables, at least one of which writes or wants another image layout.
    #[error("pass `{pass}`: `{first}` and `{second}` are the same resource, and one of them is written")]
    Aliased {
        /// The pass.
        pass: String,
        /// One WGSL variable.
        first: String,
        /// The other one.
        second: String,
    },
    /// A dispatch reads a resource that nothing has written.
    #[error("pass `{pass}` reads `{binding}` (`{resource}`), which nothing has written yet")]
    ReadBeforeWrite {
        /// The pass.
        pass: String,
        /// The WGSL variable.
        binding: String,
        /// The resource's name.
        resource: String,
    },
    /// A dispatch is empty or larger than the device allows.
    #[error("pass `{pass}`: {workgroups:?} workgroups; each number must be in 1..={limit:?}")]
    DispatchSize {
        /// The pass.
        pass: String,
        /// What was asked for.
        workgroups: [u32; 3],
        /// The device's limits.
        limit: [u32; 3],
    },
    /// Device memory was to be read or written while commands that may use it are being recorded.
    #[error("cannot {action} while `{open}` is being recorded; submit it first")]
    Recording {
        /// What was to be done.
        action: String,
        /// The label of the open recording.
        open: String,
    },
    /// A paced recording was told to stop.
    #[error("`{0}` was stopped before it was done")]
    Stopped(String),
    /// The device's queue has no timestamps.
    #[error("{device} has no timestamps; use the host's clock")]
    NoTimestamps {
        /// The device's name.
        device: String,
    },
    /// A host's device lacks what is needed, or was made without it.
    #[error("the host's device {device} lacks {}; make it with them: see `HostDevice`", missing.join(", "))]
    HostLacks {
        /// The device's name.
        device: String,
        /// What it lacks, in Vulkan's words.
        missing: Vec<String>,
    },
    /// A host's image cannot be used.
    #[error("the host's image `{name}`: {reason}")]
    HostImage {
        /// What it is for.
        name: String,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// On a host's device nothing is submitted, and so nothing is read back.
    #[error("cannot {action}: the queues are the host's; record into a command buffer of its own")]
    HostsQueue {
        /// What was to be done.
        action: String,
    },
    /// The host's elements do not fit a resource.
    #[error("`{name}` has {expected} bytes, but {found} bytes were given or asked for")]
    Size {
        /// The resource.
        name: String,
        /// Its size in bytes.
        expected: u64,
        /// The size of the host's elements in bytes.
        found: u64,
    },
}

/// What a result of Vulkan means, and what to do.
fn words(result: vk::Result) -> String {
    let remedy = "with a smaller picture or a lower quality";
    match result {
        vk::Result::ERROR_DEVICE_LOST => format!(
            "the device was lost: its driver has crashed or was reset, or a dispatch took longer than it allows; run it again, \
             and {remedy} if the device is lost again"
        ),
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
            format!("the driver has no memory of the host left; end other programs, or try {remedy}")
        }
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => {
            format!("the device has no memory left; end other programs that use it, or try {remedy}")
        }
        other => other.to_string(),
    }
}

impl GpuError {
    /// Whether the device is lost: it and all that it holds is of no use any more, but another can be opened.
    pub fn is_device_lost(&self) -> bool {
        matches!(self, Self::Vulkan { result: vk::Result::ERROR_DEVICE_LOST, .. })
    }

    /// Whether nothing went wrong but that [`super::Pace::stop`] was called.
    pub fn is_stopped(&self) -> bool {
        matches!(self, Self::Stopped(_))
    }

    /// Whether the cause is that this machine has no Vulkan device that can be used, so that a program can tell it
    /// from other failures.
    pub fn is_no_usable_device(&self) -> bool {
        use GpuError as E;
        matches!(self, E::NoLoader(_) | E::NoDevice | E::NoSurface(_) | E::NoUsableDevice(_) | E::UnusableDevice { .. })
    }
}

/// Names the Vulkan call that failed.
pub(crate) trait During<T> {
    fn during(self, call: &'static str) -> Result<T, GpuError>;
}

impl<T> During<T> for Result<T, vk::Result> {
    fn during(self, call: &'static str) -> Result<T, GpuError> {
        self.map_err(|result| GpuError::Vulkan { call, result })
    }
}
