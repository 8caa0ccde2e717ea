//! MSL for Metal.

use naga::back::msl;
use naga::valid::ModuleInfo;
use naga::{AddressSpace, Module, StorageAccess, TypeInner};

/// The text, and the entry point's name in it.
pub(super) fn write(module: &Module, info: &ModuleInfo) -> Result<(String, String), String> {
    let mut resources = msl::EntryPointResources::default();
    for (_, variable) in module.global_variables.iter() {
        let Some(place) = variable.binding else { continue };
        let slot = msl::Slot::try_from(place.binding).map_err(|error| error.to_string())?;
        let mut target = msl::BindTarget::default();
        match module.types[variable.ty].inner {
            TypeInner::Image { .. } => target.texture = Some(slot),
            TypeInner::Sampler { .. } => target.sampler = Some(msl::BindSamplerTarget::Resource(slot)),
            _ => target.buffer = Some(slot),
        }
        target.mutable = match variable.space {
            AddressSpace::Storage { access } => access.contains(StorageAccess::STORE),
            _ => matches!(
                module.types[variable.ty].inner,
                TypeInner::Image { class: naga::ImageClass::Storage { .. }, .. }
            ),
        };
        resources.resources.insert(place, target);
    }
    // Lengths of runtime-sized arrays come in a buffer of their own.
    resources.sizes_buffer = Some(30);
    let options = msl::Options {
        lang_version: (2, 4),
        per_entry_point_map: [("main".to_owned(), resources)].into(),
        fake_missing_bindings: false,
        zero_initialize_workgroup_memory: false,
        force_loop_bounding: false,
        ..msl::Options::default()
    };
    let pipeline = msl::PipelineOptions::default();
    let (text, written) = msl::write_string(module, info, &options, &pipeline).map_err(|error| error.to_string())?;
    let name = written.entry_point_names.into_iter().next().ok_or("no entry point was written")?;
    Ok((text, name.map_err(|error| error.to_string())?))
}
