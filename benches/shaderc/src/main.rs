//! Compiles the exported shaders with the `shaderc` crate: GLSL and HLSL.
//!
//! `cargo run --release --manifest-path benches/shaderc/Cargo.toml`, which needs cmake and ninja. The exit code is 1 when
//! one of them is refused.

use shaderc::{CompileOptions, Compiler, EnvVersion, OptimizationLevel, ShaderKind, SourceLanguage, TargetEnv};
use welkin_shaders::{Definition, Definitions, Language, Sources};

/// Passes that engines take.
const PASSES: [&str; 5] = ["pack_probe", "optical_depth", "first_order", "higher_order", "scattering_table"];

/// The Earth's air: two exponential scatterers and ozone, which only absorbs.
fn definitions() -> Definitions {
    let numbers = [
        ("CONSTITUENT_COUNT", 3),
        ("SCATTERING_EXPONENTIAL_END", 2),
        ("SCATTERING_TENT_END", 2),
        ("SCATTERER_COUNT", 2),
        ("ABSORBING_EXPONENTIAL_END", 2),
        ("ABSORBING_TENT_END", 3),
        ("LOBE_COUNT", 1),
        ("PROFILE_GROUP_COUNT", 2),
        ("NODE_COUNT", 10),
        ("FINE_PANELS", 64),
        ("BELOW_COUNT", 4),
        ("BAND_COUNT", 3),
        ("ABOVE_COUNT", 5),
        ("AZIMUTH_COUNT", 6),
        ("COSINE_COUNT", 12),
        ("INVOCATION_COUNT", 72),
        ("DEGREE_COUNT", 3),
        ("COEFFICIENT_COUNT", 6),
    ];
    let flags = ["AIR", "LIT", "GROUND", "MULTIPLE_SCATTERING"];
    let numbers = numbers.map(|(name, value)| (name.to_owned(), Definition::U32(value)));
    numbers.into_iter().chain(flags.map(|name| (name.to_owned(), Definition::Bool(true)))).collect()
}

/// Words of SPIR-V, or what the compiler says.
fn compile(compiler: &Compiler, language: Language, pass: &str, text: &str) -> Result<usize, String> {
    let mut options = CompileOptions::new().map_err(|error| error.to_string())?;
    let source = if language == Language::Hlsl { SourceLanguage::HLSL } else { SourceLanguage::GLSL };
    options.set_source_language(source);
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_1 as u32);
    options.set_optimization_level(OptimizationLevel::Performance);
    let compiled = compiler.compile_into_spirv(text, ShaderKind::Compute, pass, "main", Some(&options));
    compiled.map(|artifact| artifact.len() / 4).map_err(|error| error.to_string())
}

fn main() {
    let compiler = Compiler::new().expect("shaderc starts");
    let mut refused = 0;
    for language in [Language::Glsl, Language::Hlsl] {
        for pass in PASSES {
            let exported = language.export(&Sources::embedded(), pass, &definitions()).expect("the pass is exported");
            let text = String::from_utf8(exported.bytes).expect("shaders are text");
            match compile(&compiler, language, pass, &text) {
                Ok(words) => println!("{language} {pass}: {words} words of SPIR-V"),
                Err(error) => {
                    println!("{language} {pass}: {error}");
                    refused += 1;
                }
            }
            // Negative control: a text that is no shader.
            assert!(compile(&compiler, language, pass, &text.replace("void", "viod")).is_err(), "it takes anything");
        }
    }
    std::process::exit(i32::from(refused > 0));
}
