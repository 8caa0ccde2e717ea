// Pass: linear radiance of every pixel: the air, the ground behind it, and the discs of the lights.
//
// Definitions: CAPTURE (also write transmittance and distance, for files and engines), CLOUDS.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::camera::{camera, view_direction, pixel_angle_rad}
#import welkin::march::view_ray
#ifdef SPHERE
#import welkin::lit_sphere::{is_sphere, sphere_radiance}
#endif
#import welkin::observer::{light_mu_s, observer, DISC_COUNT, LIGHT_COUNT}
#import welkin::sky::{air_radiance, emission_radiance, ground_radiance, view_transmittance, SkyDirection}

@group(0) @binding(8) var radiance_image: texture_storage_2d<rgba32float, write>;
#ifdef CAPTURE
@group(0) @binding(9) var transmittance_image: texture_storage_2d<rgba32float, write>;
@group(0) @binding(11) var distance_image: texture_storage_2d<r32float, write>;
// What a file means by "the ray ends in space".
const INFINITY_BITS: u32 = 0x7f800000u;
#endif

#ifdef CLOUDS
@group(1) @binding(10) var cloud_radiance_image: texture_2d<f32>;
@group(1) @binding(11) var cloud_air_image: texture_2d<f32>;
#endif

// What clouds do to a pixel: their own light, what they let through, and what they leave of the air's light.
struct Overlay {
    radiance: vec3<f32>,
    transmittance: f32,
    air: vec3<f32>,
}

// `behind` is the transmittance of all of the air.
fn overlay(pixel: vec2<u32>, behind: vec3<f32>) -> Overlay {
#ifdef CLOUDS
    let clouds = textureLoad(cloud_radiance_image, pixel, 0);
    let air = textureLoad(cloud_air_image, pixel, 0).rgb;
    let left = (air - clouds.a * behind) / max(1.0 - behind, vec3<f32>(1e-6));
    return Overlay(clouds.rgb, clouds.a, clamp(left, vec3<f32>(0.0), vec3<f32>(1.0)));
#else
    return Overlay(vec3<f32>(0.0), 1.0, vec3<f32>(1.0));
#endif
}

// The direction as the tables of one light know it.
fn relative_to_light(view: vec3<f32>, light: u32) -> SkyDirection {
    var direction: SkyDirection;
    direction.zenith_rad = atan2(length(view.xy), view.z);
    let turn_rad = abs(atan2(view.x, view.y) - observer.lights[light].azimuth_rad);
    direction.azimuth_rad = min(turn_rad, 2.0 * PI - turn_rad);
    direction.nu = clamp(dot(view, observer.lights[light].direction), -1.0, 1.0);
    direction.below_horizon = direction.zenith_rad > observer.view.horizon_rad;
    return direction;
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

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(radiance_image)) {
        return;
    }
    let view = view_direction(pixel.xy);
    let air_transmittance = view_transmittance(relative_to_light(view, 0u));
    let clouds = overlay(pixel.xy, air_transmittance);
    let transmittance = clouds.transmittance * air_transmittance;
    // What glows lies above all clouds.
    var radiance = clouds.radiance + clouds.transmittance * emission_radiance(relative_to_light(view, 0u));
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let direction = relative_to_light(view, light);
        var behind = vec3<f32>(0.0);
        if direction.below_horizon {
            behind = ground_radiance(light, direction);
        } else {
            behind = disc_radiance(view, light);
        }
        radiance += observer.lights[light].irradiance * (clouds.air * air_radiance(light, direction) + transmittance * behind);
    }
    if !relative_to_light(view, 0u).below_horizon {
        for (var light = LIGHT_COUNT; light < DISC_COUNT; light++) {
            radiance += observer.lights[light].irradiance * transmittance * disc_radiance(view, light);
        }
    }
    textureStore(radiance_image, pixel.xy, vec4<f32>(radiance, 1.0));
#ifdef CAPTURE
    let direction = relative_to_light(view, 0u);
    var distance_m = bitcast<f32>(INFINITY_BITS);
    if direction.below_horizon {
        let ray = view_ray(observer.altitude_m, cos(direction.zenith_rad), light_mu_s(0u), direction.nu, true);
        distance_m = ray.start_m + ray.length_m;
    }
    textureStore(transmittance_image, pixel.xy, vec4<f32>(transmittance, 1.0));
    textureStore(distance_image, pixel.xy, vec4<f32>(distance_m, 0.0, 0.0, 0.0));
#endif
}
