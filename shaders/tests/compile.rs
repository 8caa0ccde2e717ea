//! Passes compile to SPIR-V that says what it needs, and faults are reported where they are.

use std::collections::BTreeSet;

use welkin_shaders::{
    Access, Binding, BindingKind, Definition, Definitions, Dimension, Field, Shader, ShaderError, Sources,
    StorageFormat,
};

const OPTICS: &str = "\
#define_import_path test::optics

struct Medium {
    scattering: vec3<f32>,
    scale_height: f32,
    weights: array<vec4<f32>, 2>,
    density: f32,
}

@group(0) @binding(0) var<uniform> medium: Medium;
@group(0) @binding(7) var<storage, read> never_used: array<f32>;

fn optical_depth(path_length: f32) -> vec3<f32> {
    let density = medium.density * path_length;
    return medium.scattering * density;
}
";

const PASS: &str = "\
// A pass with one binding of each kind.
#import test::optics::optical_depth

@group(0) @binding(1) var table: texture_2d_array<f32>;
@group(0) @binding(2) var table_sampler: sampler;
@group(0) @binding(3) var picture: texture_storage_2d<rgba32float, write>;
@group(1) @binding(0) var<storage, read_write> radiance: array<vec4<f32>>;
@group(1) @binding(1) var volume: texture_storage_3d<r32float, read_write>;

