//! Samplers.

use std::sync::Arc;

use ash::vk;

use super::context::Context;
use super::error::{During, GpuError};

/// How a sampler reads between texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Linear interpolation along every axis but layers.
    Linear,
}

/// How a sampler reads beyond the edge of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AddressMode {
    /// The texel at the edge.
    Clamp,
    /// The image again.
    Repeat,
}

/// A sampler. Clones are the same sampler.
#[derive(Clone)]
pub struct Sampler(pub(crate) Arc<SamplerInner>);

pub(crate) struct SamplerInner {
    context: Arc<Context>,
    pub(crate) raw: vk::Sampler,
}

impl SamplerInner {
    pub(crate) fn new(context: &Arc<Context>, filter: Filter, address: [AddressMode; 3]) -> Result<Self, GpuError> {
        let filter = match filter {
            Filter::Nearest => vk::Filter::NEAREST,
            Filter::Linear => vk::Filter::LINEAR,
        };
        let [u, v, w] = address.map(|mode| match mode {
            AddressMode::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
            AddressMode::Repeat => vk::SamplerAddressMode::REPEAT,
        });
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(u)
            .address_mode_v(v)
            .address_mode_w(w);
        // SAFETY: no optional feature is used.
        let raw = unsafe { context.device.create_sampler(&info, None) }.during("vkCreateSampler")?;
        Ok(Self { context: context.clone(), raw })
    }
}

impl Drop for SamplerInner {
    fn drop(&mut self) {
        // SAFETY: recordings keep what they use until it is done.
        unsafe { self.context.device.destroy_sampler(self.raw, None) };
    }
}
