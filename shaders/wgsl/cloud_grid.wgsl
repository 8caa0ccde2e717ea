#define_import_path welkin::cloud_grid
// Grids around the point below the camera in which clouds' light is kept: nested, each four times as wide as the one
// inside it, and for each layer of clouds as many slices from its base to its top.
//
// Legend
//   level     0 is the innermost grid
//   cell      (column, row, slice) of one layer's part of one level
//   slab      which layer's part of which level: level * CLOUD_LAYER_COUNT + layer
//
// Definitions: CLOUD_GRID_SIZE (columns and rows), CLOUD_GRID_SLICES, CLOUD_GRID_LEVELS, CLOUD_CELL_M (of level 0).

#import welkin::atmosphere::atmosphere
#import welkin::cloud_field::{cloud_layers, CLOUD_LAYER_COUNT}

const GRID_SIZE: u32 = #{CLOUD_GRID_SIZE}u;
const GRID_SLICES: u32 = #{CLOUD_GRID_SLICES}u;
const GRID_LEVELS: u32 = #{CLOUD_GRID_LEVELS}u;
const SLABS: u32 = CLOUD_LAYER_COUNT * GRID_LEVELS;
// Share of a level's half width within which it counts alone; outside it gives way to the next.
const INNER: f32 = 0.8;

fn cell_m(level: u32) -> f32 {
    return #{CLOUD_CELL_M}.0 * f32(1u << (2u * level));
}

struct Cell {
    layer: u32,
    level: u32,
    map: vec2<f32>,
    altitude_m: f32,
}

// What the texel of a grid's texture stands for: its centre.
fn cell_of(texel: vec3<u32>) -> Cell {
    let slab = texel.z / GRID_SLICES;
    var cell: Cell;
    cell.layer = slab % CLOUD_LAYER_COUNT;
    cell.level = slab / CLOUD_LAYER_COUNT;
    cell.map = (vec2<f32>(texel.xy) + 0.5 - 0.5 * f32(GRID_SIZE)) * cell_m(cell.level);
    let height = (f32(texel.z % GRID_SLICES) + 0.5) / f32(GRID_SLICES);
    cell.altitude_m = cloud_layers[cell.layer].base_m + height * cloud_layers[cell.layer].thickness_m;
    return cell;
}

// A direction in the sky of a point of the map: east, north, up; the ground curves away around the origin.
fn local_direction(map: vec2<f32>, direction: vec3<f32>) -> vec3<f32> {
    let up = normalize(vec3<f32>(map / atmosphere.radius_m, 1.0));
    let slope = dot(direction, up);
    let horizontal = length(direction.xy);
    let heading = select(vec2<f32>(0.0), direction.xy / max(horizontal, 1e-20), horizontal > 0.0);
    return vec3<f32>(heading * sqrt(max(1.0 - slope * slope, 0.0)), slope);
}

// Where a point lies in a level: its distance from the middle, as a share of the half width.
fn eccentricity(level: u32, map: vec2<f32>) -> f32 {
    return max(abs(map.x), abs(map.y)) / (0.5 * f32(GRID_SIZE) * cell_m(level));
}

// The innermost level that holds a point; beyond all, the last.
fn level_of(map: vec2<f32>) -> u32 {
    var level = 0u;
    while level + 1u < GRID_LEVELS && eccentricity(level, map) >= 1.0 {
        level += 1u;
    }
    return level;
}

// One of several fields that lie one after the other in a texture.
struct Part {
    index: u32,
    count: u32,
}

// The texture coordinate of a point in one level. Heights beyond the layer keep the outermost slice.
fn grid_uvw(part: Part, level: u32, layer: u32, map: vec2<f32>, height: f32) -> vec3<f32> {
    let slice = clamp(height * f32(GRID_SLICES), 0.5, f32(GRID_SLICES) - 0.5);
    let slab = part.index * SLABS + level * CLOUD_LAYER_COUNT + layer;
    let xy = map / (f32(GRID_SIZE) * cell_m(level)) + 0.5;
    return vec3<f32>(xy, (f32(slab * GRID_SLICES) + slice) / f32(part.count * SLABS * GRID_SLICES));
}

// A field of the grids at a point, from the innermost level that holds it, and beyond the last from that one's edge.
fn grid_sample(
    grid: texture_3d<f32>, linear: sampler, part: Part, layer: u32, map: vec2<f32>, height: f32
) -> vec4<f32> {
    let level = level_of(map);
    let value = textureSampleLevel(grid, linear, grid_uvw(part, level, layer, map, height), 0.0);
    let outward = saturate((eccentricity(level, map) - INNER) / (1.0 - INNER));
    if level + 1u == GRID_LEVELS || outward <= 0.0 {
        return value;
    }
    let beyond = textureSampleLevel(grid, linear, grid_uvw(part, level + 1u, layer, map, height), 0.0);
    return mix(value, beyond, outward);
}

// What the grids hold of whole columns, one slice for each slab, at a place.
fn column_sample(columns: texture_3d<f32>, linear: sampler, layer: u32, map: vec2<f32>) -> vec4<f32> {
    let level = level_of(map);
    let value = textureSampleLevel(columns, linear, column_uvw(level, layer, map), 0.0);
    let outward = saturate((eccentricity(level, map) - INNER) / (1.0 - INNER));
    if level + 1u == GRID_LEVELS || outward <= 0.0 {
        return value;
    }
    return mix(value, textureSampleLevel(columns, linear, column_uvw(level + 1u, layer, map), 0.0), outward);
}

fn column_uvw(level: u32, layer: u32, map: vec2<f32>) -> vec3<f32> {
    let slab = level * CLOUD_LAYER_COUNT + layer;
    return vec3<f32>(map / (f32(GRID_SIZE) * cell_m(level)) + 0.5, (f32(slab) + 0.5) / f32(SLABS));
}
