// Pass: clouds along every pixel's ray: their light, what they let through, and how much of the air's light is left.
//
// The ray is cut where it crosses a layer's base or top; gaps are taken in one step, and inside layers steps skip what
// is certainly empty. In a step the light is integrated with its own attenuation, so that no step is too long for
// energy. Steps start at a place of their own in each pixel, by a hash: the same picture every time.
//
// The air's light in front of a depth t is taken as A (1 - T(t)) / (1 - T(end)), A the whole ray's: exact where the
// light scattered per optical depth does not change along the ray. Clouds take from it where they stand before the first
// light; what they scatter down adds to the air's diffuse light.
//
// One pixel of every block of CLOUD_BLOCK x CLOUD_BLOCK is marched, another one each frame; the ray ends at a surface that
// stands before the camera.
//
// Definitions: CLOUD_DISTANCE (also write distances); CLOUD_BLOCK; SURFACE; CLOUD_MAX_STEPS; CLOUD_STEP_M, the shortest step; CLOUD_STEP_PERMILLE, a step's share of the distance.

#import welkin::atmosphere::{atmosphere, extinction_at}
#import welkin::camera::view_direction
#import welkin::cloud_field::{cloud_layers, layer_density, to_map, CLOUD_LAYER_COUNT}
#import welkin::cloud_daylight::{clear_fluxes, daylight, diffuse_share, ClearFluxes}
#import welkin::cloud_frame::cloud_frame
#import welkin::cloud_noise::hash
#import welkin::cloud_skip::empty_m
#import welkin::cloud_source::{phases, step_radiance, Sample, PHASE_COUNT}
#import welkin::geometry
#import welkin::observer::{observer, LIGHT_COUNT}

// Light of the clouds at the observer, and their transmittance.
@group(1) @binding(10) var cloud_radiance_image: texture_storage_2d<rgba32float, write>;
// int T S dT_air to the end of the ray and T T_air there, from which what is left of the air's light follows: S is what
// clouds leave of the light that the air scatters, of the sun's beam and, in the second image, of diffuse light. Then what
// they leave on the ground there, of the beam and of the sky.
@group(1) @binding(11) var cloud_air_image: texture_storage_2d<rgba32float, write>;
@group(1) @binding(12) var cloud_diffuse_image: texture_storage_2d<rgba32float, write>;

#ifdef CLOUD_DISTANCE
// Mean distance of the clouds, weighted with what they hide.
@group(1) @binding(13) var cloud_distance_image: texture_storage_2d<r32float, write>;
const INFINITY_BITS: u32 = 0x7f800000u;
#endif

#ifdef SURFACE
// What stands before the camera: its distance, m, beside its light.
@group(0) @binding(19) var surface_image: texture_2d<f32>;
#endif

const BLOCK: u32 = #{CLOUD_BLOCK}u;
const MAX_STEPS: u32 = #{CLOUD_MAX_STEPS}u;
const STEP_M: f32 = #{CLOUD_STEP_M}.0;
const STEP_GROWTH: f32 = #{CLOUD_STEP_PERMILLE}.0 * 0.001;
const CROSSINGS: u32 = 4u * CLOUD_LAYER_COUNT;
const CROSSING_SLOTS: u32 = max(CROSSINGS, 1u);
const NEVER_M: f32 = 1e30;
// Optical depth beyond which nothing of a cloud is looked at. Light scattered many times comes from deep inside, dimmed
// by only that share of the depth which turns it away, a quarter for droplets: e^-6 of it is left here. A light's disc, a
// hundred thousand times as bright as the sky, is hidden as well.
const OPAQUE: f32 = 24.0;
// From this depth on steps grow in proportion to it, up to so many times: what is seen there is smooth.
const SMOOTH_DEPTH: f32 = 4.0;
const SMOOTH_GROWTH: f32 = 4.0;

struct Ray {
    direction: vec3<f32>,
    mu: f32,
    end_m: f32,
    crossings_m: array<f32, CROSSING_SLOTS>,
}

struct Sum {
    radiance: vec3<f32>,
    // Optical depth of clouds and of air so far.
    clouds: f32,
    air: vec3<f32>,
    // int T S dT_air, of beam and diffuse light.
    beam: vec3<f32>,
    diffuse: vec3<f32>,
    // int t dT, m.
    weighted_m: f32,
}

fn altitude_m(ray: Ray, t_m: f32) -> f32 {
    return geometry::altitude_along(atmosphere.radius_m, observer.altitude_m, ray.mu, t_m);
}

