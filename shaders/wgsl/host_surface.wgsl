// Pass: what a host has drawn before the sky, from its depth and colour: radiance, and distance along each pixel's ray.
//
// Definitions: DISTANCE (depth is the distance along the ray), PLANAR (from the camera's plane), both in m; else depth is
// that of a perspective projection.

#import welkin::camera::{camera, view_direction}

@group(0) @binding(0) var host_depth_image: texture_2d<f32>;
@group(0) @binding(1) var host_colour_image: texture_2d<f32>;
@group(0) @binding(2) var foreground_image: texture_storage_2d<rgba32float, write>;

struct HostSurface {
    // From the host's colour to radiance, W/m2/sr/nm.
    to_radiance: mat3x3<f32>,
    // Depth from the camera's plane is numerator_m / (offset + slope depth).
    numerator_m: f32,
    offset: f32,
    // 1 where depth falls from 1 to 0 with distance, -1 where it grows.
    slope: f32,
    padding: f32,
}

@group(0) @binding(3) var<uniform> host_surface: HostSurface;

// At this distance and beyond there is no surface, m.
const NO_SURFACE_M: f32 = 1e30;
// No colour is brighter: infinite ones would spread.
const BRIGHTEST: f32 = 1e30;

// Distance along the ray, m; NO_SURFACE_M where the host has drawn nothing.
fn surface_distance_m(depth: f32, view: vec3<f32>) -> f32 {
#ifdef DISTANCE
    return select(NO_SURFACE_M, depth, depth > 0.0 && depth < NO_SURFACE_M);
#else
    let cosine = dot(view, camera.forward);
#ifdef PLANAR
    return select(NO_SURFACE_M, depth / cosine, depth > 0.0 && depth < NO_SURFACE_M);
#else
    let is_cleared = select(depth <= 0.0, depth >= 1.0, host_surface.slope < 0.0);
    let planar_m = host_surface.numerator_m / (host_surface.offset + host_surface.slope * depth);
    return select(planar_m / cosine, NO_SURFACE_M, is_cleared);
#endif
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(foreground_image)) {
        return;
    }
    let distance_m = surface_distance_m(textureLoad(host_depth_image, id.xy, 0).r, view_direction(id.xy));
    let colour = textureLoad(host_colour_image, id.xy, 0).rgb;
    let radiance = clamp(host_surface.to_radiance * colour, vec3<f32>(0.0), vec3<f32>(BRIGHTEST));
    textureStore(foreground_image, id.xy, vec4<f32>(radiance, distance_m));
}
