//! The images that a window shows in turn.

use std::sync::Arc;

use ash::vk::{ColorSpaceKHR as Space, Format};
use ash::{khr, vk};

use super::context::Context;
use super::error::{During, GpuError};
use super::format::ScreenEncoding;
use super::surface::Surface;

/// A swapchain with a view of each image. Destroyed only while the device uses none of them.
pub(crate) struct Swapchain {
    context: Arc<Context>,
    functions: khr::swapchain::Device,
    pub(crate) raw: vk::SwapchainKHR,
    pub(crate) images: Vec<vk::Image>,
    pub(crate) views: Vec<vk::ImageView>,
    /// One an image: signalled when it may be shown.
    pub(crate) drawn: Vec<vk::Semaphore>,
    pub(crate) extent: vk::Extent2D,
    pub(crate) format: vk::SurfaceFormatKHR,
    pub(crate) encoding: ScreenEncoding,
}

impl Swapchain {
    /// For a surface and the size that the window has, in pixels; `None` where the window has no area at the moment. With
    /// `bright`, it shows light above white where the surface can.
    pub(crate) fn new(
        context: &Arc<Context>,
        surface: &Surface,
        size: [u32; 2],
        bright: bool,
        old: Option<&Self>,
    ) -> Result<Option<Self>, GpuError> {
        let device = context.physical_device;
        let capabilities = surface.capabilities(device).during("vkGetPhysicalDeviceSurfaceCapabilitiesKHR")?;
        let extent = extent(&capabilities, size);
        if extent.width == 0 || extent.height == 0 {
            return Ok(None);
        }
        let formats = surface.formats(device).during("vkGetPhysicalDeviceSurfaceFormatsKHR")?;
        let Some((format, encoding)) = choose_format(&formats, bright) else {
            return Err(GpuError::NoSurface("its formats are none that pictures can be drawn in".to_owned()));
        };
        let functions = khr::swapchain::Device::new(&context.instance.raw, &context.device);
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw())
            .min_image_count((capabilities.min_image_count + 1).min(most))
            .image_format(format.format)
            .image_color_space(format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_DST)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(capabilities.current_transform)
            .composite_alpha(opaque(capabilities.supported_composite_alpha))
            // The mode that every device has; it shows whole pictures only.
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true)
            .old_swapchain(old.map_or(vk::SwapchainKHR::null(), |old| old.raw));
        // SAFETY: the surface is alive, and the device can show pictures on it.
        let raw = unsafe { functions.create_swapchain(&info, None) }.during("vkCreateSwapchainKHR")?;
        // From here on, an early return destroys what there is.
        let (images, views, drawn) = (Vec::new(), Vec::new(), Vec::new());
        let mut swapchain =
            Self { context: context.clone(), functions, raw, images, views, drawn, extent, format, encoding };
        swapchain.take_images()?;
        Ok(Some(swapchain))
    }

    fn take_images(&mut self) -> Result<(), GpuError> {
        let device = &self.context.device;
        // SAFETY: the swapchain is alive, as are its images in the calls below.
        self.images = unsafe { self.functions.get_swapchain_images(self.raw) }.during("vkGetSwapchainImagesKHR")?;
        for &image in &self.images {
            self.context.name(image, "window");
            let whole = vk::ImageSubresourceRange::default()
                .aspect_mask(vk::ImageAspectFlags::COLOR)
                .level_count(1)
                .layer_count(1);
            let view = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(self.format.format)
                .subresource_range(whole);
            unsafe {
                self.views.push(device.create_image_view(&view, None).during("vkCreateImageView")?);
                self.drawn.push(device.create_semaphore(&Default::default(), None).during("vkCreateSemaphore")?);
            }
        }
        Ok(())
    }

    /// The next image to draw in, and whether the swapchain still fits the window well. Waits for `timeout_ns` at most.
    pub(crate) fn acquire(&self, timeout_ns: u64, acquired: vk::Semaphore) -> Result<(usize, bool), vk::Result> {
        // SAFETY: nothing waits for the semaphore.
        let next = unsafe { self.functions.acquire_next_image(self.raw, timeout_ns, acquired, vk::Fence::null()) };
        next.map(|(index, suboptimal)| (index as usize, !suboptimal))
    }

    /// Shows an image once it is drawn; says whether the swapchain still fits the window well.
    pub(crate) fn present(&self, queue: vk::Queue, index: usize) -> Result<bool, vk::Result> {
        let (drawn, swapchains, indices) = ([self.drawn[index]], [self.raw], [index as u32]);
        let info =
            vk::PresentInfoKHR::default().wait_semaphores(&drawn).swapchains(&swapchains).image_indices(&indices);
        // SAFETY: the image was acquired, and drawing it signals the semaphore.
        unsafe { self.functions.queue_present(queue, &info) }.map(|suboptimal| !suboptimal)
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        let device = &self.context.device;
        // SAFETY: who owns it has waited until nothing uses it.
        unsafe {
            self.views.iter().for_each(|&view| device.destroy_image_view(view, None));
            self.drawn.iter().for_each(|&semaphore| device.destroy_semaphore(semaphore, None));
            self.functions.destroy_swapchain(self.raw, None);
        }
    }
}

