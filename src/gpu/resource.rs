//! Matches what a dispatch binds, by name, with what its pass declares.

use ash::vk::{AccessFlags2 as Memory, ImageLayout as Layout};
use bytemuck::NoUninit;
use welkin_shaders::{Access, Binding, BindingKind, Dimension};

use super::barrier::Use;
use super::buffer::{BufferKind, GpuBuffer};
use super::error::GpuError;
use super::image::GpuImage;
use super::sampler::Sampler;

/// What can be bound to a WGSL variable.
#[derive(Clone, Copy)]
pub enum Resource<'a> {
    /// A sampled or storage texture.
    Image(&'a GpuImage),
    /// A sampled texture with its sampler.
    Sampled(&'a GpuImage, &'a Sampler),
    /// A uniform or storage buffer.
    Buffer(&'a GpuBuffer),
    /// The content of a buffer of parameters for this one dispatch; copied at once.
    Data(&'a [u8]),
    /// A sampler.
    Sampler(&'a Sampler),
}

impl<'a> Resource<'a> {
    /// A parameter block for one dispatch. Its layout must be the WGSL struct's.
    pub fn data<T: NoUninit>(value: &'a T) -> Self {
        Self::Data(bytemuck::bytes_of(value))
    }

    fn describe(&self) -> String {
        match self {
            Self::Sampled(image, _) => format!("the image `{}` ({:?}) with a sampler", image.name(), image.shape()),
            Self::Image(image) => format!("the image `{}` ({:?}, {:?})", image.name(), image.shape(), image.format()),
            Self::Buffer(buffer) => {
                format!("the {:?} buffer `{}` ({} bytes)", buffer.kind(), buffer.name(), buffer.bytes())
            }
            Self::Data(data) => format!("data of {} bytes", data.len()),
            Self::Sampler(_) => "a sampler".to_owned(),
        }
    }
}

/// A declared binding with its resource.
pub(crate) struct Bound<'a> {
    pub(crate) binding: &'a Binding,
    pub(crate) resource: Resource<'a>,
    /// `None` for what no barrier is ever needed for.
    pub(crate) needs: Option<Use>,
}

impl Bound<'_> {
    /// Whether the pass reads the resource and does not fill it itself.
    pub(crate) fn only_reads(&self) -> bool {
        self.needs.is_some_and(|needs| !needs.is_write())
    }

    /// Whether two variables share a resource in a way that no barrier can order.
    fn conflicts(&self, other: &Self) -> bool {
        let image = |resource: Resource| match resource {
            Resource::Image(image) | Resource::Sampled(image, _) => Some(image.0.raw),
            _ => None,
        };
        let same = match (self.resource, other.resource) {
            (a, b) if image(a).is_some() => image(a) == image(b),
            (Resource::Buffer(a), Resource::Buffer(b)) => a.0.raw == b.0.raw,
            _ => false,
        };
        let (Some(a), Some(b)) = (self.needs, other.needs) else { return false };
        same && (a.is_write() || b.is_write() || a.layout != b.layout)
    }
}

/// Finds the resource of every declared binding.
pub(crate) fn bind<'a>(
    pass: &str,
    declared: &'a [Binding],
    given: &[(&str, Resource<'a>)],
) -> Result<Vec<Bound<'a>>, GpuError> {
    check_names(pass, declared, given)?;
    let mut bound: Vec<Bound> = Vec::with_capacity(declared.len());
    for binding in declared {
        let Some(&(_, resource)) = given.iter().find(|(name, _)| *name == binding.name) else {
            return Err(GpuError::MissingBinding { pass: pass.to_owned(), binding: binding.name.clone() });
        };
        if !fits(&binding.kind, &resource) {
            return Err(GpuError::WrongBinding {
                pass: pass.to_owned(),
                binding: binding.name.clone(),
                expected: describe(&binding.kind),
                found: resource.describe(),
            });
        }
        let next = Bound { binding, resource, needs: needs(&binding.kind) };
        if let Some(first) = bound.iter().find(|first| first.conflicts(&next)) {
            let (first, second) = (first.binding.name.clone(), binding.name.clone());
            return Err(GpuError::Aliased { pass: pass.to_owned(), first, second });
        }
        bound.push(next);
    }
    Ok(bound)
}

fn check_names(pass: &str, declared: &[Binding], given: &[(&str, Resource)]) -> Result<(), GpuError> {
    for (index, (name, _)) in given.iter().enumerate() {
        let (pass, binding) = (pass.to_owned(), (*name).to_owned());
        if !declared.iter().any(|declared| declared.name == *name) {
            let expected = declared.iter().map(|binding| binding.name.as_str()).collect::<Vec<_>>().join(", ");
            return Err(GpuError::SuperfluousBinding { pass, binding, expected });
        }
        if given[..index].iter().any(|(other, _)| other == name) {
            return Err(GpuError::DuplicateBinding { pass, binding });
        }
    }
    Ok(())
}

fn fits(kind: &BindingKind, resource: &Resource) -> bool {
    match (kind, resource) {
        (&BindingKind::UniformBuffer { size }, Resource::Buffer(buffer)) => {
            buffer.kind() == BufferKind::Uniform && buffer.bytes() >= u64::from(size)
        }
        (&BindingKind::UniformBuffer { size }, Resource::Data(data)) => data.len() == size as usize,
        (&BindingKind::StorageBuffer { writable: false, minimum_size }, Resource::Data(data)) => {
            data.len() == minimum_size as usize
        }
        (&BindingKind::StorageBuffer { minimum_size, .. }, Resource::Buffer(buffer)) => {
            buffer.kind() == BufferKind::Storage && buffer.bytes() >= u64::from(minimum_size)
        }
        (&BindingKind::SampledTexture { dimension }, Resource::Image(image)) => image.shape().dimension() == dimension,
        (&BindingKind::StorageTexture { format, dimension, .. }, Resource::Image(image)) => {
            image.shape().dimension() == dimension && image.format().storage() == Some(format)
        }
        (&BindingKind::CombinedTexture { dimension }, Resource::Sampled(image, _)) => {
            image.shape().dimension() == dimension
        }
        (BindingKind::Sampler, Resource::Sampler(_)) => true,
        _ => false,
    }
}

fn needs(kind: &BindingKind) -> Option<Use> {
    let storage = |reads: bool, writes: bool, layout: Layout| {
        let reads = if reads { Memory::SHADER_STORAGE_READ } else { Memory::NONE };
        let writes = if writes { Memory::SHADER_STORAGE_WRITE } else { Memory::NONE };
        Use::compute(reads, writes, layout)
    };
    Some(match *kind {
        BindingKind::UniformBuffer { .. } => Use::compute(Memory::UNIFORM_READ, Memory::NONE, Layout::UNDEFINED),
        BindingKind::StorageBuffer { writable, .. } => storage(true, writable, Layout::UNDEFINED),
        BindingKind::SampledTexture { .. } | BindingKind::CombinedTexture { .. } => {
            Use::compute(Memory::SHADER_SAMPLED_READ, Memory::NONE, Layout::SHADER_READ_ONLY_OPTIMAL)
        }
        BindingKind::StorageTexture { access, .. } => {
            storage(access != Access::Write, access != Access::Read, Layout::GENERAL)
        }
        BindingKind::Sampler => return None,
    })
}

fn describe(kind: &BindingKind) -> String {
    let shape = |dimension: Dimension| match dimension {
        Dimension::D1 => "1D",
        Dimension::D2 => "2D",
        Dimension::D2Array => "2D array",
        Dimension::D3 => "3D",
    };
    match *kind {
        BindingKind::UniformBuffer { size } => format!("a uniform buffer of {size} bytes"),
        BindingKind::StorageBuffer { minimum_size, .. } => format!("a storage buffer of at least {minimum_size} bytes"),
        BindingKind::SampledTexture { dimension } => format!("a {} texture", shape(dimension)),
        BindingKind::CombinedTexture { dimension } => format!("a {} texture with a sampler", shape(dimension)),
        BindingKind::StorageTexture { format, dimension, .. } => {
            format!("a {} storage texture of {format:?}", shape(dimension))
        }
        BindingKind::Sampler => "a sampler".to_owned(),
    }
}
