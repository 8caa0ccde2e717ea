//! From a pass's name to SPIR-V and what its host must know.

use std::collections::BTreeMap;

use naga::back::spv;
use naga::compact::{KeepUnused, compact};
use naga::proc::{LayoutError, Layouter};
use naga::valid::{ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, ShaderStage, StorageAccess};

use crate::{Binding, ShaderError, Sources, StructLayout, compose, reflect};

/// Names that a pass's source is specialised by.
pub type Definitions = BTreeMap<String, Definition>;

/// A definition's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Definition {
    /// `true` satisfies `#ifdef`; `false` is the same as no definition.
    Bool(bool),
    /// A signed integer, for `#{NAME}` and `#if NAME < 3`.
    I32(i32),
    /// An unsigned integer, likewise; `#{NAME}` puts its digits, without the suffix `u`.
    U32(u32),
}

/// Where a compiled pass finds what its WGSL declares as `var<uniform>`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ParameterBuffers {
    /// In uniform buffers.
    #[default]
    Uniform,
    /// In storage buffers of the same layout that are only read.
    Storage,
}

/// A compiled pass.
#[derive(Debug, Clone)]
pub struct Shader {
    /// The pass's name: its file's stem.
    pub name: String,
    /// SPIR-V 1.3, with names.
    pub spirv: Vec<u32>,
    /// The entry point, always a compute stage.
    pub entry_point: String,
    /// `@workgroup_size`.
    pub workgroup_size: [u32; 3],
    /// Memory that a workgroup shares; of a foreign shader it is not known, and 0.
    pub workgroup_bytes: u32,
    /// The resources that the entry point uses, in the order of group and index.
    pub bindings: Vec<Binding>,
    structs: BTreeMap<String, StructLayout>,
    /// Whether naga has made the SPIR-V, from a module that it has validated.
    pub(crate) trusted: bool,
}

/// Compiles a pass that is embedded in this crate.
///
/// # Errors
/// As [`Shader::from_sources`].
pub fn compile(pass: &str, definitions: &Definitions) -> Result<Shader, ShaderError> {
    Shader::from_sources(&Sources::embedded(), pass, definitions)
}

impl Shader {
    /// Compiles a pass of a set of sources.
    ///
    /// # Errors
    /// Any [`ShaderError`] but [`ShaderError::Unreadable`]; what is wrong in the WGSL comes with file, line and column,
    /// also where the fault is in an imported module.
    pub fn from_sources(sources: &Sources, pass: &str, definitions: &Definitions) -> Result<Self, ShaderError> {
        Self::with_parameters(sources, pass, definitions, ParameterBuffers::Uniform)
    }

    /// The same with parameters in another kind of buffers.
    ///
    /// # Errors
    /// As [`Shader::from_sources`].
    pub fn with_parameters(
        sources: &Sources,
        pass: &str,
        definitions: &Definitions,
        buffers: ParameterBuffers,
    ) -> Result<Self, ShaderError> {
        let Entry { file, mut module, mut info, structs } = Entry::of(sources, pass, definitions)?;
        let spirv_error = |message: String| ShaderError::Spirv { file: file.clone(), message };
        if buffers == ParameterBuffers::Storage {
            move_uniforms_to_storage(&mut module);
            info = validate(&module).map_err(spirv_error)?;
        }
        let entry = &module.entry_points[0];
        let uses = info.get_entry_point(0);
        let bindings = reflect::bindings(&file, &module, |variable| !uses[variable].is_empty())?;
        let spirv = spirv(&module, &info).map_err(|error| spirv_error(error.to_string()))?;
        Ok(Self {
            name: pass.to_owned(),
            spirv,
            entry_point: entry.name.clone(),
            workgroup_size: entry.workgroup_size,
            workgroup_bytes: workgroup_bytes(&module).map_err(|error| spirv_error(error.to_string()))?,
            bindings,
            structs,
            trusted: true,
        })
    }

