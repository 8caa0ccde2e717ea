#define_import_path welkin::cloud_skip
// How far from a point a layer of clouds is certainly empty.
//
// Legend: that of cloud_gaps.wgsl, the pass that measures gaps.

#import welkin::cloud_field::{along_and_across, cloud_layers}

// Layer by layer.
@group(1) @binding(5) var cloud_gaps: texture_3d<f32>;

const GAP_CELLS: i32 = 256;
const GAP_FLOORS: f32 = 4.0;
// Cells at which a distance ends, and steps that a byte holds of each.
const FARTHEST_GAP: i32 = 64;
const GAP_STEPS: f32 = 4.0;
// What a step may use of a gap: rounding, and the map's stretching of lengths.
const MARGIN: f32 = 0.85;

// A distance along a ray, m, in which it meets nothing of a layer; 0 where it may at once. The ray climbs by `rise` per metre, or more
// and more, as rays do that leave the ground behind.
fn gap_m(layer: u32, map: vec2<f32>, altitude_m: f32, rise: f32) -> f32 {
    let tiles = along_and_across(layer, map) * cloud_layers[layer].weather_per_m + cloud_layers[layer].weather_offset;
    let cell = vec3<i32>(vec2<i32>(fract(tiles) * f32(GAP_CELLS)) & vec2<i32>(GAP_CELLS - 1), i32(layer));
    let floor_m = cloud_layers[layer].thickness_m / GAP_FLOORS;
    let up_m = altitude_m - cloud_layers[layer].base_m;
    // A ray that sinks looks one floor farther down, and no deeper.
    let is_sinking = rise < 0.0;
    let lowest = clamp(floor(up_m / floor_m) - select(0.0, 1.0, is_sinking), 0.0, GAP_FLOORS - 1.0);
    let steps = 255.0 * textureLoad(cloud_gaps, cell, 0)[u32(lowest)];
    let reach_m = MARGIN / (cloud_layers[layer].weather_per_m * f32(GAP_CELLS) * GAP_STEPS) * steps;
    let down_m = (up_m - lowest * floor_m) / max(-rise, 1e-6);
    return select(reach_m, min(reach_m, max(down_m, 0.0)), is_sinking && lowest > 0.0);
}
