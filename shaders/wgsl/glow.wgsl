#define_import_path welkin::glow
// The glow around a light as the directions of the source function's grid see it.
//
// Haze and dust scatter most light into a narrow cone around the light, which falls between the grid's directions or
// counts too much in one of them. So a direction takes the part of the phase function inside the cone as its mean over
// the cell around it: the cells' sum is all of the glow, also where the horizon cuts it. Matter that throws light back has
// its glow around the point opposite the light.

#import welkin::atmosphere::{peak_side, phase_per_sr, SCATTERER_COUNT, SCATTERER_SLOTS}
#import welkin::source_grid::{direction_in_cell, direction_of, GridDirection}

// Cosine of the cone's half width: the spacing of directions in the coarsest grid, 37 degrees.
const CONE_NU: f32 = 0.8;
// Points on each side of a cell.
const CELL_POINTS: u32 = 6u;

fn cosine_to_light(direction: GridDirection, mu_s: f32) -> f32 {
    let sines = sqrt(max((1.0 - direction.mu * direction.mu) * (1.0 - mu_s * mu_s), 0.0));
    return clamp(direction.mu * mu_s + sines * cos(direction.phi_rad), -1.0, 1.0);
}

// Phase functions of the scatterers towards a direction of the grid, 1/sr.
fn phases_towards(index: u32, horizon_mu: f32, mu_s: f32) -> array<f32, SCATTERER_SLOTS> {
    let direction = direction_of(index, horizon_mu, mu_s);
    let nu = cosine_to_light(direction, mu_s);
    var inside: array<f32, SCATTERER_SLOTS>;
    for (var i = 0u; i < CELL_POINTS * CELL_POINTS; i++) {
        let shares = (vec2<f32>(f32(i / CELL_POINTS), f32(i % CELL_POINTS)) + 0.5) / f32(CELL_POINTS);
        let point = direction_in_cell(index, shares, horizon_mu, mu_s);
        let point_nu = cosine_to_light(point, mu_s);
        for (var c = 0u; c < SCATTERER_COUNT; c++) {
            let side = peak_side(c);
            let edge = phase_per_sr(c, side * CONE_NU);
            inside[c] += point.solid_angle_sr * (phase_per_sr(c, side * max(side * point_nu, CONE_NU)) - edge);
        }
    }
    let points_sr = f32(CELL_POINTS * CELL_POINTS) * max(direction.solid_angle_sr, 1e-9);
    var phases_per_sr: array<f32, SCATTERER_SLOTS>;
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        let side = peak_side(c);
        phases_per_sr[c] = phase_per_sr(c, side * min(side * nu, CONE_NU)) + inside[c] / points_sr;
    }
    return phases_per_sr;
}
