//! Compiles the exported shaders with the `shaderc` crate: GLSL and HLSL.
//!
//! `cargo run --release --manifest-path benches/shaderc/Cargo.toml`, which needs cmake and ninja. The exit code is 1 when
//! one of them is refused.

#[path = "../../../shaders/tests/exported/mod.rs"]
mod exported;

use exported::{PASSES, definitions};
use shaderc::{CompileOptions, Compiler, EnvVersion, OptimizationLevel, ShaderKind, SourceLanguage, TargetEnv};
use welkin_shaders::{Language, Sources};

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
