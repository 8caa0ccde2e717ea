//! Skies, clouds and fog in real time on Vulkan, with a stated error.

pub mod bake;
pub mod bench;
pub mod foreground;
pub mod frame;
pub mod goal;
pub mod gpu;
pub mod output;
pub mod passes;
pub mod plan;
pub mod probe;
pub mod reference;
pub mod renderer;
pub mod report;
pub mod scene;
pub mod shader_export;
#[cfg(feature = "window")]
pub mod window;
