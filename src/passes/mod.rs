//! One file per pass: what it declares to the plan, and how it is recorded.
//!
//! A pass's shader has the same stem. Shaders find their resources by name: what an earlier pass has left under a name
//! is what a later one reads under it.

mod aerial_optical_depth;
mod aerial_perspective;
pub mod blocks;
mod cloud_cover;
mod cloud_density;
mod cloud_erosion;
mod cloud_gaps;
mod cloud_light;
mod cloud_reconstruction;
mod cloud_shape;
mod cloud_weather;
mod clouds;
mod colour;
mod compose;
mod definitions;
mod display;
mod emission_order;
mod first_order;
mod first_source;
mod foreground;
mod froxel_media;
mod higher_order;
mod higher_source;
mod host_colour;
mod host_frame;
mod host_froxels;
mod host_surface;
mod interpolate;
mod isotropic_series;
mod lamp_froxels;
mod local_clusters;
mod local_media;
mod media_interpolation;
mod multiple_scattering;
mod optical_depth;
pub mod ordinates;
mod pipelines;
mod probe;
mod recording;
mod resources;
mod scattering_table;
mod sky_lattice;
mod sky_view;
mod surface_cells;
mod terrain;
mod view_emission;
mod view_optical_depth;
mod volume_light;

pub use definitions::definitions;
pub use foreground::upload as upload_foreground;
pub use host_frame::{DepthBuffer, HostDepth, HostFrame, HostFroxels, HostLeft, HostRecording};
pub use probe::{download as download_answers, record as record_probe, upload as upload_rays};
pub use recording::{Parameters, Recording};
pub use resources::Resources;
pub use scattering_table::record as record_scattering_table;

use crate::foreground::ForegroundError;
use crate::gpu::{GpuError, ImageFormat};
use crate::plan::{Declaration, Facts, PlanError, TableFormat};
use welkin_shaders::ShaderError;
pub use welkin_shaders::{ParameterBuffers, Sources as ShaderSources};

/// A pass: what the plan asks it, and how it is recorded.
pub struct Pass {
    /// What it says about itself.
    pub declaration: Declaration,
    /// Records its dispatches.
    pub record: fn(&mut Recording) -> Result<(), RenderError>,
}

/// The tables that the sky is read from, in order.
pub const TABLES: [Pass; 12] = [
    optical_depth::PASS,
    first_order::PASS,
    higher_order::PASS,
    isotropic_series::PASS,
    first_source::PASS,
    higher_source::PASS,
    emission_order::PASS,
    view_optical_depth::PASS,
    sky_view::PASS,
    view_emission::PASS,
    aerial_optical_depth::PASS,
    aerial_perspective::PASS,
];

/// Clouds, fog and local volumes: their noise and their light, in order.
pub const CLOUDS: [Pass; 11] = [
    cloud_shape::PASS,
    cloud_erosion::PASS,
    cloud_weather::PASS,
    cloud_gaps::PASS,
    cloud_density::PASS,
    cloud_light::PASS,
    cloud_cover::PASS,
    ordinates::EXTINCTION,
    ordinates::LIGHT,
    volume_light::PASS,
    local_clusters::PASS,
];

/// What makes a frame of them, in order.
pub const FRAME: [Pass; 12] = [
    terrain::PASS,
    clouds::PASS,
    cloud_reconstruction::PASS,
    lamp_froxels::PASS,
    surface_cells::PASS,
    local_media::PASS,
    media_interpolation::PASS,
    sky_lattice::PASS,
    interpolate::PASS,
    compose::PASS,
    colour::PASS,
    display::PASS,
];

/// What a host has drawn, before the frame's passes.
pub const HOST_SURFACE: Pass = host_surface::PASS;

/// Into the host's picture, after them.
pub const HOST_COLOUR: Pass = host_colour::PASS;

/// Into the host's froxels, in order.
pub const HOST_FROXELS: [Pass; 2] = [froxel_media::PASS, host_froxels::PASS];

/// Images of a frame, which are filled anew for every group of wavelengths or gather all of them.
pub const SHARED_IMAGES: [&str; 8] = [
    "terrain_image",
    "sky_lattice",
    "radiance_image",
    "transmittance_image",
    "distance_image",
    "colour_image",
    "colour_transmittance_image",
    "picture_image",
];

/// Two lists of names as one, of as many as both.
const fn joined<const A: usize, const B: usize, const BOTH: usize>(
    first: [&'static str; A],
    second: [&'static str; B],
) -> [&'static str; BOTH] {
    let mut names = [""; BOTH];
    let mut i = 0;
    while i < BOTH {
        names[i] = if i < A { first[i] } else { second[i - A] };
        i += 1;
    }
    names
}

/// The format of tables: of all but a few that are small, or hold what no logarithm could.
fn table_format(facts: &Facts) -> ImageFormat {
    match facts.settings.table_format {
        TableFormat::Float32 => ImageFormat::Rgba32Float,
        TableFormat::Float16 => ImageFormat::Rgba16Float,
    }
}

/// Why a scene could not be rendered.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene asks for what the renderer cannot do.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A shader does not compile.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The device failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// What is to stand before the camera cannot.
    #[error(transparent)]
    Foreground(#[from] ForegroundError),
    /// An image of the host's is not what the frame is drawn into.
    #[error("the target for {what} is a {found}; this scene's camera needs a {expected}")]
    Target {
        /// Radiance, transmittance, distance or picture.
        what: &'static str,
        /// Shape and format of the image.
        found: String,
        /// What they must be.
        expected: String,
    },
    /// There is no sky to bake.
    #[error("nothing in the scene's air scatters light, so that there are no tables of it to bake")]
    NothingToBake,
    /// The device cannot interpolate the tables.
    #[error(
        "device '{device}' can interpolate textures neither of 32-bit nor of half floats, which welkin's tables need; choose another with --device"
    )]
    NoLinearFilter {
        /// Its name.
        device: String,
    },
}
