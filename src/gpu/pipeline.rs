//! Compute pipelines, made from compiled passes.

use std::sync::Arc;

use ash::vk;
use welkin_shaders::{Binding, BindingKind, Shader};

use super::census::{Counted, Kind};
use super::context::Context;
use super::device::{Limits, ResourceLimits};
use super::error::{During, GpuError};

/// Uniform buffers that a pass may use. Mesa 22's lavapipe writes out of bounds when a branch or loop bound depends on
/// a load from the fourth or a later one of a stage.
pub const MAX_UNIFORM_BUFFERS: usize = 3;

/// A pass that is ready to be dispatched. Clones are the same pipeline.
#[derive(Clone)]
pub struct Pipeline(pub(crate) Arc<PipelineInner>);

impl Pipeline {
    /// The pass's name.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// What must be bound when it is dispatched.
    pub fn bindings(&self) -> &[Binding] {
        &self.0.bindings
    }
}

pub(crate) struct PipelineInner {
    context: Arc<Context>,
    pub(crate) name: String,
    pub(crate) bindings: Vec<Binding>,
    pub(crate) workgroup_size: [u32; 3],
    /// One for each `@group`, empty ones included.
    pub(crate) set_layouts: Vec<vk::DescriptorSetLayout>,
    pub(crate) layout: vk::PipelineLayout,
    pub(crate) raw: vk::Pipeline,
    _counted: Counted,
}

impl PipelineInner {
    pub(crate) fn new(context: &Arc<Context>, shader: &Shader) -> Result<Self, GpuError> {
        check(&context.info.limits, shader)?;
        // An early return destroys what there is.
        let mut pipeline = Self {
            context: context.clone(),
            name: shader.name.clone(),
            bindings: shader.bindings.clone(),
            workgroup_size: shader.workgroup_size,
            set_layouts: Vec::new(),
            layout: vk::PipelineLayout::null(),
            raw: vk::Pipeline::null(),
            _counted: context.census.count(Kind::Pipeline),
        };
        let groups = shader.bindings.iter().map(|binding| binding.group + 1).max().unwrap_or(0);
        for group in 0..groups {
            pipeline.set_layouts.push(set_layout(context, &shader.bindings, group)?);
        }
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&pipeline.set_layouts);
        // SAFETY: the set layouts are alive.
        pipeline.layout =
            unsafe { context.device.create_pipeline_layout(&info, None) }.during("vkCreatePipelineLayout")?;
        pipeline.raw = compute_pipeline(context, shader, pipeline.layout)?;
        context.name(pipeline.raw, &shader.name);
        Ok(pipeline)
    }
}

impl Drop for PipelineInner {
    fn drop(&mut self) {
        let device = &self.context.device;
        // SAFETY: recordings keep what they use until it is done; null handles are ignored.
        unsafe {
            device.destroy_pipeline(self.raw, None);
            device.destroy_pipeline_layout(self.layout, None);
            for &layout in &self.set_layouts {
                device.destroy_descriptor_set_layout(layout, None);
            }
        }
    }
}

/// Whether a device can run a pass.
fn check(limits: &Limits, shader: &Shader) -> Result<(), GpuError> {
    let refuse = |reason: String| Err(GpuError::Pipeline { pass: shader.name.clone(), reason });
    let size = shader.workgroup_size;
    let invocations = size.iter().map(|&n| u64::from(n)).product::<u64>();
    let too_wide = size.iter().zip(limits.workgroup_size).any(|(&n, limit)| n > limit);
    if too_wide || invocations > u64::from(limits.workgroup_invocations) {
        let (sides, all) = (limits.workgroup_size, limits.workgroup_invocations);
        return refuse(format!("workgroups of {size:?}; the device allows {sides:?}, and {all} invocations in all"));
    }
    let (shared, limit) = (shader.workgroup_bytes, limits.workgroup_bytes);
    if shared > limit {
        return refuse(format!("{shared} bytes shared by a workgroup; the device has {limit}"));
    }
    let used = used(shader);
    if used.uniform_buffers > MAX_UNIFORM_BUFFERS as u32 {
        let reason = format!("{} uniform buffers; at most {MAX_UNIFORM_BUFFERS} are allowed", used.uniform_buffers);
        return refuse(reason);
    }
    let allowed = limits.resources;
    let kinds = [
        ("uniform buffers", used.uniform_buffers, allowed.uniform_buffers),
        ("storage buffers", used.storage_buffers, allowed.storage_buffers),
        ("sampled images", used.sampled_images, allowed.sampled_images),
        ("storage images", used.storage_images, allowed.storage_images),
        ("samplers", used.samplers, allowed.samplers),
        ("buffers and images", used.all, allowed.all),
    ];
    match kinds.into_iter().find(|(_, used, allowed)| used > allowed) {
        Some((kind, used, allowed)) => refuse(format!("{used} {kind}; the device allows {allowed}")),
        None => Ok(()),
    }
}

/// The resources that a pass uses.
fn used(shader: &Shader) -> ResourceLimits {
    let count = |is: fn(&BindingKind) -> bool| shader.bindings.iter().filter(|b| is(&b.kind)).count() as u32;
    let samplers = count(|kind| matches!(kind, BindingKind::Sampler | BindingKind::CombinedTexture { .. }));
    ResourceLimits {
        uniform_buffers: count(|kind| matches!(kind, BindingKind::UniformBuffer { .. })),
        storage_buffers: count(|kind| matches!(kind, BindingKind::StorageBuffer { .. })),
        sampled_images: count(|kind| {
            matches!(kind, BindingKind::SampledTexture { .. } | BindingKind::CombinedTexture { .. })
        }),
        storage_images: count(|kind| matches!(kind, BindingKind::StorageTexture { .. })),
        samplers,
        all: count(|kind| !matches!(kind, BindingKind::Sampler)),
    }
}

