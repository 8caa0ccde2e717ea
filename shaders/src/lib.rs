//! welkin's shaders: the WGSL itself, composed by naga_oil, validated by naga and compiled to SPIR-V.
//!
//! A *pass* is a WGSL file with a compute entry point `main`; a *module* is a file that starts with
//! `#define_import_path` and is imported by passes. [`compile`] turns an embedded pass into a [`Shader`]; [`Sources`]
//! holds WGSL from elsewhere, such as a directory that is being edited. [`Language::export`] writes a pass in the language of
//! another engine.
//!
//! Knows nothing of Vulkan calls, and nothing of what the shaders compute.

#![forbid(unsafe_code)]

mod compose;
mod error;
mod export;
mod locate;
mod reflect;
mod shader;
mod sources;

pub use error::{Location, ShaderError};
pub use export::{Exported, Language, UnknownLanguage};
pub use naga::StorageFormat;
pub use reflect::{Access, Binding, BindingKind, Dimension, Field, StructLayout};
pub use shader::{Definition, Definitions, ParameterBuffers, Shader, compile};
pub use sources::Sources;