/// A surface may leave the size to the application.
fn extent(capabilities: &vk::SurfaceCapabilitiesKHR, [width, height]: [u32; 2]) -> vk::Extent2D {
    if capabilities.current_extent.width != u32::MAX {
        return capabilities.current_extent;
    }
    let (least, most) = (capabilities.min_image_extent, capabilities.max_image_extent);
    vk::Extent2D {
        width: width.clamp(least.width, most.width.max(least.width)),
        height: height.clamp(least.height, most.height.max(least.height)),
    }
}

/// What lies behind the window does not shine through.
fn opaque(supported: vk::CompositeAlphaFlagsKHR) -> vk::CompositeAlphaFlagsKHR {
    let opaque = vk::CompositeAlphaFlagsKHR::OPAQUE;
    if supported.contains(opaque) { opaque } else { vk::CompositeAlphaFlagsKHR::INHERIT }
}

/// Whether a surface shows light above white. Extended sRGB alone does not say so: some systems offer it for any screen, and
/// clip what is above white.
pub(crate) fn shows_above_white(offered: &[vk::SurfaceFormatKHR]) -> bool {
    offered.iter().any(|offer| offer.color_space == Space::HDR10_ST2084_EXT)
}

/// Formats with the spaces that they are meant in, as in `B8G8R8A8_UNORM in SRGB_NONLINEAR`.
pub(crate) fn in_words(offered: &[vk::SurfaceFormatKHR]) -> String {
    let words = offered.iter().map(|offer| format!("{:?} in {:?}", offer.format, offer.color_space));
    words.collect::<Vec<_>>().join(", ")
}