// Both distances to a shell, NEVER_M for those behind.
fn shell_crossings_m(mu: f32, shell_m: f32) -> vec2<f32> {
    let radius_m = atmosphere.radius_m;
    let h = observer.altitude_m;
    let gap = (shell_m - h) * (2.0 * radius_m + shell_m + h);
    let b = (radius_m + h) * mu;
    let discriminant = b * b + gap;
    if discriminant < 0.0 {
        return vec2<f32>(NEVER_M);
    }
    let root = sqrt(discriminant);
    // The root without cancellation, then the other from their product.
    let q = -(b + select(-root, root, b >= 0.0));
    let other = select(-gap / q, 0.0, q == 0.0);
    let both = vec2<f32>(min(q, other), max(q, other));
    return select(vec2<f32>(NEVER_M), both, both > vec2<f32>(0.0));
}

fn ray_of(view: vec3<f32>) -> Ray {
    var ray: Ray;
    ray.direction = view;
    ray.mu = view.z;
    ray.end_m = NEVER_M;
    if view.z < geometry::horizon_mu(atmosphere.radius_m, observer.altitude_m) {
        ray.end_m = geometry::distance_to_shell_from_above(atmosphere.radius_m, observer.altitude_m, view.z, 0.0);
    }
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let base_m = cloud_layers[layer].base_m;
        let base = shell_crossings_m(view.z, base_m);
        let top = shell_crossings_m(view.z, base_m + cloud_layers[layer].thickness_m);
        ray.crossings_m[4u * layer] = base.x;
        ray.crossings_m[4u * layer + 1u] = base.y;
        ray.crossings_m[4u * layer + 2u] = top.x;
        ray.crossings_m[4u * layer + 3u] = top.y;
    }
    return ray;
}

// The next boundary after a distance.
fn next_crossing_m(ray: ptr<function, Ray>, t_m: f32) -> f32 {
    let after = t_m * 1.000001 + 0.01;
    var next = NEVER_M;
    for (var i = 0u; i < CROSSINGS; i++) {
        let crossing = (*ray).crossings_m[i];
        next = select(next, min(next, crossing), crossing > after);
    }
    return min(next, (*ray).end_m);
}

fn is_inside(layer: u32, altitude: f32) -> bool {
    let up_m = altitude - cloud_layers[layer].base_m;
    return up_m >= 0.0 && up_m <= cloud_layers[layer].thickness_m;
}

// Steps through air, whose light changes where shadows of clouds lie, m; longer in the distance.
const AIR_STEP_M: f32 = 400.0;
const AIR_STEP_GROWTH: f32 = 0.05;
const AIR_STEPS: f32 = 24.0;

// Moves through air alone.
fn pass_air(sum: ptr<function, Sum>, ray: Ray, clear: ClearFluxes, from_m: f32, to_m: f32) {
#ifdef AIR
    let longest_m = max(AIR_STEP_M, AIR_STEP_GROWTH * from_m);
    let count = u32(clamp(ceil((to_m - from_m) / longest_m), 1.0, AIR_STEPS));
    let step_m = (to_m - from_m) / f32(count);
    for (var i = 0u; i < count; i++) {
        let middle_m = from_m + (f32(i) + 0.5) * step_m;
        let altitude = altitude_m(ray, middle_m);
        let before = exp(-(*sum).air);
        (*sum).air += step_m * extinction_at(altitude);
        let map = to_map(atmosphere.radius_m, observer_position() + ray.direction * middle_m);
        let day = daylight(map, altitude);
        let share = exp(-(*sum).clouds) * (before - exp(-(*sum).air));
        (*sum).beam += day.straight * share;
        (*sum).diffuse += diffuse_share(day, clear) * share;
    }
#endif
}

fn random(pixel: vec2<u32>) -> f32 {
    return fract(f32(hash(vec3<i32>(vec2<i32>(pixel), 0), 1u) >> 8u) / 16777216.0 + cloud_frame.jitter);
}

// One step through the layers at a point; returns whether there was any cloud.
fn take_step(
    sum: ptr<function, Sum>, ray: Ray, phase: ptr<function, array<f32, PHASE_COUNT>>, place: vec2<f32>, step_m: f32
) -> bool {
    let at_m = place.x;
    let p = observer_position() + ray.direction * at_m;
    let map = to_map(atmosphere.radius_m, p);
    let altitude = place.y;
    var sample: Sample;
    sample.map = map;
    sample.altitude_m = altitude;
    sample.up = normalize(vec3<f32>(p.xy, p.z + atmosphere.radius_m));
    sample.before = (*sum).clouds;
    var light = vec3<f32>(0.0);
    var extinction = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if is_inside(layer, altitude) {
            extinction += cloud_layers[layer].extinction_per_m * layer_density(layer, map, altitude);
        }
    }
    if extinction <= 0.0 {
        return false;
    }
    sample.step = extinction * step_m;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if is_inside(layer, altitude) {
            sample.layer = layer;
            sample.height = (altitude - cloud_layers[layer].base_m) / cloud_layers[layer].thickness_m;
#if CLOUD_LAYER_COUNT > 1
            let share = cloud_layers[layer].extinction_per_m * layer_density(layer, map, altitude) / extinction;
            light += share * step_radiance(sample, ray.direction, phase);
#else
            light += step_radiance(sample, ray.direction, phase);
#endif
        }
    }
    (*sum).radiance += exp(-(*sum).air) * light;
    (*sum).weighted_m += at_m * (exp(-(*sum).clouds) - exp(-(*sum).clouds - sample.step));
    (*sum).clouds += sample.step;
    return true;
}

