//! HLSL for Direct3D.

use naga::back::hlsl;
use naga::valid::ModuleInfo;
use naga::{Module, TypeInner};

pub(super) fn write(module: &Module, info: &ModuleInfo) -> Result<String, String> {
    let mut options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V5_1,
        fake_missing_bindings: false,
        zero_initialize_workgroup_memory: false,
        restrict_indexing: false,
        force_loop_bounding: false,
        ..hlsl::Options::default()
    };
    for (_, variable) in module.global_variables.iter() {
        let Some(place) = variable.binding else { continue };
        let space = u8::try_from(place.group).map_err(|error| error.to_string())?;
        let target = hlsl::BindTarget { space, register: place.binding, ..hlsl::BindTarget::default() };
        options.binding_map.insert(place, target);
        let key = hlsl::SamplerIndexBufferKey { group: place.group };
        options.sampler_buffer_binding_map.entry(key).or_insert(hlsl::BindTarget { space, register: 99, ..target });
    }
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    let written = hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None);
    written.map_err(|error| error.to_string())?;
    Ok(with_plain_samplers(&with_listed_zeros(&text), module))
}

/// naga reads samplers from a heap by indices in a buffer, as wgpu lays them out. Here each is a sampler in its register.
fn with_plain_samplers(text: &str, module: &Module) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines.retain(|line| !(line.contains("nagaSamplerHeap[2048]") || line.contains("nagaComparisonSamplerHeap[2048]")));
    lines.retain(|line| !line.starts_with("StructuredBuffer<uint> nagaGroup"));
    for (_, variable) in module.global_variables.iter() {
        let (Some(place), Some(name)) = (variable.binding, &variable.name) else { continue };
        if matches!(module.types[variable.ty].inner, TypeInner::Sampler { .. }) {
            let start = format!("static const SamplerState {name} ");
            let plain = format!("SamplerState {name} : register(s{}, space{});", place.binding, place.group);
            lines.iter_mut().filter(|line| line.starts_with(&start)).for_each(|line| line.clone_from(&plain));
        }
    }
    format!("{}\n", lines.join("\n"))
}

/// naga casts zero to an array, which Microsoft's compilers take and glslang does not; all take a list of zeros.
fn with_listed_zeros(text: &str) -> String {
    let listed = |line: &str| {
        let (variable, cast) = line.split_once(" = (")?;
        let (ty, length) = cast.strip_suffix("])0;")?.split_once('[')?;
        let zeros = vec![format!("({ty})0"); length.parse().ok()?];
        Some(format!("{variable} = {{ {} }};", zeros.join(", ")))
    };
    text.lines().map(|line| listed(line).unwrap_or_else(|| line.to_owned()) + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::with_listed_zeros;

    #[test]
    fn zeros_of_an_array_are_listed() {
        let text = "    float3 y[2] = (float3[2])0;\n    float3 z = (float3)0;\n";
        let listed = "    float3 y[2] = { (float3)0, (float3)0 };\n    float3 z = (float3)0;\n";
        assert_eq!(with_listed_zeros(text), listed);
    }
}