/// The format that pictures and panel look best in: where light above white is asked for and can be shown, half floats in
/// linear light, or else ten bits of HDR10; and bytes or ten bits of sRGB. They are sent as they are: an `SRGB` format would
/// encode what is encoded already.
fn choose_format(offered: &[vk::SurfaceFormatKHR], bright: bool) -> Option<(vk::SurfaceFormatKHR, ScreenEncoding)> {
    use ScreenEncoding::{ExtendedLinear, Hdr10, Srgb};
    let above_white = [
        (Format::R16G16B16A16_SFLOAT, Space::EXTENDED_SRGB_LINEAR_EXT, ExtendedLinear),
        (Format::A2B10G10R10_UNORM_PACK32, Space::HDR10_ST2084_EXT, Hdr10),
        (Format::A2R10G10B10_UNORM_PACK32, Space::HDR10_ST2084_EXT, Hdr10),
    ];
    let up_to_white = [
        Format::B8G8R8A8_UNORM,
        Format::R8G8B8A8_UNORM,
        Format::A8B8G8R8_UNORM_PACK32,
        Format::A2B10G10R10_UNORM_PACK32,
        Format::A2R10G10B10_UNORM_PACK32,
    ]
    .map(|format| (format, Space::SRGB_NONLINEAR, Srgb));
    let bright = above_white.into_iter().filter(|_| bright && shows_above_white(offered));
    let find = |(format, space, encoding)| {
        let fits = |offer: &&vk::SurfaceFormatKHR| (offer.format, offer.color_space) == (format, space);
        offered.iter().find(fits).map(|offer| (*offer, encoding))
    };
    bright.chain(up_to_white).find_map(find)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer(format: Format, color_space: Space) -> vk::SurfaceFormatKHR {
        vk::SurfaceFormatKHR { format, color_space }
    }

    #[test]
    fn a_format_is_taken_that_encodes_nothing() {
        let bytes = offer(Format::B8G8R8A8_UNORM, Space::SRGB_NONLINEAR);
        let encoded_twice = offer(Format::B8G8R8A8_SRGB, Space::SRGB_NONLINEAR);
        let other_space = offer(Format::B8G8R8A8_UNORM, Space::HDR10_ST2084_EXT);
        let offered = [encoded_twice, other_space, bytes];
        assert_eq!(choose_format(&offered, false), Some((bytes, ScreenEncoding::Srgb)));
        assert_eq!(choose_format(&[encoded_twice, other_space], true), None);
    }

    #[test]
    fn light_above_white_is_shown_where_the_screen_says_so_and_it_is_wanted() {
        let bytes = offer(Format::B8G8R8A8_UNORM, Space::SRGB_NONLINEAR);
        let linear = offer(Format::R16G16B16A16_SFLOAT, Space::EXTENDED_SRGB_LINEAR_EXT);
        let hdr10 = offer(Format::A2B10G10R10_UNORM_PACK32, Space::HDR10_ST2084_EXT);
        assert_eq!(choose_format(&[bytes, hdr10, linear], true), Some((linear, ScreenEncoding::ExtendedLinear)));
        assert_eq!(choose_format(&[bytes, hdr10], true), Some((hdr10, ScreenEncoding::Hdr10)));
        // Not on a screen that would clip it, nor where it is not wanted.
        assert_eq!(choose_format(&[bytes, linear], true), Some((bytes, ScreenEncoding::Srgb)));
        assert_eq!(choose_format(&[bytes, hdr10, linear], false), Some((bytes, ScreenEncoding::Srgb)));
    }

    /// Lists as drivers gave them (of the longest a part), with what is taken of them where light above white is wanted.
    #[test]
    fn of_lists_that_drivers_gave_the_right_format_is_taken() {
        use ScreenEncoding::{ExtendedLinear, Hdr10, Srgb};
        let [bgra, bgra_srgb] = [Format::B8G8R8A8_UNORM, Format::B8G8R8A8_SRGB];
        let [rgba, rgba_srgb] = [Format::R8G8B8A8_UNORM, Format::R8G8B8A8_SRGB];
        let [half, ten] = [Format::R16G16B16A16_SFLOAT, Format::A2B10G10R10_UNORM_PACK32];
        let ten_other_way = Format::A2R10G10B10_UNORM_PACK32;
        let sdr = Space::SRGB_NONLINEAR;
        let each = |formats: &[Format], spaces: &[Space]| -> Vec<vk::SurfaceFormatKHR> {
            spaces.iter().flat_map(|space| formats.iter().map(|format| offer(*format, *space))).collect()
        };
        // lavapipe (Mesa 22.3.6) under Xvfb, as the window's log has it.
        let xvfb = each(&[bgra_srgb, bgra], &[sdr]);
        // An old NVIDIA driver on Linux (gfx-rs/wgpu, issue 8076).
        let nvidia_460 = each(&[ten, Format::A2B10G10R10_SNORM_PACK32], &[sdr]);
        // MoltenVK on a Mac: every format in every space, light above white or not (godotengine/godot, pull request 36585).
        let mac_spaces = [sdr, Space::ADOBERGB_NONLINEAR_EXT, Space::PASS_THROUGH_EXT, Space::EXTENDED_SRGB_LINEAR_EXT];
        let moltenvk = each(&[bgra, bgra_srgb, half, ten_other_way], &mac_spaces);
        // NVIDIA under Windows with HDR on: ten bits in HDR10 alone (gfx-rs/wgpu, pull request 9658), half floats in extended
        // sRGB (KhronosGroup/Vulkan-Samples, issue 638).
        let windows = [
            each(&[bgra, bgra_srgb], &[sdr]),
            each(&[half], &[Space::EXTENDED_SRGB_LINEAR_EXT]),
            each(&[ten], &[Space::HDR10_ST2084_EXT]),
        ]
        .concat();
        // Of no driver: HDR10 without extended sRGB.
        let hdr10 = each(&[bgra, rgba, rgba_srgb, ten_other_way], &[sdr, Space::HDR10_ST2084_EXT]);
        let cases = [
            (xvfb, offer(bgra, sdr), Srgb),
            (nvidia_460, offer(ten, sdr), Srgb),
            (moltenvk, offer(bgra, sdr), Srgb),
            (windows, offer(half, Space::EXTENDED_SRGB_LINEAR_EXT), ExtendedLinear),
            (hdr10, offer(ten_other_way, Space::HDR10_ST2084_EXT), Hdr10),
        ];
        for (offered, format, encoding) in cases {
            assert_eq!(choose_format(&offered, true), Some((format, encoding)), "{}", in_words(&offered));
            assert_eq!(shows_above_white(&offered), encoding != Srgb);
            // Where it is not wanted, bytes or ten bits of sRGB are taken from each list.
            let (plain, encoding) = choose_format(&offered, false).unwrap();
            assert_eq!((plain.color_space, encoding), (sdr, Srgb));
        }
    }

    #[test]
    fn the_surface_says_the_size_or_bounds_it() {
        let fixed = vk::Extent2D { width: 30, height: 20 };
        let mut capabilities = vk::SurfaceCapabilitiesKHR { current_extent: fixed, ..Default::default() };
        assert_eq!(extent(&capabilities, [500, 500]), fixed);
        capabilities.current_extent = vk::Extent2D { width: u32::MAX, height: u32::MAX };
        capabilities.max_image_extent = vk::Extent2D { width: 400, height: 600 };
        assert_eq!(extent(&capabilities, [500, 500]), vk::Extent2D { width: 400, height: 500 });
    }
}
