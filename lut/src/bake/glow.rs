//! The glow around the light as the directions of the source function's grid see it: the shaders' `glow.wgsl`, in f64.
//!
//! Haze scatters most light into a narrow cone around the light, which falls between the grid's directions or counts too
//! much in one of them. So a direction takes the part of the phase function inside the cone as its mean over the cell
//! around it: the cells' sum is all of the glow, also where the horizon cuts it. Matter that throws light back has its glow
//! around the point opposite the light.

use crate::phase::PhaseLobe;

use super::source_grid::{GridAt, GridDirection};

/// Cosine of the cone's half width: the spacing of directions in the coarsest grid, 37 degrees.
const CONE_NU: f64 = 0.8;
/// Points on each side of a cell.
const CELL_POINTS: u32 = 6;

/// A phase function from its lobes, 1/sr.
pub(super) fn phase_per_sr(lobes: &[PhaseLobe], nu: f64) -> f64 {
    lobes.iter().map(|lobe| lobe.value(nu)).sum()
}

/// 1 where most light is thrown forwards, -1 where backwards.
pub(super) fn peak_side(lobes: &[PhaseLobe]) -> f64 {
    if phase_per_sr(lobes, -1.0) > phase_per_sr(lobes, 1.0) { -1.0 } else { 1.0 }
}

fn cosine_to_light(direction: GridDirection, mu_s: f64) -> f64 {
    let sines = ((1.0 - direction.mu * direction.mu) * (1.0 - mu_s * mu_s)).max(0.0).sqrt();
    (direction.mu * mu_s + sines * direction.phi_rad.cos()).clamp(-1.0, 1.0)
}

/// Phase functions towards a direction of the grid, 1/sr.
pub(super) fn phases_towards(phases: &[Vec<PhaseLobe>], grid: &GridAt, index: u32) -> Vec<f64> {
    let direction = grid.direction(index);
    let nu = cosine_to_light(direction, grid.mu_s);
    let share = |k: u32| (f64::from(k) + 0.5) / f64::from(CELL_POINTS);
    let points: Vec<(f64, f64)> = (0..CELL_POINTS * CELL_POINTS)
        .map(|k| grid.direction_in_cell(index, [share(k / CELL_POINTS), share(k % CELL_POINTS)]))
        .map(|point| (cosine_to_light(point, grid.mu_s), point.solid_angle_sr))
        .filter(|(nu, _)| nu.abs() > CONE_NU)
        .collect();
    let points_sr = f64::from(CELL_POINTS * CELL_POINTS) * direction.solid_angle_sr.max(1e-9);
    let towards = |lobes: &Vec<PhaseLobe>| {
        let side = peak_side(lobes);
        let edge = phase_per_sr(lobes, side * CONE_NU);
        let beyond_edge = |nu: f64| phase_per_sr(lobes, side * (side * nu).max(CONE_NU)) - edge;
        let inside: f64 = points.iter().map(|(nu, sr)| sr * beyond_edge(*nu)).sum();
        phase_per_sr(lobes, side * (side * nu).min(CONE_NU)) + inside / points_sr
    };
    phases.iter().map(towards).collect()
}
