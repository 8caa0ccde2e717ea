//! Passes in the languages of other engines, by naga's writers.
//!
//! Names are those of the WGSL, and so are binding numbers: `@group(g) @binding(b)` is set g, binding b in GLSL and
//! SPIR-V, register b of space g in HLSL, and slot b of its kind in MSL.

mod glsl;
mod hlsl;
mod msl;
mod names;

use std::fmt;
use std::str::FromStr;

use naga::back::wgsl;

use crate::shader::{Entry, spirv, validate};
use crate::{Definitions, ShaderError, Sources};

/// A language that passes can be written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Language {
    /// WebGPU's, in one file without imports.
    Wgsl,
    /// OpenGL's and Vulkan's, version 450; a texture and its sampler are one variable.
    Glsl,
    /// Direct3D's, shader model 5.1.
    Hlsl,
    /// Metal's, version 2.4; textures, samplers and buffers are arguments of the functions.
    Msl,
    /// Vulkan's, version 1.3.
    Spirv,
}

/// A pass in another language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exported {
    /// The file's content: text in UTF-8, or SPIR-V's words in little-endian order.
    pub bytes: Vec<u8>,
    /// What the entry point is called; MSL does not allow `main`.
    pub entry_point: String,
}

/// A language of that name cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("language is '{0}'; it must be one of wgsl, glsl, hlsl, msl, spirv")]
pub struct UnknownLanguage(String);

impl Language {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Wgsl, Self::Glsl, Self::Hlsl, Self::Msl, Self::Spirv];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::Hlsl => "hlsl",
            Self::Msl => "msl",
            Self::Spirv => "spirv",
        }
    }

    /// How names of its files end, without the dot. `.comp` is what compilers know GLSL's compute stage by.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "comp",
            Self::Hlsl => "hlsl",
            Self::Msl => "metal",
            Self::Spirv => "spv",
        }
    }

    /// Writes a pass.
    ///
    /// # Errors
    /// As [`crate::compile`]; [`ShaderError::Export`] for what the language cannot say.
    pub fn export(self, sources: &Sources, pass: &str, definitions: &Definitions) -> Result<Exported, ShaderError> {
        let Entry { file, mut module, .. } = Entry::of(sources, pass, definitions)?;
        let failed = |message: String| ShaderError::Export { file: file.clone(), language: self.name(), message };
        names::make_readable(&mut module);
        let info = validate(&module).map_err(failed)?;
        let mut entry_point = "main".to_owned();
        let text = match self {
            Self::Wgsl => wgsl::write_string(&module, &info, wgsl::WriterFlags::empty()).map_err(|e| e.to_string()),
            Self::Glsl => glsl::write(&module, &info),
            Self::Hlsl => hlsl::write(&module, &info),
            Self::Msl => msl::write(&module, &info).map(|(text, name)| {
                entry_point = name;
                text
            }),
            Self::Spirv => {
                let words = spirv(&module, &info).map_err(|error| failed(error.to_string()))?;
                return Ok(Exported { bytes: words.iter().flat_map(|word| word.to_le_bytes()).collect(), entry_point });
            }
        };
        let text = names::restored(&text.map_err(failed)?, sources, pass);
        Ok(Exported { bytes: text.into_bytes(), entry_point })
    }

    /// Writes what a pass calls, without its entry point: functions to include in shaders of one's own, under the legend
    /// of the module that the pass imports first. None in SPIR-V, which knows only entry points.
    ///
    /// # Errors
    /// As [`Language::export`].
    pub fn export_functions(
        self,
        sources: &Sources,
        pass: &str,
        definitions: &Definitions,
    ) -> Result<Option<String>, ShaderError> {
        if self == Self::Spirv {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&self.export(sources, pass, definitions)?.bytes).into_owned();
        let start = match self {
            Self::Wgsl => "@compute",
            Self::Glsl => "void main()",
            Self::Hlsl => "[numthreads(",
            _ => "kernel void",
        };
        // Every writer puts entry points last; GLSL's and HLSL's own headers are the includer's affair.
        let functions = text.find(&format!("\n{start}")).map_or(text.as_str(), |end| &text[..end]);
        let headers = ["#version", "#extension", "layout(local_size"];
        let kept: Vec<_> =
            functions.lines().filter(|line| !headers.iter().any(|start| line.starts_with(start))).collect();
        Ok(Some(format!("{}\n{}\n", names::legend(sources, pass), kept.join("\n").trim())))
    }
}

impl fmt::Display for Language {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for Language {
    type Err = UnknownLanguage;

    fn from_str(name: &str) -> Result<Self, UnknownLanguage> {
        Self::ALL.into_iter().find(|language| language.name() == name).ok_or_else(|| UnknownLanguage(name.to_owned()))
    }
}
