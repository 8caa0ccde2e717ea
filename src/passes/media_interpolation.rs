//! What media send and leave in the pixels between those that were marched; and the march of those where that will not do.

use super::{Pass, Recording, RenderError, local_media, volume_light};
use crate::gpu::{GpuBuffer, GpuError, Work};
use crate::plan::{Declaration, Facts, Need, media_cell};

const NAME: &str = "media_interpolation";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &READS,
        writes: &["exact_media_cells"],
        inputs: local_media::inputs,
        bytes: |facts| cells(facts).map_or(0, list_bytes),
    },
    record,
};

/// Pixels and froxels, and for which distances there are any of these.
const READS: [&str; 6] = {
    let [radiance, transmittance, beam, diffuse, froxels] = local_media::WRITES;
    [radiance, transmittance, beam, diffuse, froxels, "surface_cells"]
};

fn need(facts: &Facts) -> Need {
    match (volume_light::need(facts), media_cell(facts)) {
        (Need::NotNeeded(reason), _) | (_, Err(reason)) => Need::NotNeeded(reason),
        (_, Ok(cell)) => {
            let percent = 0.1 * f64::from(facts.settings.volumes.lattice_permille);
            Need::Needed(format!(
                "cells of {cell} x {cell} pixels, marched where interpolation errs by {percent} % or more"
            ))
        }
    }
}

/// Columns and rows of cells, where media are interpolated.
pub(super) fn cells(facts: &Facts) -> Option<[u32; 2]> {
    let camera = &facts.scene.camera;
    let cell = media_cell(facts).ok()?;
    Some([camera.width, camera.height].map(|pixels| pixels.div_ceil(cell)))
}

/// `LIST_HEADER` in `cell_list.wgsl`, and an entry for each cell.
fn list_bytes([columns, rows]: [u32; 2]) -> u64 {
    4 * (4 + u64::from(columns) * u64::from(rows))
}

/// The list of cells whose pixels are to be marched, with nothing in it.
pub(super) fn empty_list(recording: &mut Recording, cells: [u32; 2]) -> Result<GpuBuffer, GpuError> {
    let list = recording.resources.buffer("exact_media_cells", list_bytes(cells))?;
    recording.clear(&list);
    Ok(list)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Some([columns, rows]) = cells(recording.facts) else { return Ok(()) };
    let list = empty_list(recording, [columns, rows])?;
    let surface = recording.surface();
    recording.dispatch(NAME, &[], &local_media::surface_images(&surface), Work::Workgroups([columns, rows, 1]))?;
    local_media::march(recording, Work::Counted(&list))
}
