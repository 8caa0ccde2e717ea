#define_import_path welkin::local_light
// Point and spot lights, and glowing volumes as seen from outside: their falloff, and what media leave of them.
//
// Definitions: LOCAL_LIGHT_SAMPLES; CLOUDS.

#import welkin::cloud_grid::local_direction
#ifdef CLOUDS
#import welkin::cloud_way::cloud_depth
#endif
#import welkin::lamp_field::scattered_irradiance
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
    outer_cosine: f32,
    // Share of all directions that the cone lights.
    solid_share: f32,
    // Beyond this distance the core of the glow around it may be blurred.
    core_reach_m: f32,
    // The table of the matter that it stands in: welkin::lamp_field.
    field: u32,
    // Volumes that may stand before it, in `local_lists`.
    lists_first: u32,
    list_count: u32,
    // 1 - the mean cosine of that matter's phase function.
    backward: f32,
    padding: f32,
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

// The same of its scattered light: what scattering has not turned yet keeps to the cone, the rest is a point light's of as much power.
fn scattered_cone_share(light: u32, cone: f32, depth: vec3<f32>) -> f32 {
    let mean_depth = dot(depth, vec3<f32>(1.0 / 3.0));
    return mix(local_lights[light].solid_share, cone, exp(-local_lights[light].backward * mean_depth));
}

// Optical depth of fog, volumes and clouds between a place and a light.
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
#ifdef CLOUDS
    depth += vec3<f32>(cloud_depth(place.map, place.altitude_m, local, distance_m));
#endif
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
    let cosine = dot(normal, toward);
    let depth = depth_to_local_light(light, place, toward, distance_m);
    let cone = cone_share(light, -toward);
    var share = cone * max(cosine, 0.0) * exp(-depth);
#ifdef VOLUME_ORDERS
    share += scattered_cone_share(light, cone, depth) * scattered_irradiance(local_lights[light].field, depth, cosine);
#endif
    return local_lights[light].intensity * share / (distance_m * distance_m + local_lights[light].size_squared);
}
