//! Optical depth from each cell of the grids of fog and local volumes to each light.

use super::{Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "volume_light";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["cloud_shape_volume", "cloud_erosion_volume", "cloud_light_image"],
        writes: &["volume_light_image", "volume_sky_image"],
        inputs: |facts| {
            let directions: Vec<_> = facts.lights.iter().map(|light| light.direction).collect();
            let scene = facts.scene;
            let media = (&facts.volumes, &facts.seen_volumes, scene.time_s, facts.settings.volumes);
            Fingerprint::of(&(media, directions, scene.planet.radius_m, &scene.terrain))
        },
        bytes: |facts| {
            let texels = light_shape(facts).texels() + sky_shape(facts).texels();
            texels * ImageFormat::Rgba16Float.texel_bytes()
        },
    },
    record,
};

/// Texels of all blocks at most.
const MOST_TEXELS: u32 = 1 << 22;
/// A side of an image of three dimensions that every device takes, texels.
const WIDEST: u32 = 2048;
/// Cells along a block's side at least.
const FEWEST_CELLS: u32 = 8;

/// How blocks lie in their images.
#[derive(Debug, Clone, Copy)]
pub struct Blocks {
    /// Cells along each side of a block.
    pub cells: u32,
    /// Blocks in a row.
    pub columns: u32,
    /// Rows of blocks.
    pub rows: u32,
}

/// How many hold light.
pub fn block_count(facts: &Facts) -> u32 {
    facts.fog_count() * facts.settings.volumes.fog_levels + facts.seen_volumes.len() as u32
}

/// The blocks of a scene: nested ones of each bank of fog, one of each local volume that is seen.
pub fn blocks(facts: &Facts) -> Blocks {
    let settings = &facts.settings.volumes;
    let count = block_count(facts).max(1);
    let mut cells = settings.cells;
    while cells > FEWEST_CELLS && count.saturating_mul(cells.pow(3)) > MOST_TEXELS {
        cells -= 4;
    }
    let columns = count.min(WIDEST / cells);
    Blocks { cells, columns, rows: count.div_ceil(columns) }
}

fn sky_shape(facts: &Facts) -> ImageShape {
    let Blocks { cells, columns, rows } = blocks(facts);
    ImageShape::D3(columns * cells, rows * cells, cells)
}

fn light_shape(facts: &Facts) -> ImageShape {
    let Blocks { cells, columns, rows } = blocks(facts);
    ImageShape::D3(columns * cells, rows * cells, cells * facts.light_slots())
}

/// What all passes of fog, volumes and local lights are asked.
pub(super) fn need(facts: &Facts) -> Need {
    if !facts.has_local_media() {
        return Need::NotNeeded("no fog, no local volumes and no local lights".to_owned());
    }
    let (fog, lamps) = (facts.fog_count() as usize, facts.local_lights.len());
    let (volumes, seen) = (facts.volumes.len() - fog, facts.seen_volumes.len());
    Need::Needed(format!("banks of fog: {fog}, local volumes: {volumes}, in view {seen}; local lights: {lamps}"))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let (light, sky) = (light_shape(recording.facts), sky_shape(recording.facts));
    recording.resources.image("volume_light_image", light, ImageFormat::Rgba16Float)?;
    recording.resources.image("volume_sky_image", sky, ImageFormat::Rgba16Float)?;
    recording.dispatch(NAME, &[], &[], Work::Invocations(light.extent()))
}
