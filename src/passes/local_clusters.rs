//! Which local volumes and lights may matter in each cluster of pixels and distances.

use super::blocks::local_light_count;
use super::{Pass, Recording, RenderError, lamp_froxels, volume_light};
use crate::gpu::Work;
use crate::plan::{Declaration, Facts, Fingerprint};

const NAME: &str = "local_clusters";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: volume_light::need,
        reads: &[],
        writes: &["cluster_masks"],
        inputs: |facts| {
            Fingerprint::of(&(&facts.scene.camera, &facts.volumes, &facts.local_lights, facts.settings.volumes))
        },
        bytes,
    },
    record,
};

/// Pixels along a tile's side: WGSL `TILE`.
pub const TILE: u32 = 16;
/// Slices of distance: WGSL `SLICES`.
const SLICES: u32 = 24;

/// Tiles across the picture.
pub fn columns(facts: &Facts) -> u32 {
    facts.scene.camera.width.div_ceil(TILE)
}

/// Words of bits of a cluster.
fn words(facts: &Facts) -> u32 {
    let volumes = facts.volumes.len() as u32 - facts.fog_count();
    let lists = if lamp_froxels::are_there(facts) { 2 } else { 1 };
    (volumes.div_ceil(32) + lists * local_light_count(facts).div_ceil(32)).max(1)
}

fn tiles(facts: &Facts) -> u32 {
    columns(facts) * facts.scene.camera.height.div_ceil(TILE)
}

fn bytes(facts: &Facts) -> u64 {
    4 * u64::from(tiles(facts) * SLICES * words(facts))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let facts = recording.facts;
    recording.resources.buffer("cluster_masks", bytes(facts))?;
    recording.dispatch(NAME, &[], &[], Work::Invocations([tiles(facts) * words(facts), 1, 1]))
}
