//! Descriptor sets of one dispatch.

use std::sync::Arc;

use ash::vk;

use super::buffer::BufferInner;
use super::census::{Counted, Kind};
use super::context::Context;
use super::error::{During, GpuError};
use super::pipeline::{PipelineInner, descriptor_type};
use super::resource::{Bound, Resource};

/// The sets of one dispatch, in a pool that holds just them.
pub(crate) struct Descriptors {
    context: Arc<Context>,
    pool: vk::DescriptorPool,
    pub(crate) sets: Vec<vk::DescriptorSet>,
    _counted: Counted,
}

impl Descriptors {
    /// Sets for a pipeline, with everything in place. `data` holds, in order, the uniform buffers for what is bound as
    /// [`Resource::Data`].
    pub(crate) fn new(
        context: &Arc<Context>,
        pipeline: &PipelineInner,
        bound: &[Bound],
        data: &[BufferInner],
    ) -> Result<Option<Self>, GpuError> {
        if bound.is_empty() {
            return Ok(None);
        }
        let size = |bound: &Bound| {
            vk::DescriptorPoolSize::default().ty(descriptor_type(&bound.binding.kind)).descriptor_count(1)
        };
        let sizes: Vec<_> = bound.iter().map(size).collect();
        let info =
            vk::DescriptorPoolCreateInfo::default().max_sets(pipeline.set_layouts.len() as u32).pool_sizes(&sizes);
        // SAFETY: there is at least one set and one descriptor.
        let pool = unsafe { context.device.create_descriptor_pool(&info, None) }.during("vkCreateDescriptorPool")?;
        let counted = context.census.count(Kind::DescriptorPool);
        let mut descriptors = Self { context: context.clone(), pool, sets: Vec::new(), _counted: counted };
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&pipeline.set_layouts);
        // SAFETY: the pool holds as many sets and descriptors.
        descriptors.sets =
            unsafe { context.device.allocate_descriptor_sets(&info) }.during("vkAllocateDescriptorSets")?;
        descriptors.write(bound, data);
        Ok(Some(descriptors))
    }

    fn write(&self, bound: &[Bound], data: &[BufferInner]) {
        let mut data = data.iter();
        for bound in bound {
            let (mut buffer, mut image) =
                (vk::DescriptorBufferInfo::default().range(vk::WHOLE_SIZE), Default::default());
            match bound.resource {
                Resource::Buffer(resource) => buffer.buffer = resource.0.raw,
                Resource::Sampled(resource, sampler) => {
                    let layout = bound.needs.map_or(vk::ImageLayout::UNDEFINED, |needs| needs.layout);
                    image = vk::DescriptorImageInfo::default().image_view(resource.0.view).image_layout(layout);
                    image = image.sampler(sampler.0.raw);
                }
                Resource::Data(_) => buffer.buffer = data.next().expect("one buffer for each data binding").raw,
                Resource::Image(resource) => {
                    let layout = bound.needs.map_or(vk::ImageLayout::UNDEFINED, |needs| needs.layout);
                    image = vk::DescriptorImageInfo::default().image_view(resource.0.view).image_layout(layout);
                }
                Resource::Sampler(sampler) => image = vk::DescriptorImageInfo::default().sampler(sampler.0.raw),
            }
            let write = vk::WriteDescriptorSet::default()
                .dst_set(self.sets[bound.binding.group as usize])
                .dst_binding(bound.binding.index)
                .descriptor_type(descriptor_type(&bound.binding.kind));
            let (buffers, images) = ([buffer], [image]);
            let write = match bound.resource {
                Resource::Buffer(_) | Resource::Data(_) => write.buffer_info(&buffers),
                Resource::Image(_) | Resource::Sampler(_) | Resource::Sampled(..) => write.image_info(&images),
            };
            // SAFETY: the sets are new, and kinds have been checked against the pass's declaration.
            unsafe { self.context.device.update_descriptor_sets(&[write], &[]) };
        }
    }
}

impl Drop for Descriptors {
    fn drop(&mut self) {
        // SAFETY: the recording that owns this has ended; the sets go with their pool.
        unsafe { self.context.device.destroy_descriptor_pool(self.pool, None) };
    }
}
