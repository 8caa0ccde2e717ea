// Pass: linear radiance of pixels, each evaluated for itself: the air, the ground behind it, and the discs of the lights.
//
// Definitions: SURFACE (something stands before the camera); LATTICE (only the pixels of listed cells: welkin::lattice).

#import welkin::aerial::{air_radiance_before_of, reach_of}
#import welkin::atmosphere::PI
#import welkin::camera::{view_direction, pixel_angle_rad}
#ifdef LATTICE
#import welkin::cell_list::{cell_of_entry, CELL_TOTAL, LIST_HEADER, MOST_GROUPS}
#import welkin::lattice::CELL
#endif
#ifdef SPHERE
#import welkin::lit_sphere::{is_sphere, sphere_radiance}
#endif
#import welkin::observer::{observer, DISC_COUNT, LIGHT_COUNT}
#import welkin::pixel::{media_across, put, radiance_image, seen_through_clouds, Seen}
#ifdef SURFACE
#import welkin::pixel::{overlay, surface_image, NO_SURFACE_M}
#endif
#import welkin::smooth_sky::{relative_to_light, smooth_sky}

#ifdef LATTICE
// The number of cells, and each.
@group(0) @binding(21) var<storage, read> exact_cells: array<u32>;
#endif

// The part of a pixel that lies on one side of the horizon.
struct HalfPixel {
    below_horizon: bool,
    // Of the whole pixel: between 0 and 1 where the horizon runs through it, so that the horizon is no stair.
    share: f32,
    // Of the middle of the part.
    zenith_rad: f32,
}

fn half_pixel(view: vec3<f32>, zenith_rad: f32, below_horizon: bool) -> HalfPixel {
    let pixel_rad = pixel_angle_rad(view);
    // From the horizon into this half.
    let side = select(-1.0, 1.0, below_horizon);
    let inside_rad = side * (zenith_rad - observer.view.horizon_rad);
    var half: HalfPixel;
    half.below_horizon = below_horizon;
    half.share = clamp(inside_rad / pixel_rad + 0.5, 0.0, 1.0);
    half.zenith_rad = zenith_rad;
    if half.share < 1.0 {
        half.zenith_rad = clamp(observer.view.horizon_rad + side * 0.5 * half.share * pixel_rad, 0.0, PI);
    }
    return half;
}

// Radiance of a light's disc per unit irradiance, 1/sr, spread over the pixels that it touches so that together they
// receive its irradiance, however small it is.
fn disc_radiance(view: vec3<f32>, light: u32) -> vec3<f32> {
    let disc = observer.lights[light];
    if disc.angular_radius_rad <= 0.0 {
        return vec3<f32>(0.0);
    }
    let blur_rad = pixel_angle_rad(view);
    let radius_rad = max(disc.angular_radius_rad, 0.5 * blur_rad);
#ifdef SPHERE
    if is_sphere(light) && distance(view, disc.direction) < radius_rad + blur_rad {
        return sphere_radiance(view, light, radius_rad, blur_rad);
    }
#endif
    // The chord keeps the digits that the arc cosine of nu would lose.
    let angle_rad = 2.0 * asin(0.5 * min(distance(view, disc.direction), 2.0));
    let coverage = clamp((radius_rad - angle_rad) / blur_rad + 0.5, 0.0, 1.0);
    if coverage == 0.0 {
        return vec3<f32>(0.0);
    }
    let x = min(angle_rad / radius_rad, 1.0);
    let cosine = sqrt(max(1.0 - x * x, 1e-4));
    // A disc of a few pixels has no limb that could be told apart.
    let exponent = disc.limb_exponent * clamp(disc.angular_radius_rad / blur_rad - 1.0, 0.0, 1.0);
    // The mean of cosine^k over the disc is 2 / (2 + k).
    let profile = 0.5 * (2.0 + exponent) * pow(vec3<f32>(cosine), exponent);
    // The solid angle under the coverage, a cone that is cut off at its top.
    let solid_angle_sr = PI * (radius_rad * radius_rad + blur_rad * blur_rad / 12.0);
    return coverage * profile / solid_angle_sr;
}