@compute @workgroup_size(8, 4, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = textureSampleLevel(table, table_sampler, vec2<f32>(0.5), 1u, 0.0);
#ifdef ATTENUATED
    let depth = optical_depth(f32(#{STEPS}));
#else
    let depth = vec3<f32>(0.0);
#endif
    let old = textureLoad(volume, id);
    textureStore(volume, id, old + texel);
    textureStore(picture, id.xy, vec4<f32>(exp(-depth), 1.0));
    radiance[id.x] = texel;
}
";

fn sources() -> Sources {
    Sources::default().with("optics.wgsl", OPTICS).with("pass.wgsl", PASS)
}

fn attenuated() -> Definitions {
    Definitions::from([("ATTENUATED".to_owned(), Definition::Bool(true)), ("STEPS".to_owned(), Definition::U32(16))])
}

fn located(error: ShaderError) -> (String, usize, usize, String, String) {
    match error {
        ShaderError::Wgsl { location, message } => {
            (location.file, location.line, location.column, location.source_line, message)
        }
        other => panic!("expected an error with a location, got: {other}"),
    }
}

/// The names between `before` and the end of a word, in all shipped WGSL.
fn names_after(before: &str) -> BTreeSet<String> {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/wgsl");
    let files = std::fs::read_dir(directory).unwrap().map(|entry| std::fs::read_to_string(entry.unwrap().path()));
    let text: String = files.map(Result::unwrap).collect();
    let word = |rest: &str| rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
    text.split(before).skip(1).map(word).filter(|name: &String| name != "NAME").collect()
}

#[test]
fn every_shipped_pass_compiles_with_no_switch_with_each_and_with_all() {
    let numbers: Definitions = names_after("#{").into_iter().map(|name| (name, Definition::U32(16))).collect();
    let switches: Vec<String> = names_after("#ifdef ").into_iter().collect();
    let passes: Vec<String> = Sources::embedded().passes().map(str::to_owned).collect();
    assert!(!passes.is_empty() && !switches.is_empty(), "nothing would be tested");
    for pass in &passes {
        for chosen in [&[], &switches[..]].into_iter().chain(switches.chunks(1)) {
            let mut definitions = numbers.clone();
            definitions.extend(chosen.iter().map(|name| (name.clone(), Definition::Bool(true))));
            let shader = welkin_shaders::compile(pass, &definitions);
            shader.unwrap_or_else(|error| panic!("{pass} with {definitions:?}: {error}"));
        }
    }
}

#[test]
fn bindings_carry_their_names_and_kinds_and_only_the_used_ones_are_listed() {
    let shader = Shader::from_sources(&sources(), "pass", &attenuated()).unwrap();
    let binding = |name: &str, group, index, kind| Binding { name: name.to_owned(), group, index, kind };
    let (format, access) = (StorageFormat::Rgba32Float, Access::Write);
    let picture = BindingKind::StorageTexture { format, access, dimension: Dimension::D2 };
    let (format, access) = (StorageFormat::R32Float, Access::ReadWrite);
    let volume = BindingKind::StorageTexture { format, access, dimension: Dimension::D3 };
    let expected = [
        binding("medium", 0, 0, BindingKind::UniformBuffer { size: 64 }),
        binding("table", 0, 1, BindingKind::SampledTexture { dimension: Dimension::D2Array }),
        binding("table_sampler", 0, 2, BindingKind::Sampler),
        binding("picture", 0, 3, picture),
        binding("radiance", 1, 0, BindingKind::StorageBuffer { writable: true, minimum_size: 16 }),
        binding("volume", 1, 1, volume),
    ];
    assert_eq!(shader.bindings, expected);
    assert_eq!(shader.workgroup_size, [8, 4, 1]);
    assert_eq!(shader.entry_point, "main");
    assert_eq!(shader.spirv[0], 0x0723_0203, "the first word of SPIR-V");
}

#[test]
fn a_definition_changes_what_is_compiled_and_false_is_the_same_as_none() {
    let names = |definitions: &Definitions| {
        let shader = Shader::from_sources(&sources(), "pass", definitions).unwrap();
        shader.bindings.into_iter().map(|binding| binding.name).collect::<Vec<_>>()
    };
    assert!(names(&attenuated()).contains(&"medium".to_owned()));
    let mut off = attenuated();
    off.insert("ATTENUATED".to_owned(), Definition::Bool(false));
    assert!(!names(&off).contains(&"medium".to_owned()));
    assert_eq!(names(&off), names(&Definitions::new()));
}

#[test]
fn structs_of_imported_modules_have_their_wgsl_layout() {
    let shader = Shader::from_sources(&sources(), "pass", &attenuated()).unwrap();
    let field = |name: &str, offset, size| Field { name: name.to_owned(), offset, size };
    let layout = shader.struct_layout("Medium").unwrap();
    // WGSL 14.4: vec3 aligns to 16 and leaves 4 bytes for a following f32.
    let fields = [field("scattering", 0, 12), field("scale_height", 12, 4), field("weights", 16, 32)];
    assert_eq!(layout.fields[..3], fields);
    assert_eq!(layout.fields[3], field("density", 48, 4));
    assert_eq!(layout.size, 64);
    assert_eq!(shader.struct_layout("Absent"), None);
}

#[test]
fn an_unknown_identifier_in_an_imported_module_is_reported_there() {
    let broken = OPTICS.replace("medium.scattering * density", "medium.scattering * densty");
    let sources = sources().with("optics.wgsl", broken);
    let error = Shader::from_sources(&sources, "pass", &attenuated()).unwrap_err();
    let text = error.to_string();
    let (file, line, column, source_line, message) = located(error);
    assert_eq!((file.as_str(), line, column), ("optics.wgsl", 15, 32));
    assert_eq!(source_line, "    return medium.scattering * densty;");
    assert!(message.contains("densty"), "{message}");
    assert!(text.starts_with("optics.wgsl:15:32: in `return medium.scattering * densty;`: "), "{text}");
}

#[test]
fn an_unknown_identifier_in_a_pass_is_reported_at_its_column_despite_imports_and_definitions() {
    let broken = PASS.replace("optical_depth(f32(#{STEPS}))", "optical_depth(f32(#{STEPS})) + lenght");
    let sources = sources().with("pass.wgsl", broken);
    let (file, line, column, _, message) = located(Shader::from_sources(&sources, "pass", &attenuated()).unwrap_err());
    assert_eq!((file.as_str(), line, column), ("pass.wgsl", 14, 48));
    assert!(message.contains("lenght") && !message.contains("naga_oil"), "{message}");
}

#[test]
fn a_type_error_is_reported_with_its_file_and_line() {
    let broken = OPTICS.replace("return medium.scattering * density;", "return vec2<f32>(density);");
    let sources = sources().with("optics.wgsl", broken);
    let (file, line, _, source_line, _) = located(Shader::from_sources(&sources, "pass", &attenuated()).unwrap_err());
    assert_eq!((file.as_str(), line), ("optics.wgsl", 15), "{source_line}");
}

#[test]
fn a_validation_error_in_a_pass_is_reported_with_its_line() {
    let broken = PASS.replace("textureStore(picture, id.xy,", "textureStore(picture, id.xyz + id,");
    let sources = sources().with("pass.wgsl", broken);
    let (file, line, _, source_line, message) =
        located(Shader::from_sources(&sources, "pass", &attenuated()).unwrap_err());
    assert_eq!((file.as_str(), line), ("pass.wgsl", 20), "{source_line}: {message}");
}

#[test]
fn a_missing_import_is_reported_where_it_is_used() {
    let sources = Sources::default().with("pass.wgsl", PASS);
    let (file, line, _, _, message) = located(Shader::from_sources(&sources, "pass", &attenuated()).unwrap_err());
    assert_eq!((file.as_str(), line), ("pass.wgsl", 14));
    assert!(message.contains("test::optics"), "{message}");
}

#[test]
fn modules_that_import_each_other_are_named_in_a_chain() {
    let a = "#define_import_path a\n#import b\nfn f() -> f32 { return b::g(); }\n";
    let b = "#define_import_path b\n#import a\nfn g() -> f32 { return a::f(); }\n";
    let pass = "#import a\n@compute @workgroup_size(1) fn main() { _ = a::f(); }\n";
    let sources = Sources::default().with("a.wgsl", a).with("b.wgsl", b).with("pass.wgsl", pass);
    let error = Shader::from_sources(&sources, "pass", &Definitions::new()).unwrap_err();
    assert!(matches!(&error, ShaderError::ImportCycle { chain } if chain == "a -> b -> a"), "{error}");
}

#[test]
fn a_pass_without_the_entry_point_main_is_an_error() {
    let sources = Sources::default().with("pass.wgsl", "@compute @workgroup_size(1) fn run() {}\n");
    let error = Shader::from_sources(&sources, "pass", &Definitions::new()).unwrap_err();
    assert!(matches!(error, ShaderError::NoEntryPoint { .. }), "{error}");
}

#[test]
fn two_variables_in_one_place_or_of_one_name_are_errors() {
    let one_name = sources().with("pass.wgsl", PASS.replace("table_sampler", "medium"));
    let error = Shader::from_sources(&one_name, "pass", &attenuated()).unwrap_err();
    assert!(matches!(&error, ShaderError::Binding { binding, .. } if binding == "medium"), "{error}");

    let one_place = PASS.replace("@group(0) @binding(1)", "@group(0) @binding(0)");
    let one_place = sources().with("pass.wgsl", one_place);
    let (file, line, _, _, message) = located(Shader::from_sources(&one_place, "pass", &attenuated()).unwrap_err());
    assert_eq!((file.as_str(), line), ("pass.wgsl", 4));
    assert!(message.contains("conflict"), "{message}");
}

#[test]
fn sources_of_a_directory_are_read_anew() {
    let directory = std::env::temp_dir().join(format!("welkin-shaders-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    std::fs::write(directory.join("optics.wgsl"), OPTICS).unwrap();
    std::fs::write(directory.join("pass.wgsl"), PASS.replace("exp(-depth)", "exp(-dpth)")).unwrap();
    let compile = || Shader::from_sources(&Sources::from_directory(&directory).unwrap(), "pass", &attenuated());
    let error = compile().unwrap_err().to_string();
    std::fs::write(directory.join("pass.wgsl"), PASS).unwrap();
    let mended = compile();
    std::fs::remove_dir_all(&directory).unwrap();
    assert!(error.contains(&format!("{}/pass.wgsl:20:", directory.display())), "{error}");
    mended.unwrap();
}

#[test]
fn what_a_workgroup_shares_is_not_filled_with_zeros() {
    let text = "var<workgroup> field: array<vec4<f32>, 8>;\n@group(0) @binding(0) var<storage, read_write> sum: vec4<f32>;\n\
                @compute @workgroup_size(8) fn main(@builtin(local_invocation_index) i: u32) {\n\
                field[i] = vec4<f32>(1.0); workgroupBarrier(); sum = field[7u - i]; }";
    let sources = Sources::default().with("pass.wgsl", text);
    let shader = Shader::from_sources(&sources, "pass", &Definitions::new()).unwrap();
    // Instructions follow five words of header: a first word's low half is the operation, its high half the words that it takes.
    let count = |spirv: &[u32], operation: u32| {
        let mut rest = &spirv[5..];
        let mut count = 0;
        while let Some(&word) = rest.first() {
            count += usize::from(word & 0xffff == operation);
            rest = &rest[(word >> 16) as usize..];
        }
        count
    };
    let (constant_null, control_barrier) = (46, 224);
    assert_eq!(count(&shader.spirv, control_barrier), 1, "a barrier behind zeros would be another");
    assert_eq!(count(&shader.spirv, constant_null), 0);
}
