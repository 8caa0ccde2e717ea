// Pass: extinction of the clouds' similar medium in every fine texel of the ordinates' grids, 1/m.
//
// One invocation a texel of one level; the mean of eight points.

#import welkin::cloud_field::{cloud_layers, layer_density, CLOUD_LAYER_COUNT}
#import welkin::cloud_matter::cloud_matter
#import welkin::ordinates_grid::{ordinates, REFINEMENT}

struct Part {
    level: u32,
}

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var ordinates_extinction_image: texture_storage_3d<r32float, write>;

// c' of all layers at a place, 1/m.
fn similar_extinction(place_m: vec3<f32>) -> f32 {
    var sum = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let up_m = place_m.z - cloud_layers[layer].base_m;
        if up_m >= 0.0 && up_m <= cloud_layers[layer].thickness_m {
            let matter = cloud_matter[layer];
            let albedo = dot(matter.albedo, vec3<f32>(1.0 / 3.0));
            // 1 - W f.
            let share = 1.0 - albedo * (1.0 - matter.similarity);
            sum += share * cloud_layers[layer].extinction_per_m * layer_density(layer, place_m.xy, place_m.z);
        }
    }
    return sum;
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[part.level];
    if any(id >= box.size * REFINEMENT) {
        return;
    }
    let texel_m = box.cell_m / f32(REFINEMENT);
    var sum = 0.0;
    for (var i = 0u; i < 8u; i++) {
        let corner = vec3<f32>(vec3<u32>(i, i >> 1u, i >> 2u) & vec3<u32>(1u));
        sum += similar_extinction(box.lowest_m + (vec3<f32>(id) + 0.25 + 0.5 * corner) * texel_m);
    }
    let slice = box.first_slice * REFINEMENT;
    textureStore(ordinates_extinction_image, vec3<u32>(id.xy, id.z + slice), vec4<f32>(0.125 * sum, 0.0, 0.0, 0.0));
}
