//! The passes of the ordinates as the plan knows them.

use super::{Start, Volumes, light, problem};
use crate::gpu::ImageFormat;
use crate::passes::{Pass, Recording, RenderError, clouds, definitions};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

/// Extinction where the ordinates are solved.
pub const EXTINCTION: Pass = Pass {
    declaration: Declaration {
        name: "ordinates_extinction",
        need,
        reads: &["cloud_shape_volume", "cloud_erosion_volume", "cloud_weather_map", "cloud_curl_map"],
        writes: &["ordinates_extinction"],
        inputs: |facts| {
            let grid = problem(facts).map(|problem| problem.grid);
            Fingerprint::of(&(clouds::field_inputs(facts), grid))
        },
        bytes: |facts| problem(facts).map_or(0, |problem| fine_bytes(&problem.grid)),
    },
    record: record_extinction,
};

/// The light there.
pub const LIGHT: Pass = Pass {
    declaration: Declaration {
        name: "ordinates_sweep",
        need,
        reads: &["ordinates_extinction"],
        writes: &[
            "ordinates_depth",
            "ordinates_source",
            "ordinates_radiance",
            "ordinates_sunlight",
            "ordinates_skylight",
        ],
        inputs: |facts| Fingerprint::of(&(problem(facts), light(facts), facts.settings.clouds.sweeps)),
        bytes: |facts| problem(facts).map_or(0, |problem| Volumes::bytes(&problem) - fine_bytes(&problem.grid)),
    },
    record: record_light,
};

fn fine_bytes(grid: &super::Grid) -> u64 {
    grid.fine_texture().map(u64::from).iter().product::<u64>() * ImageFormat::R32Float.texel_bytes()
}

fn need(facts: &Facts) -> Need {
    match (clouds::need(facts), problem(facts)) {
        (Need::NotNeeded(reason), _) => Need::NotNeeded(reason),
        (_, None) => Need::NotNeeded("light in clouds is found without ordinates".to_owned()),
        (_, Some(problem)) => {
            let (levels, sweeps) = (problem.grid.levels.len(), facts.settings.clouds.sweeps);
            let (cells, directions) = (problem.grid.cell_count(), problem.directions.count());
            Need::Needed(format!(
                "{directions} directions in {cells} cells of {levels} levels, {sweeps} sweeps of each"
            ))
        }
    }
}

fn record_extinction(recording: &mut Recording) -> Result<(), RenderError> {
    let Some(problem) = problem(recording.facts) else { return Ok(()) };
    let definitions = definitions(recording.facts);
    let (resources, commands) = recording.parts();
    Volumes::allocate(&problem, definitions, resources)?.record_extinction(resources, commands)
}

fn record_light(recording: &mut Recording) -> Result<(), RenderError> {
    let Some(problem) = problem(recording.facts) else { return Ok(()) };
    let (definitions, sweeps) = (definitions(recording.facts), recording.facts.settings.clouds.sweeps);
    let (resources, commands) = recording.parts();
    let volumes = Volumes::allocate(&problem, definitions, resources)?;
    volumes.record_depth(resources, commands)?;
    volumes.record_source(resources, commands)?;
    volumes.record_light(Start::Cold, sweeps, resources, commands)?;
    volumes.record_moments(resources, commands)
}
