//! What a scene asks of the ordinates.

use glam::DVec3;
use welkin_lut::cloud::CloudLayer;

use super::coefficients::{forward_share, reduced_cosine};
use super::{Coverage, Directions, Grid, Problem};
use crate::plan::Facts;

/// How far the last level reaches, m: to where the air hides most of a cloud.
const REACH_M: f64 = 60_000.0;

/// The problem of a scene's clouds, if ordinates are asked for and there is something to solve.
pub fn problem(facts: &Facts) -> Option<Problem> {
    let directions = match facts.ordinate_groups() {
        2 => Directions::Eight,
        4 => Directions::Sixteen,
        _ => return None,
    };
    let layers = &facts.clouds;
    let base_m = layers.iter().map(|layer| layer.base_m).min_by(f64::total_cmp)?;
    let top_m = layers.iter().map(|layer| layer.top_m).max_by(f64::total_cmp)?;
    // The layer that can be most opaque gives the phase function; in the bands each keeps its own.
    let thickest = layers.iter().max_by(|a, b| opacity(a).total_cmp(&opacity(b)))?;
    let f = forward_share(&thickest.phase);
    let albedo = thickest.albedo.iter().sum::<f64>() / 3.0;
    let toward_sun = facts.lights.get(light(facts)).map_or(DVec3::Z, |light| light.direction.to_vector());
    let settings = &facts.settings.clouds;
    let coverage = Coverage {
        cell_m: f64::from(settings.ordinate_cell_m),
        cells_across: settings.ordinate_cells,
        reach_m: REACH_M,
        altitudes_m: [base_m, top_m],
        refinement: 2,
    };
    Some(Problem {
        grid: Grid::around(0.0, 0.0, &coverage),
        directions,
        toward_sun,
        albedo: albedo * (1.0 - f) / (1.0 - albedo * f),
        reduced_cosine: reduced_cosine(&thickest.phase),
        ground_albedo: facts.scene.planet.ground_albedo.iter().sum::<f64>() / 3.0,
    })
}

/// Vertical optical depth that a layer could have.
fn opacity(layer: &CloudLayer) -> f64 {
    layer.extinction_per_m() * (layer.top_m - layer.base_m)
}

/// Number of the light whose field is solved: the strongest of those that are not deep below the horizon.
pub fn light(facts: &Facts) -> usize {
    // Below this no cloud is lit, however high.
    const LOWEST_RAD: f64 = -0.15;
    let strength = |index: usize| {
        let light = facts.lights[index];
        if light.direction.elevation_rad > LOWEST_RAD { light.irradiance.iter().sum::<f64>() } else { 0.0 }
    };
    (0..facts.lights.len()).max_by(|&a, &b| strength(a).total_cmp(&strength(b))).unwrap_or(0)
}
