//! Texel formats, and what the device can do with them.

use ash::vk;
use welkin_shaders::StorageFormat;

/// The formats of images. Those after the first four are of a host's images, which are only sampled.
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
    /// Small floats without a sign: red and green of 11 bits, blue of 10.
    Rg11b10Float,
    /// Depth, a 32-bit float.
    Depth32Float,
    /// Depth of 16 bits that stand for [0, 1].
    Depth16Unorm,
    /// Depth of 24 bits that stand for [0, 1], and a stencil.
    Depth24UnormStencil8,
    /// Depth, a 32-bit float, and a stencil.
    Depth32FloatStencil8,
}

impl ImageFormat {
    const ALL: [Self; 9] = [
        Self::Rgba32Float,
        Self::Rgba16Float,
        Self::R32Float,
        Self::Rgba8Unorm,
        Self::Rg11b10Float,
        Self::Depth32Float,
        Self::Depth16Unorm,
        Self::Depth24UnormStencil8,
        Self::Depth32FloatStencil8,
    ];

    /// Bytes of a texel.
    pub const fn texel_bytes(self) -> u64 {
        match self {
            Self::Rgba32Float => 16,
            Self::Rgba16Float | Self::Depth32FloatStencil8 => 8,
            Self::R32Float | Self::Rgba8Unorm | Self::Rg11b10Float => 4,
            Self::Depth32Float | Self::Depth24UnormStencil8 => 4,
            Self::Depth16Unorm => 2,
        }
    }

    /// Whether it holds depth.
    pub const fn is_depth(self) -> bool {
        matches!(
            self,
            Self::Depth32Float | Self::Depth16Unorm | Self::Depth24UnormStencil8 | Self::Depth32FloatStencil8
        )
    }

    /// Which of these a Vulkan format is.
    pub(crate) fn of(format: vk::Format) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.vulkan() == format)
    }

    /// All that an image of this format has.
    pub(crate) fn aspects(self) -> vk::ImageAspectFlags {
        match self {
            Self::Depth24UnormStencil8 | Self::Depth32FloatStencil8 => {
                vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
            }
            _ => self.sampled_aspect(),
        }
    }

    /// What shaders see of it.
    pub(crate) const fn sampled_aspect(self) -> vk::ImageAspectFlags {
        if self.is_depth() { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR }
    }

    pub(crate) const fn vulkan(self) -> vk::Format {
        match self {
            Self::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
            Self::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            Self::R32Float => vk::Format::R32_SFLOAT,
            Self::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
            Self::Rg11b10Float => vk::Format::B10G11R11_UFLOAT_PACK32,
            Self::Depth32Float => vk::Format::D32_SFLOAT,
            Self::Depth16Unorm => vk::Format::D16_UNORM,
            Self::Depth24UnormStencil8 => vk::Format::D24_UNORM_S8_UINT,
            Self::Depth32FloatStencil8 => vk::Format::D32_SFLOAT_S8_UINT,
        }
    }

    /// The same format as a WGSL storage texture declares it; none for formats that are only sampled.
    pub(crate) const fn storage(self) -> Option<StorageFormat> {
        match self {
            Self::Rgba32Float => Some(StorageFormat::Rgba32Float),
            Self::Rgba16Float => Some(StorageFormat::Rgba16Float),
            Self::R32Float => Some(StorageFormat::R32Float),
            Self::Rgba8Unorm => Some(StorageFormat::Rgba8Unorm),
            _ => None,
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