fn observer_position() -> vec3<f32> {
    return vec3<f32>(0.0, 0.0, observer.altitude_m);
}

// How far nothing need be looked at from a point, in the layers that hold another altitude: at a boundary the point's
// own may be rounded to the wrong side.
fn skip_m(map: vec2<f32>, altitude: f32, within: f32) -> f32 {
    var least = NEVER_M;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if is_inside(layer, within) {
            least = min(least, empty_m(layer, map, altitude));
        }
    }
    return least;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(cloud_radiance_image)) {
        return;
    }
    let pixel = BLOCK * id.xy + cloud_frame.first_pixel;
    var ray = ray_of(view_direction(pixel));
#ifdef SURFACE
    // Without a surface it is never.
    ray.end_m = min(ray.end_m, textureLoad(surface_image, pixel, 0).a);
#endif
    var phase = phases(ray.direction);
    let offset = random(pixel);
    let clear = clear_fluxes(cloud_layers[0].base_m, observer.lights[0].direction.z);
    var sum: Sum;
    var t_m = 0.0;
    var boundary_m = next_crossing_m(&ray, t_m);
    var entered_m = 0.0;
    var was_empty = true;
    for (var i = 0u; i < MAX_STEPS && t_m < ray.end_m && sum.clouds < OPAQUE; i++) {
        if t_m >= boundary_m {
            boundary_m = next_crossing_m(&ray, t_m);
            entered_m = t_m;
        }
        if boundary_m >= NEVER_M {
            break;
        }
        // Between boundaries the middle tells which layers the ray is in.
        let middle = altitude_m(ray, 0.5 * (t_m + boundary_m));
        var inside = false;
        for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
            inside = inside || is_inside(layer, middle);
        }
        if !inside {
            pass_air(&sum, ray, clear, t_m, boundary_m);
            t_m = boundary_m;
            was_empty = true;
            continue;
        }
        // Seen from far above, a layer still takes a few steps.
        let longest_m = max(0.125 * (boundary_m - entered_m), STEP_M);
        let growth = clamp(sum.clouds / SMOOTH_DEPTH, 1.0, SMOOTH_GROWTH);
        let step_m = min(min(growth * max(STEP_M, STEP_GROWTH * t_m), longest_m), boundary_m - t_m);
        if was_empty {
            let here = observer_position() + ray.direction * t_m;
            let skipped = min(skip_m(to_map(atmosphere.radius_m, here), altitude_m(ray, t_m), middle), boundary_m - t_m);
            if skipped > step_m {
                pass_air(&sum, ray, clear, t_m, t_m + skipped);
                t_m += skipped;
                continue;
            }
        }
        let at_m = t_m + offset * step_m;
        was_empty = !take_step(&sum, ray, &phase, vec2<f32>(at_m, altitude_m(ray, at_m)), step_m);
        pass_air(&sum, ray, clear, t_m, t_m + step_m);
        t_m += step_m;
    }
    var ground = vec2<f32>(1.0);
    if ray.end_m < NEVER_M {
        pass_air(&sum, ray, clear, t_m, ray.end_m);
        let end = to_map(atmosphere.radius_m, observer_position() + ray.direction * ray.end_m);
        let day = daylight(end, max(altitude_m(ray, ray.end_m), 0.0));
        ground = vec2<f32>(day.through, day.diffuse);
    }
    let transmittance = select(exp(-sum.clouds), 0.0, sum.clouds >= OPAQUE);
#ifdef CLOUD_DISTANCE
    // Where nothing is hidden there is no such distance.
    let hidden = 1.0 - transmittance;
    let mean_m = select(bitcast<f32>(INFINITY_BITS), sum.weighted_m / hidden, hidden > 1e-4);
    textureStore(cloud_distance_image, id.xy, vec4<f32>(mean_m, 0.0, 0.0, 0.0));
#endif
    textureStore(cloud_radiance_image, id.xy, vec4<f32>(sum.radiance, transmittance));
    let behind = transmittance * exp(-sum.air);
    textureStore(cloud_air_image, id.xy, vec4<f32>(sum.beam + behind, ground.x));
    textureStore(cloud_diffuse_image, id.xy, vec4<f32>(sum.diffuse + behind, ground.y));
}
