#define_import_path welkin::local_light
// Point and spot lights, and glowing volumes as seen from outside: their falloff, and what media leave of them.
//
// Definitions: LOCAL_LIGHT_SAMPLES.

#import welkin::cloud_grid::local_direction
#import welkin::local_lists::local_lists
#import welkin::volume_field::{fog_length_m, local_length_m, volumes, Place, FOG_COUNT}

struct LocalLight {
    position_m: vec3<f32>,
    // Beyond this distance it is left out.
    reach_m: f32,
    // W/sr/nm, along the axis of a cone.
    intensity: vec3<f32>,
    // Square of the size of what shines, m2: nearer its light grows no more.
    size_squared: f32,
    // Where the cone's axis points.
    axis: vec3<f32>,
    inner_cosine: f32,
    // Mean radiance of light scattered many times at a distance d: this times e^(-decay d) / d, W/m/sr/nm.
    diffuse: vec3<f32>,
    outer_cosine: f32,
    decay_per_m: vec3<f32>,
    lists_first: u32,
    list_count: u32,
    padding_a: u32,
    padding_b: u32,
    padding_c: u32,
}

@group(1) @binding(45) var<storage, read> local_lights: array<LocalLight>;

const SAMPLES: u32 = #{LOCAL_LIGHT_SAMPLES}u;

// Share of a light's intensity in a direction away from it; everywhere 1 without a cone.
fn cone_share(light: u32, away: vec3<f32>) -> f32 {
    let outer = local_lights[light].outer_cosine;
    let cosine = dot(away, local_lights[light].axis);
    let x = saturate((cosine - outer) / (local_lights[light].inner_cosine - outer));
    return select(x * x * (3.0 - 2.0 * x), 1.0, outer < -1.0);
}

// Optical depth of fog and volumes between a place and a light.
fn depth_to_local_light(light: u32, place: Place, toward: vec3<f32>, distance_m: f32) -> vec3<f32> {
    let local = local_direction(place.map, toward);
    var depth = vec3<f32>(0.0);
    for (var i = 0u; i < FOG_COUNT; i++) {
        depth += volumes[i].extinction_per_m * fog_length_m(i, place, local, distance_m, SAMPLES);
    }
    for (var i = 0u; i < local_lights[light].list_count; i++) {
        let other = local_lists[local_lights[light].lists_first + i];
        depth += volumes[other].extinction_per_m * local_length_m(other, place.p, toward, distance_m, SAMPLES);
    }
    return depth;
}

// Irradiance of a local light on a plane through a place, W/m2/nm: what arrives straight, and what media have scattered.
fn local_irradiance(light: u32, place: Place, normal: vec3<f32>) -> vec3<f32> {
    let offset = local_lights[light].position_m - place.p;
    let distance_m = length(offset);
    if distance_m >= local_lights[light].reach_m || distance_m <= 0.0 {
        return vec3<f32>(0.0);
    }
    let toward = offset / distance_m;
    let depth = depth_to_local_light(light, place, toward, distance_m);
    let squared = distance_m * distance_m + local_lights[light].size_squared;
    let straight = local_lights[light].intensity * cone_share(light, -toward) * max(dot(normal, toward), 0.0) / squared;
    let diffuse = local_lights[light].diffuse * exp(-local_lights[light].decay_per_m * distance_m) / sqrt(squared);
    return straight * exp(-depth) + 3.1415927 * diffuse;
}