// What a pixel sees in one half of the view sphere, behind what was marched in a pixel.
fn seen(pixel: vec2<u32>, view: vec3<f32>, half: HalfPixel) -> Seen {
    var seen = seen_through_clouds(pixel, view, smooth_sky(view, half.zenith_rad, half.below_horizon));
    // The last of them are only seen, and light nothing.
    for (var light = 0u; light < DISC_COUNT && !half.below_horizon; light++) {
        seen.radiance += observer.lights[light].irradiance * seen.transmittance * disc_radiance(view, light);
    }
    return seen;
}

#ifdef SURFACE
// A surface through the air and the clouds before it.
fn seen_before(pixel: vec2<u32>, view: vec3<f32>, zenith_rad: f32, surface: vec4<f32>) -> Seen {
    let below_horizon = zenith_rad > observer.view.horizon_rad;
    let reach = reach_of(relative_to_light(view, zenith_rad, below_horizon, 0u), surface.a);
    let clouds = overlay(pixel, reach.transmittance);
    let transmittance = clouds.transmittance * reach.transmittance;
    var seen = Seen(clouds.radiance + clouds.transmittance * reach.emission + transmittance * surface.rgb, transmittance);
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let direction = relative_to_light(view, zenith_rad, below_horizon, light);
        let radiance = air_radiance_before_of(light, direction, reach, clouds.air);
        seen.radiance += observer.lights[light].irradiance * radiance;
    }
    return seen;
}
#endif

// What a pixel sees, evaluated for itself.
fn seen_by(pixel: vec2<u32>, view: vec3<f32>) -> Seen {
    let zenith_rad = atan2(length(view.xy), view.z);
#ifdef SURFACE
    let surface = textureLoad(surface_image, pixel, 0);
    if surface.a < NO_SURFACE_M {
        return seen_before(pixel, view, zenith_rad, surface);
    }
#endif
    let below_horizon = zenith_rad > observer.view.horizon_rad;
    let half = half_pixel(view, zenith_rad, below_horizon);
    var pixel_sees = seen(pixel, view, half);
    // Only the pixels on the horizon look both ways. A loop and not a branch: devices that compute several pixels in
    // lockstep leave it at once where no pixel needs it.
    for (var i = 0u; i < 1u && half.share < 1.0; i++) {
        let across = media_across(pixel, !below_horizon);
        let other = seen(across, view, half_pixel(view, zenith_rad, !below_horizon));
        pixel_sees.radiance = mix(other.radiance, pixel_sees.radiance, half.share);
        pixel_sees.transmittance = mix(other.transmittance, pixel_sees.transmittance, half.share);
    }
    return pixel_sees;
}

#ifdef LATTICE
// One workgroup takes one cell after another, and its invocations pixel after pixel. The loops have their tests at the end:
// devices that compute several pixels in lockstep run what a loop holds before they find that no pixel needs it.
@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) first: u32) {
    var entry = group.x;
    loop {
        let corner = CELL * cell_of_entry(exact_cells[LIST_HEADER + entry]);
        var i = first;
        loop {
            let pixel = corner + vec2<u32>(i % CELL, i / CELL);
            if i < CELL * CELL && all(pixel < textureDimensions(radiance_image)) {
                let view = view_direction(pixel);
                put(pixel, view, seen_by(pixel, view));
            }
            continuing {
                i += 64u;
                break if i >= CELL * CELL;
            }
        }
        continuing {
            entry += MOST_GROUPS;
            break if entry >= exact_cells[CELL_TOTAL];
        }
    }
}
#else
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(radiance_image)) {
        return;
    }
    let view = view_direction(pixel.xy);
    put(pixel.xy, view, seen_by(pixel.xy, view));
}
#endif
