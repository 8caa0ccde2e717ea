#define_import_path welkin::media_march
// What every march through media shares: a pixel's ray with its cuts, and the air that it passes.
//
// The air's light in front of a depth t is taken as A (1 - T(t)) / (1 - T(end)), A the whole ray's: exact where the light
// scattered per optical depth does not change along the ray. Media take from it where they stand before the first light; what
// clouds scatter down adds to the air's diffuse light.
//
// Definitions: CLOUDS; SURFACE; AIR; FOG_COUNT.

#import welkin::atmosphere::{atmosphere, extinction_at}
#import welkin::attenuation::opacity
#import welkin::camera::view_direction
#ifdef CLOUDS
#import welkin::cloud_daylight::{clear_fluxes, cover_at, diffuse_share, left_on_ground, straight_left, ClearFluxes}
#import welkin::cloud_field::cloud_layers
#endif
#import welkin::cloud_field::{to_map, CLOUD_LAYER_COUNT}
#import welkin::geometry
#import welkin::observer::observer
#import welkin::tables::optical_depth_to_top
#import welkin::volume_field::FOG_COUNT
#if FOG_COUNT > 0
#import welkin::fog_daylight::air_above_fog
#import welkin::volume_field::volumes
#endif

#ifdef SURFACE
// What stands before the camera: its distance, m, beside its light.
@group(0) @binding(19) var surface_image: texture_2d<f32>;
#endif

const NEVER_M: f32 = 1e30;
// Two shells, each met twice.
const CROSSINGS: u32 = 4u * (FOG_COUNT + CLOUD_LAYER_COUNT);
const CROSSING_SLOTS: u32 = max(CROSSINGS, 1u);
// Optical depth beyond which nothing is looked at. Light scattered many times comes from deep inside, dimmed
// by only that share of the depth which turns it away, a quarter for droplets: e^-6 of it is left here. A light's disc, a
// hundred thousand times as bright as the sky, is hidden as well.
const OPAQUE: f32 = 24.0;
// From a depth on steps grow in proportion to it, up to so many times: what is seen there is smooth.
const SMOOTH_GROWTH: f32 = 4.0;

struct Ray {
    pixel: vec2<u32>,
    direction: vec3<f32>,
    end_m: f32,
    meets_ground: bool,
    // Where it crosses the bottoms and tops of layers; NEVER_M for those behind.
    crossings_m: array<f32, CROSSING_SLOTS>,
}

fn observer_position() -> vec3<f32> {
    return vec3<f32>(0.0, 0.0, observer.altitude_m);
}

fn position_m(ray: ptr<function, Ray>, t_m: f32) -> vec3<f32> {
    return observer_position() + (*ray).direction * t_m;
}

fn altitude_m(ray: ptr<function, Ray>, t_m: f32) -> f32 {
    return geometry::altitude_along(atmosphere.radius_m, observer.altitude_m, (*ray).direction.z, t_m);
}

// How far a ray climbs per metre, at a distance and the altitude there.
fn rise_at(ray: ptr<function, Ray>, t_m: f32, altitude: f32) -> f32 {
    let r = atmosphere.radius_m + observer.altitude_m;
    return (r * (*ray).direction.z + t_m) / (atmosphere.radius_m + altitude);
}

// Both distances to a shell, NEVER_M for those behind.
fn shell_crossings_m(mu: f32, shell_m: f32) -> vec2<f32> {
    let both = geometry::shell_crossings_m(atmosphere.radius_m, observer.altitude_m, mu, shell_m);
    return select(vec2<f32>(NEVER_M), both, both > vec2<f32>(0.0));
}

fn cut_at_layer(ray: ptr<function, Ray>, layer: u32, bottom_m: f32, top_m: f32) {
    let bottom = shell_crossings_m((*ray).direction.z, bottom_m);
    let top = shell_crossings_m((*ray).direction.z, top_m);
    (*ray).crossings_m[4u * layer] = bottom.x;
    (*ray).crossings_m[4u * layer + 1u] = bottom.y;
    (*ray).crossings_m[4u * layer + 2u] = top.x;
    (*ray).crossings_m[4u * layer + 3u] = top.y;
}

