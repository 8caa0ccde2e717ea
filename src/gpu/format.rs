//! Texel formats, and what the device can do with them.

use ash::vk;
use welkin_shaders::StorageFormat;

/// The formats of images.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ImageFormat {
    /// Four 32-bit floats.
    Rgba32Float,
    /// Four 16-bit floats.
    Rgba16Float,
    /// One 32-bit float.
    R32Float,
    /// Four bytes that stand for [0, 1].
    Rgba8Unorm,
}

impl ImageFormat {
    /// Bytes of a texel.
    pub const fn texel_bytes(self) -> u64 {
        match self {
            Self::Rgba32Float => 16,
            Self::Rgba16Float => 8,
            Self::R32Float | Self::Rgba8Unorm => 4,
        }
    }

    pub(crate) const fn vulkan(self) -> vk::Format {
        match self {
            Self::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
            Self::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            Self::R32Float => vk::Format::R32_SFLOAT,
            Self::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
        }
    }

    /// The same format as a WGSL storage texture declares it.
    pub(crate) const fn storage(self) -> StorageFormat {
        match self {
            Self::Rgba32Float => StorageFormat::Rgba32Float,
            Self::Rgba16Float => StorageFormat::Rgba16Float,
            Self::R32Float => StorageFormat::R32Float,
            Self::Rgba8Unorm => StorageFormat::Rgba8Unorm,
        }
    }
}

/// How pictures are encoded for a screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ScreenEncoding {
    /// sRGB in bytes.
    #[default]
    Srgb,
    /// Linear sRGB beyond [0, 1] in half floats, 1 being 80 cd/m² (scRGB).
    ExtendedLinear,
    /// HDR10: BT.2020 under the perceptual quantizer of SMPTE ST 2084, in half floats until the screen's own 10 bits.
    Hdr10,
}

impl ScreenEncoding {
    /// Format of pictures that are encoded so.
    pub const fn image_format(self) -> ImageFormat {
        match self {
            Self::Srgb => ImageFormat::Rgba8Unorm,
            Self::ExtendedLinear | Self::Hdr10 => ImageFormat::Rgba16Float,
        }
    }
}

/// How a device can sample a format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filtering {
    /// Between texels.
    Linear,
    /// Only single texels: shaders must interpolate by themselves.
    NearestOnly,
}
