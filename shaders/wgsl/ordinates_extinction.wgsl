// Pass: extinction of the clouds' similar medium in every fine texel of the ordinates' grids, 1/m: the mean, and that with
// which a texel lets light through.
//
// One invocation a texel of one level, from eight points. Lumps let more light through between them than their mean
// extinction would: the second is -ln <e^-depth> / length over the lines through the points, the mean of the three axes.

#import welkin::cloud_field::{cloud_layers, layer_density, CLOUD_LAYER_COUNT}
#import welkin::cloud_matter::{cloud_matter, similar_share}
#import welkin::ordinates_grid::{ordinates, REFINEMENT}

struct Part {
    level: u32,
}

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var ordinates_extinction_image: texture_storage_3d<r32float, write>;
@group(0) @binding(2) var ordinates_passing_image: texture_storage_3d<r32float, write>;

// c' of all layers at a place, 1/m.
fn similar_extinction(place_m: vec3<f32>) -> f32 {
    var sum = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let up_m = place_m.z - cloud_layers[layer].base_m;
        if up_m >= 0.0 && up_m <= cloud_layers[layer].thickness_m {
            let extinction_per_m = cloud_layers[layer].extinction_per_m * layer_density(layer, place_m.xy, place_m.z);
            sum += similar_share(cloud_matter[layer]) * extinction_per_m;
        }
    }
    return sum;
}

// By four lines of two points along each axis.
fn passing_extinction(points: ptr<function, array<f32, 8>>, texel_m: vec3<f32>) -> f32 {
    var sum = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let next = 1u << axis;
        var depths: vec4<f32>;
        for (var line = 0u; line < 4u; line++) {
            // The line's first point: the bits of its number, with none for this axis.
            let first = ((line >> axis) << (axis + 1u)) | (line & (next - 1u));
            depths[line] = 0.5 * texel_m[axis] * ((*points)[first] + (*points)[first | next]);
        }
        let least = min(min(depths.x, depths.y), min(depths.z, depths.w));
        let passed = dot(exp(least - depths), vec4<f32>(0.25));
        sum += (least - log(passed)) / texel_m[axis];
    }
    return sum / 3.0;
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[part.level];
    if any(id >= box.size * REFINEMENT) {
        return;
    }
    let texel_m = box.cell_m / f32(REFINEMENT);
    var points: array<f32, 8>;
    var sum = 0.0;
    // A number that no compiler foresees, which would write the clouds' density out eight times: see welkin::loops.
    let point_count = 8u + u32(texel_m.x < 0.0);
    for (var i = 0u; i < point_count; i++) {
        let corner = vec3<f32>(vec3<u32>(i, i >> 1u, i >> 2u) & vec3<u32>(1u));
        points[i] = similar_extinction(box.lowest_m + (vec3<f32>(id) + 0.25 + 0.5 * corner) * texel_m);
        sum += points[i];
    }
    let slice = box.first_slice * REFINEMENT;
    let texel = vec3<u32>(id.xy, id.z + slice);
    let mean_per_m = 0.125 * sum;
    let passing_per_m = clamp(passing_extinction(&points, texel_m), 0.0, mean_per_m);
    textureStore(ordinates_extinction_image, texel, vec4<f32>(mean_per_m, 0.0, 0.0, 0.0));
    textureStore(ordinates_passing_image, texel, vec4<f32>(passing_per_m, 0.0, 0.0, 0.0));
}
