//! Skies, clouds and fog in real time on Vulkan, with a stated error.

pub mod frame;
pub mod probe;
pub mod scene;
