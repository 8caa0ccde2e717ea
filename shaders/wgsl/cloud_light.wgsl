// Pass: optical depth of clouds from each cell of their grids to each light, through all layers, and to its own layer's
// top and base: what a march would otherwise find again for every sample of every frame.
//
// Slabs of the texture: those of the grids, once for each light.

#import welkin::atmosphere::atmosphere
#import welkin::cloud_field::{cloud_layers, CLOUD_LAYER_COUNT}
#import welkin::cloud_grid::{cell_of, grid_sample, local_direction, Cell, Part, GRID_SLICES, SLABS}
#import welkin::observer::observer

@group(0) @binding(3) var table_sampler: sampler;
@group(0) @binding(6) var cloud_density_image: texture_3d<f32>;
@group(0) @binding(7) var cloud_light_image: texture_storage_3d<rgba16float, write>;

const STEPS: u32 = 40u;
const VERTICAL_STEPS: u32 = 16u;
// A light at the horizon shines through so much of the layers at most, m.
const FARTHEST_M: f32 = 60000.0;

fn extinction(map: vec2<f32>, altitude_m: f32) -> f32 {
    var sum = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let height = (altitude_m - cloud_layers[layer].base_m) / cloud_layers[layer].thickness_m;
        if height >= 0.0 && height <= 1.0 {
            sum += grid_sample(cloud_density_image, table_sampler, Part(0u, 1u), layer, map, height).x;
        }
    }
    return sum;
}

fn highest_m() -> f32 {
    var top_m = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        top_m = max(top_m, cloud_layers[layer].base_m + cloud_layers[layer].thickness_m);
    }
    return top_m;
}

fn depth_to_light(cell: Cell, toward: vec3<f32>) -> f32 {
    let local = local_direction(cell.map, toward);
    let slope = local.z;
    let rise_m = max(highest_m() - cell.altitude_m, 0.0);
    // rise = slope t + t² / 2R
    let root = sqrt(max(slope * slope + 2.0 * rise_m / atmosphere.radius_m, 0.0));
    let length_m = min(2.0 * rise_m / max(root + slope, 1e-6), FARTHEST_M);
    var sum = 0.0;
    for (var i = 0u; i < STEPS; i++) {
        // Steps grow with distance: what is near counts in detail.
        let share = (f32(i) + 0.5) / f32(STEPS);
        let t_m = length_m * share * share;
        let altitude_m = cell.altitude_m + t_m * (slope + 0.5 * t_m / atmosphere.radius_m);
        sum += 2.0 * share * extinction(cell.map + local.xy * t_m, altitude_m);
    }
    return sum * length_m / f32(STEPS);
}

fn depth_between(cell: Cell, to_m: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < VERTICAL_STEPS; i++) {
        let share = (f32(i) + 0.5) / f32(VERTICAL_STEPS);
        sum += extinction(cell.map, mix(cell.altitude_m, to_m, share));
    }
    return sum * abs(to_m - cell.altitude_m) / f32(VERTICAL_STEPS);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    if any(texel >= textureDimensions(cloud_light_image)) {
        return;
    }
    let light = texel.z / (SLABS * GRID_SLICES);
    let cell = cell_of(vec3<u32>(texel.xy, texel.z % (SLABS * GRID_SLICES)));
    let layer_top_m = cloud_layers[cell.layer].base_m + cloud_layers[cell.layer].thickness_m;
    let above = depth_between(cell, layer_top_m);
    let below = depth_between(cell, cloud_layers[cell.layer].base_m);
    let to_light = depth_to_light(cell, observer.lights[light].direction);
    // Beyond the range of half floats nothing is seen.
    textureStore(cloud_light_image, texel, min(vec4<f32>(to_light, above, below, 0.0), vec4<f32>(60000.0)));
}
