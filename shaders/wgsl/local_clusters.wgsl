// Pass: which local volumes and lights may matter in each cluster.
//
// One invocation tests 32 spheres against the cone of one tile, and finds the slices that each of them reaches; of lights, also
// those in which they are near as welkin::lamp_grid has it.
//
// Definitions: LAMP_FROXELS.

#import welkin::camera::{camera, pixel_angle_rad, view_direction}
#import welkin::cluster::{
    cluster_of, slice_end_m, slice_of, slice_start_m, COLUMNS, LIGHT_WORDS, SLICES, TILE, VOLUME_WORDS, WORDS,
}
#ifdef LAMP_FROXELS
#import welkin::lamp_grid::{tile_rad, FIRST_M, NONE_NEAR_TILES}
#endif
#import welkin::local_light::local_lights
#import welkin::observer::observer
#import welkin::volume_field::{volumes, FOG_COUNT, VOLUME_COUNT}

@group(1) @binding(46) var<storage, read_write> cluster_masks: array<u32>;

struct Cone {
    axis: vec3<f32>,
    angle_rad: f32,
}

fn angle_rad(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return 2.0 * asin(min(0.5 * distance(a, b), 1.0));
}

fn cone_of(tile: vec2<u32>) -> Cone {
    let first = tile * TILE;
    let axis = view_direction(first + TILE / 2u);
    var widest = 0.0;
    for (var i = 0u; i < 4u; i++) {
        widest = max(widest, angle_rad(axis, view_direction(first + vec2<u32>(i & 1u, i >> 1u) * (TILE - 1u))));
    }
    return Cone(axis, widest + 2.0 * pixel_angle_rad(camera.forward));
}

// (centre, radius) of an item of a word.
fn sphere_of(word: u32, bit: u32) -> vec4<f32> {
    if word < VOLUME_WORDS {
        let index = FOG_COUNT + 32u * word + bit;
        if index >= VOLUME_COUNT {
            return vec4<f32>(0.0, 0.0, 0.0, -1.0);
        }
        return vec4<f32>(volumes[index].centre_m, length(volumes[index].half_size_m));
    }
    let light = 32u * (word - VOLUME_WORDS) + bit;
#if LOCAL_LIGHT_COUNT > 0
    if light < #{LOCAL_LIGHT_COUNT}u {
        return vec4<f32>(local_lights[light].position_m, local_lights[light].reach_m);
    }
#endif
    return vec4<f32>(0.0, 0.0, 0.0, -1.0);
}

// Whether a sphere comes into a cone from the camera, its middle in a direction.
fn meets(cone: Cone, offset_m: vec3<f32>, radius_m: f32) -> bool {
    let distance_m = length(offset_m);
    let reach_rad = asin(min(radius_m / max(distance_m, 1e-9), 1.0));
    return distance_m <= radius_m || angle_rad(cone.axis, offset_m / distance_m) <= cone.angle_rad + reach_rad;
}

#ifdef LAMP_FROXELS
// Whether any place of a slice may find a share of a light near.
fn is_near(cone: Cone, offset_m: vec3<f32>, core_m: f32, slice: u32) -> bool {
    let distance_m = length(offset_m);
    let tile = tile_rad();
    let beside_m = NONE_NEAR_TILES * tile * max(slice_end_m(slice), FIRST_M);
    let beside = distance_m + beside_m >= slice_start_m(slice)
        && distance_m - beside_m <= slice_end_m(slice) && meets(cone, offset_m, beside_m);
    let core = distance_m >= slice_start_m(slice) && distance_m - slice_end_m(slice) <= core_m
        && angle_rad(cone.axis, offset_m / max(distance_m, 1e-9)) <= cone.angle_rad + 1.02 * NONE_NEAR_TILES * tile;
    return beside || core;
}
#endif

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let word = id.x % WORDS;
    let number = id.x / WORDS;
    let tile = vec2<u32>(number % COLUMNS, number / COLUMNS);
    let first = cluster_of(tile * TILE, 0u) + word;
    if first + (SLICES - 1u) * WORDS >= arrayLength(&cluster_masks) {
        return;
    }
    let cone = cone_of(tile);
    let asks_near = word >= VOLUME_WORDS + LIGHT_WORDS;
    let of_word = select(word, word - LIGHT_WORDS, asks_near);
    var bits: array<u32, SLICES>;
    for (var bit = 0u; bit < 32u; bit++) {
        let sphere = sphere_of(of_word, bit);
        let offset = sphere.xyz - vec3<f32>(0.0, 0.0, observer.altitude_m);
        if sphere.w < 0.0 || !meets(cone, offset, sphere.w) {
            continue;
        }
        let distance_m = length(offset);
        let last = slice_of(distance_m + sphere.w);
        for (var slice = slice_of(max(distance_m - sphere.w, 0.0)); slice <= last; slice++) {
            var counts = true;
#ifdef LAMP_FROXELS
            if asks_near {
                let light = 32u * (of_word - VOLUME_WORDS) + bit;
                counts = is_near(cone, offset, local_lights[light].core_reach_m, slice);
            }
#endif
            bits[slice] |= u32(counts) << bit;
        }
    }
    for (var slice = 0u; slice < SLICES; slice++) {
        cluster_masks[first + slice * WORDS] = bits[slice];
    }
}
