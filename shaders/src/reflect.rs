//! What a compiled pass asks of its host: bindings, and the layouts of its structs.

use naga::proc::Layouter;
use naga::{AddressSpace, GlobalVariable, Handle, ImageClass, ImageDimension, Module, ScalarKind, TypeInner};

use crate::ShaderError;
use crate::compose::undecorated;

/// A resource that a pass uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    /// The WGSL variable's name.
    pub name: String,
    /// `@group`.
    pub group: u32,
    /// `@binding`.
    pub index: u32,
    /// What is to be bound.
    pub kind: BindingKind,
}

/// The kinds of resources.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindingKind {
    /// `var<uniform>`.
    UniformBuffer {
        /// Bytes that the pass may read.
        size: u32,
    },
    /// `var<storage>`.
    StorageBuffer {
        /// Whether it is declared `read_write`.
        writable: bool,
        /// Bytes that must be there: a runtime-sized array counts as one element.
        minimum_size: u32,
    },
    /// A sampled texture of floating-point values.
    SampledTexture {
        /// Its shape.
        dimension: Dimension,
    },
    /// A texture with its sampler, as GLSL has them; WGSL has none.
    CombinedTexture {
        /// Its shape.
        dimension: Dimension,
    },
    /// A storage texture.
    StorageTexture {
        /// Texel format.
        format: naga::StorageFormat,
        /// How it is declared.
        access: Access,
        /// Its shape.
        dimension: Dimension,
    },
    /// A sampler without comparison.
    Sampler,
}

/// Shapes of textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// One row.
    D1,
    /// An image.
    D2,
    /// Layers of images, not filtered across.
    D2Array,
    /// A volume.
    D3,
}

/// What a pass does with a storage texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Reads only.
    Read,
    /// Writes only.
    Write,
    /// Both.
    ReadWrite,
}

/// A WGSL struct as it lies in memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StructLayout {
    /// Bytes from one element of an array of it to the next.
    pub size: u32,
    /// Members in order.
    pub fields: Vec<Field>,
}

/// A member of a struct.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Bytes from the struct's start.
    pub offset: u32,
    /// Its own bytes, without padding that follows.
    pub size: u32,
}

/// Bindings that are used, in the order of group and index.
pub(crate) fn bindings(
    file: &str,
    module: &Module,
    used: impl Fn(Handle<GlobalVariable>) -> bool,
) -> Result<Vec<Binding>, ShaderError> {
    let mut bindings: Vec<Binding> = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let Some(resource) = variable.binding.filter(|_| used(handle)) else { continue };
        let name = undecorated(variable.name.as_deref().unwrap_or_default());
        let refuse = |reason: String| ShaderError::Binding { file: file.to_owned(), binding: name.clone(), reason };
        let kind = kind(module, variable).map_err(refuse)?;
        if bindings.iter().any(|other| other.name == name) {
            return Err(refuse("two variables of this name are in use; resources are bound by name".to_owned()));
        }
        bindings.push(Binding { name, group: resource.group, index: resource.binding, kind });
    }
    bindings.sort_by_key(|binding| (binding.group, binding.index));
    Ok(bindings)
}

fn kind(module: &Module, variable: &GlobalVariable) -> Result<BindingKind, String> {
    let inner = &module.types[variable.ty].inner;
    let size = || inner.size(module.to_ctx());
    match (variable.space, inner) {
        (AddressSpace::Uniform, _) => Ok(BindingKind::UniformBuffer { size: size() }),
        (AddressSpace::Storage { access }, _) => {
            let writable = access.contains(naga::StorageAccess::STORE);
            Ok(BindingKind::StorageBuffer { writable, minimum_size: size() })
        }
        (_, &TypeInner::Image { dim, arrayed, class }) => texture_kind(dim, arrayed, class),
        (_, &TypeInner::Sampler { comparison: false }) => Ok(BindingKind::Sampler),
        _ => Err("only buffers, textures and samplers without comparison are served".to_owned()),
    }
}

fn texture_kind(dim: ImageDimension, arrayed: bool, class: ImageClass) -> Result<BindingKind, String> {
    let dimension = match (dim, arrayed) {
        (ImageDimension::D1, false) => Dimension::D1,
        (ImageDimension::D2, false) => Dimension::D2,
        (ImageDimension::D2, true) => Dimension::D2Array,
        (ImageDimension::D3, false) => Dimension::D3,
        _ => return Err("only 1D, 2D, 2D array and 3D textures are served".to_owned()),
    };
    match class {
        ImageClass::Sampled { kind: ScalarKind::Float, multi: false } => Ok(BindingKind::SampledTexture { dimension }),
        ImageClass::Storage { format, access } => {
            let (load, store) = (naga::StorageAccess::LOAD, naga::StorageAccess::STORE);
            let access = match (access.contains(load), access.contains(store)) {
                (true, true) => Access::ReadWrite,
                (true, false) => Access::Read,
                _ => Access::Write,
            };
            Ok(BindingKind::StorageTexture { format, access, dimension })
        }
        _ => Err("sampled textures must be of floating point and have one sample".to_owned()),
    }
}

/// All named structs of a module.
pub(crate) fn structs(module: &Module) -> Result<Vec<(String, StructLayout)>, String> {
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).map_err(|error| error.to_string())?;
    let layout = |handle, members: &[naga::StructMember]| {
        let field = |member: &naga::StructMember| Field {
            name: member.name.clone().unwrap_or_default(),
            offset: member.offset,
            size: layouter[member.ty].size,
        };
        StructLayout { size: layouter[handle].to_stride(), fields: members.iter().map(field).collect() }
    };
    Ok(module
        .types
        .iter()
        .filter_map(|(handle, ty)| match (&ty.name, &ty.inner) {
            (Some(name), TypeInner::Struct { members, .. }) => Some((undecorated(name), layout(handle, members))),
            _ => None,
        })
        .collect())
}
