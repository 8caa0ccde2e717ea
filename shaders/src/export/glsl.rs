//! GLSL for Vulkan and OpenGL.

use naga::back::glsl;
use naga::proc::BoundsCheckPolicies;
use naga::valid::ModuleInfo;
use naga::{Module, ShaderStage};

use super::names::rename;

/// naga names resources by their place and stage; here they get the WGSL's names back.
pub(super) fn write(module: &Module, info: &ModuleInfo) -> Result<String, String> {
    let resources = || module.global_variables.iter().filter_map(|(_, variable)| Some((variable, variable.binding?)));
    let binding_map = resources()
        .map(|(_, place)| Ok((place, u8::try_from(place.binding)?)))
        .collect::<Result<_, std::num::TryFromIntError>>()
        .map_err(|error| error.to_string())?;
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        writer_flags: glsl::WriterFlags::empty(),
        binding_map,
        zero_initialize_workgroup_memory: false,
    };
    let pipeline =
        glsl::PipelineOptions { shader_stage: ShaderStage::Compute, entry_point: "main".to_owned(), multiview: None };
    let mut text = String::new();
    let writer = glsl::Writer::new(&mut text, module, info, &options, &pipeline, BoundsCheckPolicies::default());
    writer.and_then(|mut writer| writer.write()).map_err(|error| error.to_string())?;
    for (variable, place) in resources() {
        let written = format!("_group_{}_binding_{}_cs", place.group, place.binding);
        text = rename(&text, &written, variable.name.as_deref().unwrap_or(&written));
    }
    Ok(text)
}