// The ray in a direction that lies in a pixel, without what stands before the camera.
fn clear_way_along(direction: vec3<f32>, pixel: vec2<u32>) -> Ray {
    var ray: Ray;
    ray.pixel = pixel;
    ray.direction = direction;
    ray.end_m = NEVER_M;
    if ray.direction.z < geometry::horizon_mu(atmosphere.radius_m, observer.altitude_m) {
        ray.end_m = geometry::distance_to_shell_from_above(atmosphere.radius_m, observer.altitude_m, ray.direction.z, 0.0);
        ray.meets_ground = true;
    }
#if FOG_COUNT > 0
    for (var i = 0u; i < FOG_COUNT; i++) {
        cut_at_layer(&ray, i, volumes[i].bottom_m, volumes[i].top_m);
    }
#endif
#ifdef CLOUDS
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let base_m = cloud_layers[layer].base_m;
        cut_at_layer(&ray, FOG_COUNT + layer, base_m, base_m + cloud_layers[layer].thickness_m);
    }
#endif
    return ray;
}

// That of a pixel.
fn clear_way_of(pixel: vec2<u32>) -> Ray {
    return clear_way_along(view_direction(pixel), pixel);
}

// The same up to what stands there.
fn ray_of(pixel: vec2<u32>) -> Ray {
    var ray = clear_way_of(pixel);
#ifdef SURFACE
    // Without a surface it is never.
    let surface_m = textureLoad(surface_image, pixel, 0).a;
    ray.meets_ground = ray.meets_ground && surface_m > ray.end_m;
    ray.end_m = min(ray.end_m, surface_m);
#endif
    return ray;
}

// The next crossing of a layer after a distance, at most the ray's end.
fn next_crossing_m(ray: ptr<function, Ray>, t_m: f32) -> f32 {
    let after = t_m * 1.000001 + 0.01;
    var next = NEVER_M;
    for (var i = 0u; i < CROSSINGS; i++) {
        let crossing = (*ray).crossings_m[i];
        next = select(next, min(next, crossing), crossing > after);
    }
    return min(next, (*ray).end_m);
}

// How much longer steps may be behind an optical depth, if they may be from a depth on.
fn growth_behind(depth: f32, smooth_depth: f32) -> f32 {
    return clamp(depth / smooth_depth, 1.0, SMOOTH_GROWTH);
}

// A tile of blue noise in rows, in [0, 1).
@group(1) @binding(57) var<storage, read> blue_noise: array<f32>;
const NOISE_SIDE: u32 = 64u;

// Where a ray looks at each of its steps, in [0, 1): as unlike its neighbours as can be. Rays side by side have numbers side by side.
fn place_in_step(number: vec2<u32>, jitter: f32) -> f32 {
    let within = number % NOISE_SIDE;
    return fract(blue_noise[within.y * NOISE_SIDE + within.x] + jitter);
}

// The air along a ray. It changes less than media do, so it is followed in strides of its own, behind the march.
struct Air {
    // How far it has been followed, m; its optical depth to there, and its extinction just before.
    at_m: f32,
    depth: vec3<f32>,
    extinction_per_m: vec3<f32>,
    // How far the march has come, m, and int T dt over what has not been followed, T of media.
    passed_m: f32,
    media_m: vec3<f32>,
    // int T S dT_air, T of media and S what clouds leave of the light that the air scatters: of the beam, of diffuse light.
    beam: vec3<f32>,
    diffuse: vec3<f32>,
#ifdef CLOUDS
    clear: ClearFluxes,
#endif
#if FOG_COUNT > 0
    // Share of its diffuse light above the fog.
    above_fog: vec3<f32>,
#endif
}

fn clear_air() -> Air {
    var air: Air;
#ifdef AIR
    air.extinction_per_m = extinction_at(observer.altitude_m);
#endif
#ifdef CLOUDS
    air.clear = clear_fluxes(cloud_layers[0].base_m, observer.lights[0].direction.z);
#endif
#if FOG_COUNT > 0
    air.above_fog = air_above_fog();
#endif
    return air;
}

// The light that air at a place scatters, over that in clear air: of the beam, and diffuse light.
fn add_air(air: ptr<function, Air>, map: vec2<f32>, altitude: f32, share: vec3<f32>) {
    var diffuse = share;
#if FOG_COUNT > 0
    if altitude >= volumes[0].top_m {
        diffuse *= (*air).above_fog;
    }
#endif
#ifdef CLOUDS
    (*air).beam += straight_left(0u, map, altitude) * share;
    (*air).diffuse += diffuse_share(cover_at(map, altitude), (*air).clear) * diffuse;
#else
    (*air).beam += share;
    (*air).diffuse += diffuse;
#endif
}

