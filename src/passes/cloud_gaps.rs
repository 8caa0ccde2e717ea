//! How far around each place of its weather a layer of clouds has no column, for skipping empty space.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts};

const NAME: &str = "cloud_gaps";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: clouds::need,
        reads: &["cloud_weather_map"],
        writes: &[GAPS],
        inputs: clouds::layers_inputs,
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba8Unorm.texel_bytes(),
    },
    record,
};

const GAPS: &str = "cloud_gaps";
/// Between the two stages that look for columns.
const ALONG_ROWS: &str = "cloud_gaps_along_rows";
/// Cells along each side of a tile of weather: `GAP_CELLS` of `cloud_skip.wgsl`.
const CELLS: u32 = 256;

fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D3(CELLS, CELLS, facts.clouds.len() as u32)
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let gaps = recording.resources.image(GAPS, shape, ImageFormat::Rgba8Unorm)?;
    let along_rows = recording.resources.image(ALONG_ROWS, shape, ImageFormat::Rgba8Unorm)?;
    let work = || Work::Invocations(shape.extent());
    let [before, after] = ["cloud_gaps_before", "cloud_gaps_after"];
    recording.dispatch(NAME, &["GAPS_IN_CELLS"], &[(after, &gaps)], work())?;
    recording.dispatch(NAME, &["GAPS_ALONG_ROWS"], &[(before, &gaps), (after, &along_rows)], work())?;
    recording.dispatch(NAME, &[], &[(before, &along_rows), (after, &gaps)], work())?;
    recording.resources.release(ALONG_ROWS);
    Ok(())
}
