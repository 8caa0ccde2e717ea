//! Linear radiance of the pixels between the lattice's directions, and the list of those that need more.

use super::{Pass, Recording, RenderError, compose};
use crate::gpu::{DeviceKind, Work};
use crate::plan::{Declaration, Facts, Need, lattice_cell};

const NAME: &str = "interpolate";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &[
            "optical_depth_table",
            "multiple_scattering_table",
            "view_optical_depth_table",
            "sky_view_table",
            "view_emission_table",
            "sky_lattice",
            "cloud_radiance_image",
            "cloud_air_image",
            "cloud_diffuse_image",
            "media_radiance_image",
            "media_transmittance_image",
            "terrain_image",
        ],
        writes: &["exact_cells", "radiance_image", "transmittance_image", "distance_image"],
        inputs: compose::inputs,
        bytes: |facts| list_bytes(facts, lattice_cell(facts).unwrap_or(1)),
    },
    record,
};

/// `LIST_HEADER` in `lattice.wgsl`, and an entry for each cell.
fn list_bytes(facts: &Facts, cell: u32) -> u64 {
    let camera = &facts.scene.camera;
    let cells = u64::from(camera.width.div_ceil(cell)) * u64::from(camera.height.div_ceil(cell));
    4 * (4 + cells)
}

fn need(facts: &Facts) -> Need {
    match lattice_cell(facts) {
        Ok(cell) => Need::Needed(format!("pixels inside cells of {cell} x {cell}")),
        Err(reason) => Need::NotNeeded(reason),
    }
}

/// A processor reads a cell's corners once for all of its pixels. A GPU wants more invocations than that, and neighbours that write
/// side by side.
fn whole_cells(recording: &Recording) -> bool {
    recording.resources.gpu.info().kind == DeviceKind::Cpu
}

pub(super) fn flags(recording: &Recording) -> Vec<&'static str> {
    whole_cells(recording).then_some("WHOLE_CELLS").into_iter().collect()
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Ok(cell) = lattice_cell(recording.facts) else { return Ok(()) };
    let images = compose::images(recording)?;
    let surface: Vec<_> = images.surface.iter().map(|image| ("surface_image", image)).collect();
    let list = recording.resources.buffer("exact_cells", list_bytes(recording.facts, cell))?;
    recording.clear(&list);
    let columns = if whole_cells(recording) { cell } else { 1 };
    let [width, height, _] = images.shape.extent();
    let work = Work::Invocations([width.div_ceil(columns), height.div_ceil(cell), 1]);
    recording.dispatch(NAME, &flags(recording), &surface, work)
}