    /// A compute shader that another compiler has made. Nothing is checked, so that a host can only run it where it
    /// answers for it.
    pub fn foreign(name: &str, spirv: Vec<u32>, workgroup_size: [u32; 3], bindings: Vec<Binding>) -> Self {
        let (name, entry_point) = (name.to_owned(), "main".to_owned());
        Self {
            name,
            spirv,
            entry_point,
            workgroup_size,
            workgroup_bytes: 0,
            bindings,
            structs: BTreeMap::new(),
            trusted: false,
        }
    }

    /// Whether this crate has compiled it.
    pub fn is_trusted(&self) -> bool {
        self.trusted
    }

    /// The layout of a WGSL struct that the pass or a module it imports declares, by its name.
    pub fn struct_layout(&self, name: &str) -> Option<&StructLayout> {
        self.structs.get(name)
    }
}

/// A pass's entry point with what it uses, valid by naga's rules.
pub(crate) struct Entry {
    pub(crate) file: String,
    pub(crate) module: naga::Module,
    pub(crate) info: ModuleInfo,
    structs: BTreeMap<String, StructLayout>,
}

impl Entry {
    pub(crate) fn of(sources: &Sources, pass: &str, definitions: &Definitions) -> Result<Self, ShaderError> {
        let (file, mut module) = compose::compose(sources, pass, definitions)?;
        let entry =
            module.entry_points.iter().find(|entry| entry.name == "main" && entry.stage == ShaderStage::Compute);
        let Some(entry) = entry.cloned() else { return Err(ShaderError::NoEntryPoint { file }) };
        module.entry_points = vec![entry];
        let spirv_error = |message: String| ShaderError::Spirv { file: file.clone(), message };
        let structs = reflect::structs(&module).map_err(spirv_error)?.into_iter().collect();
        compact(&mut module, KeepUnused::No);
        let info = validate(&module).map_err(spirv_error)?;
        Ok(Self { file, module, info, structs })
    }
}

/// The layout rules of uniform buffers are the stricter ones, so that nothing moves within them.
fn move_uniforms_to_storage(module: &mut naga::Module) {
    for (_, variable) in module.global_variables.iter_mut() {
        if variable.space == AddressSpace::Uniform {
            variable.space = AddressSpace::Storage { access: StorageAccess::LOAD };
        }
    }
}

/// Bytes of a module's variables that workgroups share.
fn workgroup_bytes(module: &naga::Module) -> Result<u32, LayoutError> {
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx())?;
    let shared = module.global_variables.iter().filter(|(_, variable)| variable.space == AddressSpace::WorkGroup);
    Ok(shared.map(|(_, variable)| layouter[variable.ty].to_stride()).sum())
}

/// Checks a module by naga's rules.
pub(crate) fn validate(module: &naga::Module) -> Result<ModuleInfo, String> {
    let mut validator = Validator::new(ValidationFlags::all(), naga::valid::Capabilities::default());
    validator.validate(module).map_err(|error| error.to_string())
}

pub(crate) fn spirv(module: &naga::Module, info: &ModuleInfo) -> Result<Vec<u32>, spv::Error> {
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::DEBUG,
        fake_missing_bindings: false,
        // Welkin's own loops end; a counter in each would cost time. Out-of-bounds access is left to the device's
        // robust access, which the host turns on.
        force_loop_bounding: false,
        // Passes write all that a workgroup shares before they read it. naga would fill it with zeros, one invocation all of
        // it: drivers write that out store by store, and took longer to compile it than the rest of the pass.
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        binding_map: identity_bindings(module),
        ..spv::Options::default()
    };
    spv::write_vec(module, info, &options, None)
}

/// Set and binding numbers in SPIR-V are those of the WGSL.
fn identity_bindings(module: &naga::Module) -> spv::BindingMap {
    let resources = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    resources
        .map(|resource| {
            let (descriptor_set, binding) = (resource.group, resource.binding);
            (resource, spv::BindingInfo { descriptor_set, binding, binding_array_size: None })
        })
        .collect()
}
