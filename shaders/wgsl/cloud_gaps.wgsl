// Pass: how far around each place of its weather a layer of clouds has no column, whatever the noise of its shape says there.
//
// Distances are those between cells of the map, nearest corners, in cells: first which cells hold a column, then the nearest of them
// along each row, then across the rows (Felzenszwalb & Huttenlocher 2012, Distance transforms of sampled functions; by looking at all
// rows near enough, in place of their envelope). Wind only moves the map.
//
// Legend
//   cell      of a layer's tile of weather, GAP_CELLS along each side
//   floor     one of GAP_FLOORS heights, a channel each: its columns are those that reach so high; anvils stand on all
//
// Definitions: the stage, GAPS_IN_CELLS or GAPS_ALONG_ROWS, or else across them.

#import welkin::cloud_field::{cloud_layers, cloud_weather_map, column_of}
#import welkin::cloud_skip::{FARTHEST_GAP, GAP_CELLS, GAP_FLOORS, GAP_STEPS}

#ifndef GAPS_IN_CELLS
@group(0) @binding(0) var cloud_gaps_before: texture_3d<f32>;
#endif
@group(0) @binding(1) var cloud_gaps_after: texture_storage_3d<rgba8unorm, write>;

#ifdef GAPS_IN_CELLS
const WEATHER_TEXELS: i32 = 512;
// Texels of the weather map along a cell.
const CELL_TEXELS: i32 = WEATHER_TEXELS / GAP_CELLS;

// The most of each channel of the weather map that is interpolated anywhere in a cell.
fn most_of(cell: vec2<i32>) -> vec4<f32> {
    var most = vec4<f32>(0.0);
    for (var y = -1; y <= CELL_TEXELS; y++) {
        for (var x = -1; x <= CELL_TEXELS; x++) {
            let texel = (cell * CELL_TEXELS + vec2<i32>(x, y)) & vec2<i32>(WEATHER_TEXELS - 1);
            most = max(most, textureLoad(cloud_weather_map, texel, 0));
        }
    }
    return most;
}

// 0 on the floors to which a cell's columns reach, 1 on those that stay empty.
fn found(cell: vec3<i32>) -> vec4<f32> {
    let layer = u32(cell.z);
    let column = column_of(layer, most_of(cell.xy));
    let gradient = cloud_layers[layer].gradient;
    let heights = vec4<f32>(0.0, 1.0, 2.0, 3.0) / GAP_FLOORS;
    // Of the body in welkin::cloud_field, where the shape is at its most.
    let most = saturate((gradient.z - heights / column.reach) * gradient.w) + column.coverage - 1.0;
    var is_column = vec4<bool>(column.coverage > 0.0) & (most > vec4<f32>(0.0));
#ifdef CLOUD_ANVIL
    is_column = is_column | vec4<bool>(column.anvil > 0.0);
#endif
    return select(vec4<f32>(1.0), vec4<f32>(0.0), is_column);
}
#else
fn before(cell: vec3<i32>) -> vec4<f32> {
    let wrapped = vec3<i32>(cell.xy & vec2<i32>(GAP_CELLS - 1), cell.z);
    return round(255.0 * textureLoad(cloud_gaps_before, wrapped, 0));
}

#ifdef GAPS_ALONG_ROWS
// Cells to the nearest column of the row; 255 where there is none near enough.
fn found(cell: vec3<i32>) -> vec4<f32> {
    var nearest = vec4<f32>(255.0);
    for (var x = -FARTHEST_GAP; x <= FARTHEST_GAP; x++) {
        let is_column = before(cell + vec3<i32>(x, 0, 0)) == vec4<f32>(0.0);
        nearest = select(nearest, min(nearest, vec4<f32>(f32(abs(x)))), is_column);
    }
    return nearest / 255.0;
}
#else
fn found(cell: vec3<i32>) -> vec4<f32> {
    var nearest = vec4<f32>(f32(FARTHEST_GAP - 1));
    for (var y = -FARTHEST_GAP; y <= FARTHEST_GAP; y++) {
        let across = max(f32(abs(y)) - 1.0, 0.0);
        let along = max(before(cell + vec3<i32>(0, y, 0)) - 1.0, vec4<f32>(0.0));
        nearest = min(nearest, sqrt(along * along + across * across));
    }
    return floor(GAP_STEPS * nearest) / 255.0;
}
#endif
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) cell: vec3<u32>) {
    if any(cell >= textureDimensions(cloud_gaps_after)) {
        return;
    }
    textureStore(cloud_gaps_after, cell, found(vec3<i32>(cell)));
}