fn set_layout(context: &Context, bindings: &[Binding], group: u32) -> Result<vk::DescriptorSetLayout, GpuError> {
    let slot = |binding: &Binding| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(binding.index)
            .descriptor_type(descriptor_type(&binding.kind))
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
    };
    let slots: Vec<_> = bindings.iter().filter(|binding| binding.group == group).map(slot).collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&slots);
    // SAFETY: naga has checked that indices are unique.
    unsafe { context.device.create_descriptor_set_layout(&info, None) }.during("vkCreateDescriptorSetLayout")
}

pub(crate) fn descriptor_type(kind: &BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::UniformBuffer { .. } => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::StorageBuffer { .. } => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::SampledTexture { .. } => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::CombinedTexture { .. } => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        BindingKind::StorageTexture { .. } => vk::DescriptorType::STORAGE_IMAGE,
        BindingKind::Sampler => vk::DescriptorType::SAMPLER,
    }
}

fn compute_pipeline(context: &Context, shader: &Shader, layout: vk::PipelineLayout) -> Result<vk::Pipeline, GpuError> {
    let refuse = |reason: String| GpuError::Pipeline { pass: shader.name.clone(), reason };
    let entry = std::ffi::CString::new(shader.entry_point.as_str()).map_err(|error| refuse(error.to_string()))?;
    let code = vk::ShaderModuleCreateInfo::default().code(&shader.spirv);
    let device = &context.device;
    // SAFETY: the SPIR-V is naga's, from a module that it has validated, or the host answers for it.
    let module = unsafe { device.create_shader_module(&code, None) }.during("vkCreateShaderModule")?;
    let stage =
        vk::PipelineShaderStageCreateInfo::default().stage(vk::ShaderStageFlags::COMPUTE).module(module).name(&entry);
    // A dispatch may be run in pieces, each of which begins at another workgroup.
    let flags = vk::PipelineCreateFlags::DISPATCH_BASE;
    let info = vk::ComputePipelineCreateInfo::default().flags(flags).stage(stage).layout(layout);
    // SAFETY: module, entry point and layout are of the same pass. The driver guards the cache against other threads.
    let pipelines = unsafe { device.create_compute_pipelines(context.pipeline_cache.raw, &[info], None) };
    // SAFETY: a pipeline needs its module only while it is made.
    unsafe { device.destroy_shader_module(module, None) };
    let pipelines = pipelines.map_err(|(_, result)| result).during("vkCreateComputePipelines")?;
    pipelines.first().copied().ok_or_else(|| refuse("the driver returned no pipeline".to_owned()))
}

#[cfg(test)]
mod tests {
    use ash::vk;
    use welkin_shaders::{Definitions, Sources};

    use super::super::device::limits;
    use super::*;

    fn shader(text: String) -> Shader {
        Shader::from_sources(&Sources::default().with("pass.wgsl", text), "pass", &Definitions::new()).unwrap()
    }

    #[test]
    fn what_a_pass_needs_beyond_a_device_is_said_by_pass_and_kind() {
        // What every device of Vulkan has at least.
        let least = vk::PhysicalDeviceLimits {
            max_compute_work_group_size: [128, 128, 64],
            max_compute_work_group_invocations: 128,
            max_compute_shared_memory_size: 16384,
            max_per_stage_descriptor_uniform_buffers: 12,
            max_per_stage_descriptor_storage_buffers: 4,
            max_per_stage_descriptor_sampled_images: 16,
            max_per_stage_descriptor_storage_images: 4,
            max_per_stage_descriptor_samplers: 16,
            max_per_stage_resources: 128,
            ..Default::default()
        };
        let said = |text: String| check(&limits(&least, 0), &shader(text)).err().map(|error| error.to_string());
        let with_buffers = |count: u32| {
            let variable = |i: u32| format!("@group(0) @binding({i}) var<storage, read_write> b{i}: u32;\n");
            let variables: String = (0..count).map(variable).collect();
            let writes: String = (0..count).map(|i| format!("b{i} = {i}u; ")).collect();
            format!("{variables}@compute @workgroup_size(64) fn main() {{ {writes} }}")
        };
        assert_eq!(said(with_buffers(4)), None);
        let error = said(with_buffers(5)).unwrap();
        assert!(error.contains("pass") && error.contains("5 storage buffers; the device allows 4"), "{error}");
        let sharing = |vectors: u32| {
            format!(
                "var<workgroup> light: array<vec4<f32>, {vectors}>;\n@group(0) @binding(0) var<storage, read_write> sum: f32;\n\
                 @compute @workgroup_size(64) fn main() {{ light[0].x = 1.0; workgroupBarrier(); sum = light[{}].x; }}",
                vectors - 1
            )
        };
        assert_eq!(said(sharing(1024)), None);
        let error = said(sharing(1025)).unwrap();
        assert!(error.contains("16400 bytes shared by a workgroup; the device has 16384"), "{error}");
    }
}