// Steps through air, whose light changes where shadows of clouds lie, m; longer in the distance. Twice as long, they show as bands in clear sky
// where one more begins.
const AIR_STEP_M: f32 = 400.0;
const AIR_STEP_GROWTH: f32 = 0.05;
const AIR_STEPS: f32 = 24.0;

fn air_step_m(air: ptr<function, Air>) -> f32 {
    return max(AIR_STEP_M, AIR_STEP_GROWTH * (*air).at_m);
}

// Follows the air to where the march has come.
fn follow_air(air: ptr<function, Air>, ray: ptr<function, Ray>) {
#ifdef AIR
    let length_m = (*air).passed_m - (*air).at_m;
    if length_m <= 0.0 {
        return;
    }
    let media = (*air).media_m / length_m;
    let count = u32(clamp(ceil(length_m / air_step_m(air)), 1.0, AIR_STEPS));
    let step_m = length_m / f32(count);
    for (var i = 0u; i < count; i++) {
        let middle_m = (*air).at_m + (f32(i) + 0.5) * step_m;
        let altitude = altitude_m(ray, middle_m);
        (*air).extinction_per_m = extinction_at(altitude);
        let own = step_m * (*air).extinction_per_m;
        let share = media * exp(-(*air).depth) * opacity(own);
        (*air).depth += own;
        add_air(air, to_map(atmosphere.radius_m, position_m(ray, middle_m)), altitude, share);
    }
    (*air).at_m = (*air).passed_m;
    (*air).media_m = vec3<f32>(0.0);
#endif
}

// Goes on to a distance behind media of a transmittance.
fn pass_air(air: ptr<function, Air>, ray: ptr<function, Ray>, media: vec3<f32>, to_m: f32) {
    (*air).media_m += media * (to_m - (*air).passed_m);
    (*air).passed_m = to_m;
    if to_m - (*air).at_m >= air_step_m(air) {
        follow_air(air, ray);
    }
}

// What the air leaves of light from a distance, at most one of its strides ahead.
fn through_air(air: ptr<function, Air>, t_m: f32) -> vec3<f32> {
    return exp(-(*air).depth - (*air).extinction_per_m * (t_m - (*air).at_m));
}

// What clouds leave on a point of a surface: of the first light's flux and of the sky's light.
fn left_on_surface(air: ptr<function, Air>, map: vec2<f32>, altitude: f32) -> vec2<f32> {
#ifdef CLOUDS
    return left_on_ground(straight_left(0u, map, altitude), cover_at(map, altitude), (*air).clear);
#else
    return vec2<f32>(1.0);
#endif
}

// Moves on through the air beyond a distance, out into space: above all clouds and fog, or below none. What nothing lights or hides
// there needs no look.
fn leave_air(air: ptr<function, Air>, ray: ptr<function, Ray>, media: vec3<f32>) {
    follow_air(air, ray);
#ifdef AIR
    if FOG_COUNT == 0u && CLOUD_LAYER_COUNT == 0u {
        return;
    }
    let from_m = (*air).passed_m;
    var at_m = from_m;
    if altitude_m(ray, from_m) > atmosphere.top_m {
        // From space, the air is still ahead or never met.
        at_m = shell_crossings_m((*ray).direction.z, atmosphere.top_m).x;
        if at_m >= NEVER_M || at_m < from_m {
            return;
        }
    }
    let altitude = clamp(altitude_m(ray, at_m), 0.0, atmosphere.top_m);
    let rise = (atmosphere.radius_m + observer.altitude_m) * (*ray).direction.z + at_m;
    let mu = max(rise / (atmosphere.radius_m + altitude), geometry::horizon_mu(atmosphere.radius_m, altitude));
    let own = optical_depth_to_top(altitude, mu);
    let share = media * exp(-(*air).depth) * opacity(own);
    (*air).depth += own;
    add_air(air, to_map(atmosphere.radius_m, position_m(ray, at_m)), altitude, share);
#endif
}
