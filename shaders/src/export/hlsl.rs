//! HLSL for Direct3D.

use naga::Module;
use naga::back::hlsl;
use naga::valid::ModuleInfo;

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
    Ok(with_plain_samplers(&with_listed_zeros(&text)))
}

/// naga reads samplers from a heap by indices in a buffer, as wgpu lays them out. Here each is a sampler in its register.
fn with_plain_samplers(text: &str) -> String {
    let is_heap = |line: &str| {
        line.contains("nagaSamplerHeap[2048]")
            || line.contains("nagaComparisonSamplerHeap[2048]")
            || line.starts_with("StructuredBuffer<uint> nagaGroup")
    };
    let plain = |line: &str| {
        let (name, place) =
            line.strip_prefix("static const SamplerState ")?.split_once(" = nagaSamplerHeap[nagaGroup")?;
        let (group, register) = place.strip_suffix("]];")?.split_once("SamplerIndexArray[")?;
        Some(format!("SamplerState {name} : register(s{register}, space{group});"))
    };
    let lines = text.lines().filter(|line| !is_heap(line));
    lines.map(|line| plain(line).unwrap_or_else(|| line.to_owned()) + "\n").collect()
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
    use super::{with_listed_zeros, with_plain_samplers};

    #[test]
    fn zeros_of_an_array_are_listed() {
        let text = "    float3 y[2] = (float3[2])0;\n    float3 z = (float3)0;\n";
        let listed = "    float3 y[2] = { (float3)0, (float3)0 };\n    float3 z = (float3)0;\n";
        assert_eq!(with_listed_zeros(text), listed);
    }

    #[test]
    fn a_sampler_of_the_heap_becomes_one_of_its_own_by_the_name_that_it_has_there() {
        let text = "SamplerState nagaSamplerHeap[2048]: register(s0, space0);\n\
                    StructuredBuffer<uint> nagaGroup0SamplerIndexArray : register(t99, space0);\n\
                    static const SamplerState table_sampler_1 = nagaSamplerHeap[nagaGroup0SamplerIndexArray[3]];\n";
        assert_eq!(with_plain_samplers(text), "SamplerState table_sampler_1 : register(s3, space0);\n");
    }
}
