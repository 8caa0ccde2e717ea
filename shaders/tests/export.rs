//! Passes in the languages of other engines: other compilers take them, and people can read them.

mod exported;

use std::path::Path;
use std::process::Command;

use exported::{PASSES, definitions};
use welkin_shaders::{Language, Sources};

/// Functions of `wgsl/pack.wgsl` that engines call.
const FUNCTIONS: [&str; 6] = [
    "transmittance_to_space",
    "view_transmittance",
    "sky_irradiance",
    "sun_irradiance",
    "sky_radiance",
    "ground_radiance",
];

/// What engines bind.
const RESOURCES: [&str; 5] = ["sky", "table_sampler", "transmittance_table", "irradiance_table", "scattering_table"];

fn text_of(language: Language, pass: &str) -> String {
    let exported = language.export(&Sources::embedded(), pass, &definitions());
    String::from_utf8(exported.unwrap_or_else(|error| panic!("{error}")).bytes).unwrap()
}

fn functions(language: Language) -> String {
    language.export_functions(&Sources::embedded(), "pack_functions", &definitions()).unwrap().unwrap()
}

/// What Debian's glslc says of a text; nothing where it takes it.
fn glslc(folder: &Path, name: &str, text: &str, arguments: &[&str]) -> Result<(), String> {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    let mut command = Command::new("glslc");
    command.args(["-fshader-stage=compute", "-o"]).arg(folder.join("out.spv")).args(arguments).arg(&path);
    let output = command.output().expect("glslc, which scripts/setup.sh installs");
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
}

/// The arguments of a function as its definition lists them.
fn arguments(text: &str, function: &str) -> String {
    let definition = |line: &&str| line.contains(&format!(" {function}(")) && !line.ends_with(';');
    let mut lines = text.lines().skip_while(|line| !definition(line) || line.starts_with([' ', '/']));
    let first = lines.next().unwrap().split_once('(').unwrap().1;
    // Metal's stand on lines of their own.
    let others = lines.take_while(|line| !first.contains('{') && !line.contains('{'));
    [first].into_iter().chain(others).collect()
}

#[test]
fn glslc_compiles_every_exported_pass() {
    let folder = tempfile::tempdir().unwrap();
    // SPIR-V 1.3 is the last that has the storage buffers which glslang makes of HLSL.
    let languages = [
        (Language::Glsl, "pass.comp", &["--target-env=vulkan1.3"][..]),
        (Language::Hlsl, "pass.hlsl", &["-x", "hlsl", "-fentry-point=main", "--target-env=vulkan1.1"]),
    ];
    for (language, file, arguments) in languages {
        for pass in PASSES {
            let text = text_of(language, pass);
            glslc(folder.path(), file, &text, arguments).unwrap_or_else(|said| panic!("{pass}: {said}"));
        }
        // Negative control: a name that is not there is noticed.
        let broken = text_of(language, "pack_probe").replacen("ground_radiance(", "ground_radance(", 1);
        assert!(glslc(folder.path(), file, &broken, arguments).is_err());
    }
}

#[test]
fn functions_to_include_compile_in_a_shader_of_ones_own() {
    let folder = tempfile::tempdir().unwrap();
    let image = "layout(rgba32f, binding = 9) writeonly uniform image2D picture;";
    let main = "void main() { imageStore(picture, ivec2(0), vec4(sky_radiance(2.0, 0.5, 0.7, 0.9), 1.0)); }";
    let glsl = format!("#version 450\n{}\n{image}\nlayout(local_size_x = 1) in;\n{main}\n", functions(Language::Glsl));
    glslc(folder.path(), "own.comp", &glsl, &["--target-env=vulkan1.3"]).unwrap();
    let main =
        "[numthreads(1, 1, 1)] void main() { picture[uint2(0, 0)] = float4(sky_radiance(2.0, 0.5, 0.7, 0.9), 1.0); }";
    let hlsl = format!("{}\nRWTexture2D<float4> picture : register(u9);\n{main}\n", functions(Language::Hlsl));
    glslc(folder.path(), "own.hlsl", &hlsl, &["-x", "hlsl", "-fentry-point=main", "--target-env=vulkan1.1"]).unwrap();
    let main = "@group(0) @binding(9) var<storage, read_write> light: vec3<f32>;\n\
                @compute @workgroup_size(1) fn main() { light = sky_radiance(2.0, 0.5, 0.7, 0.9); }";
    let wgsl = format!("{}\n{main}\n", functions(Language::Wgsl));
    let module = naga::front::wgsl::parse_str(&wgsl).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&wgsl)));
    let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), Default::default());
    validator.validate(&module).unwrap();
}

#[test]
fn names_and_comments_come_through_in_every_language() {
    for language in Language::ALL.into_iter().filter(|language| *language != Language::Spirv) {
        let text = functions(language);
        assert!(!text.contains("naga_oil"), "{language}");
        assert!(text.starts_with("// The sky from a pack's tables, for engines"), "{language}: {text:.80}");
        for name in FUNCTIONS {
            assert!(text.contains(&format!(" {name}(")), "{language} has no {name}");
            assert!(arguments(&text, name).contains("altitude_m"), "{language}: {}", arguments(&text, name));
        }
        // In GLSL a texture brings its sampler.
        let combined = |name: &&&str| language != Language::Glsl || **name != "table_sampler";
        for name in RESOURCES.iter().filter(combined) {
            assert!(text.contains(name), "{language} has no {name}");
        }
        assert!(text.contains("// Irradiance of the sky, without the sun itself"), "{language}");
        // An argument's number would only say that another function has one of that name.
        let listed = arguments(&text, "ground_radiance");
        assert!(!listed.contains("altitude_m_") && listed.contains("mu_s") && listed.contains("nu"), "{listed}");
    }
}

#[test]
fn metal_functions_take_textures_as_arguments_and_the_entry_point_is_not_main() {
    let exported = Language::Msl.export(&Sources::embedded(), "pack_probe", &definitions()).unwrap();
    assert_ne!(exported.entry_point, "main", "Metal reserves the name");
    let text = String::from_utf8(exported.bytes).unwrap();
    assert!(text.contains(&format!("kernel void {}(", exported.entry_point)));
    for slot in ["scattering_table [[texture(4)]]", "table_sampler [[sampler(1)]]", "sky [[buffer(0)]]"] {
        assert!(text.contains(slot), "no {slot}");
    }
}

#[test]
fn exported_spirv_is_spirv() {
    let exported = Language::Spirv.export(&Sources::embedded(), "pack_probe", &definitions()).unwrap();
    assert_eq!(exported.bytes[..4], 0x0723_0203_u32.to_le_bytes());
    let functions = Language::Spirv.export_functions(&Sources::embedded(), "pack_functions", &definitions());
    assert_eq!(functions.unwrap(), None, "SPIR-V cannot be included");
}

#[test]
fn a_language_is_known_by_its_name() {
    for language in Language::ALL {
        assert_eq!(language.name().parse(), Ok(language));
    }
    assert!("cg".parse::<Language>().unwrap_err().to_string().contains("wgsl, glsl, hlsl, msl, spirv"));
}
