//! The passes of the ordinates as the plan knows them.

use glam::DVec3;

use super::following::{Relaxation, angles, time};
use super::{Problem, Volumes, light, problem};
use crate::gpu::ImageFormat;
use crate::passes::{Pass, Recording, RenderError, clouds, definitions};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

/// Extinction where the ordinates are solved.
pub const EXTINCTION: Pass = Pass {
    declaration: Declaration {
        name: "ordinates_extinction",
        need,
        reads: &["cloud_shape_volume", "cloud_erosion_volume", "cloud_weather_map", "cloud_curl_map"],
        writes: &["ordinates_extinction", "ordinates_passing"],
        inputs: |facts| {
            let grid = problem(facts).map(|problem| problem.grid);
            Fingerprint::of(&(clouds::layers_inputs(facts), grid)).following(time(facts))
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
        reads: &["ordinates_extinction", "ordinates_passing"],
        writes: &[
            "ordinates_depth",
            "ordinates_source",
            "ordinates_low_faces",
            "ordinates_high_faces",
            "ordinates_radiance",
            "ordinates_sunlight",
            "ordinates_skylight",
            "ordinates_beam",
        ],
        inputs: |facts| {
            // Its direction is followed.
            let problem = problem(facts).map(|problem| Problem { toward_sun: DVec3::ZERO, ..problem });
            Fingerprint::of(&(problem, light(facts), Relaxation::of(facts)))
                .following(angles(facts).into_iter().flatten())
        },
        bytes: |facts| problem(facts).map_or(0, |problem| Volumes::bytes(&problem) - fine_bytes(&problem.grid)),
    },
    record: record_light,
};

fn fine_bytes(grid: &super::Grid) -> u64 {
    grid.fine_texture().map(u64::from).iter().product::<u64>() * 2 * ImageFormat::R32Float.texel_bytes()
}

fn need(facts: &Facts) -> Need {
    match (clouds::need(facts), problem(facts)) {
        (Need::NotNeeded(reason), _) => Need::NotNeeded(reason),
        (_, None) if facts.lights.is_empty() => Need::NotNeeded("no directional light shines".to_owned()),
        (_, None) => Need::NotNeeded("light in clouds is found without ordinates".to_owned()),
        (_, Some(problem)) => {
            let (levels, sweeps) = (problem.grid.levels.len(), Relaxation::of(facts).sweeps);
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
    let (definitions, relaxation) = (definitions(recording.facts), Relaxation::of(recording.facts));
    let (resources, commands) = recording.parts();
    let volumes = Volumes::allocate(&problem, definitions, resources)?;
    volumes.record_depth(resources, commands)?;
    volumes.record_source(resources, commands)?;
    volumes.record_light(relaxation.start, relaxation.sweeps, resources, commands)?;
    volumes.record_moments(resources, commands)
}
