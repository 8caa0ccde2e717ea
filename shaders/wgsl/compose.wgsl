// Pass: linear radiance of every pixel: the air, the ground behind it, and the discs of the lights.
//
// Definitions: CAPTURE (also write transmittance and distance, for files and engines), CLOUDS, LOCAL_MEDIA (clouds are
// marched together with fog, volumes and local lights), SURFACE (something stands before the camera).

#import welkin::aerial::{air_radiance_before_of, reach_of}
#import welkin::atmosphere::{atmosphere, PI}
#import welkin::camera::{camera, view_direction, pixel_angle_rad}
#import welkin::march::view_ray
#ifdef SPHERE
#import welkin::lit_sphere::{is_sphere, sphere_radiance}
#endif
#import welkin::observer::{observer, DISC_COUNT, LIGHT_COUNT}
#import welkin::sky::{
    air_radiance_of, emission_radiance, ground_radiance_of, view_transmittance, Shares, SkyDirection,
}

@group(0) @binding(8) var radiance_image: texture_storage_2d<rgba32float, write>;
#ifdef CAPTURE
@group(0) @binding(9) var transmittance_image: texture_storage_2d<rgba32float, write>;
@group(0) @binding(11) var distance_image: texture_storage_2d<r32float, write>;
// What a file means by "the ray ends in space".
const INFINITY_BITS: u32 = 0x7f800000u;
#endif

#ifdef SURFACE
// What stands before the camera: radiance that it sends, W/m2/sr/nm, and its distance, m.
@group(0) @binding(19) var surface_image: texture_2d<f32>;
// At this distance and beyond there is no surface, m.
const NO_SURFACE_M: f32 = 1e30;
#endif

#ifdef LOCAL_MEDIA
@group(1) @binding(50) var media_radiance_image: texture_2d<f32>;
@group(1) @binding(51) var media_transmittance_image: texture_2d<f32>;
@group(1) @binding(52) var media_beam_image: texture_2d<f32>;
@group(1) @binding(53) var media_diffuse_image: texture_2d<f32>;
#else ifdef CLOUDS
@group(1) @binding(10) var cloud_radiance_image: texture_2d<f32>;
@group(1) @binding(11) var cloud_air_image: texture_2d<f32>;
@group(1) @binding(12) var cloud_diffuse_image: texture_2d<f32>;
#endif

// What clouds and local media do to a pixel: their own light, what they let through, and what they leave of the light of air and ground,
// of what comes straight from the lights and of the rest.
struct Overlay {
    radiance: vec3<f32>,
    transmittance: vec3<f32>,
    air: Shares,
    ground: Shares,
}

// `behind` is the transmittance of all of the air.
fn overlay(pixel: vec2<u32>, behind: vec3<f32>) -> Overlay {
#ifdef LOCAL_MEDIA
    let media = textureLoad(media_radiance_image, pixel, 0);
    let through = textureLoad(media_transmittance_image, pixel, 0);
    let left = through.rgb * behind;
    let opacity = max(1.0 - behind, vec3<f32>(1e-6));
    let shares = Shares(
        max((textureLoad(media_beam_image, pixel, 0).rgb - left) / opacity, vec3<f32>(0.0)),
        max((textureLoad(media_diffuse_image, pixel, 0).rgb - left) / opacity, vec3<f32>(0.0))
    );
    return Overlay(media.rgb, through.rgb, shares, Shares(vec3<f32>(media.a), vec3<f32>(through.a)));
#else ifdef CLOUDS
    let clouds = textureLoad(cloud_radiance_image, pixel, 0);
    let beam = textureLoad(cloud_air_image, pixel, 0);
    let diffuse = textureLoad(cloud_diffuse_image, pixel, 0);
    let whole = max(1.0 - behind, vec3<f32>(1e-6));
    let air = Shares(
        max((beam.rgb - clouds.a * behind) / whole, vec3<f32>(0.0)), max((diffuse.rgb - clouds.a * behind) / whole, vec3<f32>(0.0))
    );
    return Overlay(clouds.rgb, vec3<f32>(clouds.a), air, Shares(vec3<f32>(beam.a), vec3<f32>(diffuse.a)));
#else
    let whole = Shares(vec3<f32>(1.0), vec3<f32>(1.0));
    return Overlay(vec3<f32>(0.0), vec3<f32>(1.0), whole, whole);
#endif
}

// The part of a pixel that lies on one side of the horizon.
struct HalfPixel {
    below_horizon: bool,
    // Of the whole pixel: between 0 and 1 where the horizon runs through it, so that the horizon is no stair.
    share: f32,
    // Of the middle of the part.
    zenith_rad: f32,
}

fn half_pixel(view: vec3<f32>, below_horizon: bool) -> HalfPixel {
    let zenith_rad = atan2(length(view.xy), view.z);
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

// The direction in one half of the view sphere as the tables of one light know it.
fn relative_to_light(view: vec3<f32>, half: HalfPixel, light: u32) -> SkyDirection {
    var direction: SkyDirection;
    direction.zenith_rad = half.zenith_rad;
    let turn_rad = abs(atan2(view.x, view.y) - observer.lights[light].azimuth_rad);
    direction.azimuth_rad = min(turn_rad, 2.0 * PI - turn_rad);
    direction.nu = clamp(dot(view, observer.lights[light].direction), -1.0, 1.0);
    direction.below_horizon = half.below_horizon;
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

struct Seen {
    radiance: vec3<f32>,
    transmittance: vec3<f32>,
}

// What a pixel sees in one half of the view sphere.
fn seen(pixel: vec2<u32>, view: vec3<f32>, half: HalfPixel) -> Seen {
    let air_transmittance = view_transmittance(relative_to_light(view, half, 0u));
    let clouds = overlay(pixel, air_transmittance);
    var seen: Seen;
    seen.transmittance = clouds.transmittance * air_transmittance;
    // What glows lies above all clouds.
    seen.radiance = clouds.radiance + clouds.transmittance * emission_radiance(relative_to_light(view, half, 0u));
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let direction = relative_to_light(view, half, light);
        var behind = vec3<f32>(0.0);
        if half.below_horizon {
            behind = ground_radiance_of(light, direction, clouds.ground);
        } else {
            behind = disc_radiance(view, light);
        }
        let radiance = air_radiance_of(light, direction, clouds.air) + seen.transmittance * behind;
        seen.radiance += observer.lights[light].irradiance * radiance;
    }
    // Lights that are only seen, and light nothing.
    for (var light = LIGHT_COUNT; light < DISC_COUNT && !half.below_horizon; light++) {
        seen.radiance += observer.lights[light].irradiance * seen.transmittance * disc_radiance(view, light);
    }
    return seen;
}

#ifdef SURFACE
// A surface through the air and the clouds before it.
fn seen_before(pixel: vec2<u32>, view: vec3<f32>, direction: HalfPixel, surface: vec4<f32>) -> Seen {
    let reach = reach_of(relative_to_light(view, direction, 0u), surface.a);
    let clouds = overlay(pixel, reach.transmittance);
    let transmittance = clouds.transmittance * reach.transmittance;
    var seen = Seen(clouds.radiance + clouds.transmittance * reach.emission + transmittance * surface.rgb, transmittance);
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let radiance = air_radiance_before_of(light, relative_to_light(view, direction, light), reach, clouds.air);
        seen.radiance += observer.lights[light].irradiance * radiance;
    }
    return seen;
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(radiance_image)) {
        return;
    }
    let view = view_direction(pixel.xy);
    let zenith_rad = atan2(length(view.xy), view.z);
    let below_horizon = zenith_rad > observer.view.horizon_rad;
    var half = half_pixel(view, below_horizon);
    var pixel_sees: Seen;
#ifdef SURFACE
    let surface = textureLoad(surface_image, pixel.xy, 0);
    if surface.a < NO_SURFACE_M {
        half = HalfPixel(below_horizon, 1.0, zenith_rad);
        pixel_sees = seen_before(pixel.xy, view, half, surface);
    } else {
        pixel_sees = seen(pixel.xy, view, half);
    }
#else
    pixel_sees = seen(pixel.xy, view, half);
#endif
    // Only the pixels on the horizon look both ways. A loop and not a branch: devices that compute several pixels in
    // lockstep leave it at once where no pixel needs it.
    for (var i = 0u; i < 1u && half.share < 1.0; i++) {
        let other = seen(pixel.xy, view, half_pixel(view, !below_horizon));
        pixel_sees.radiance = mix(other.radiance, pixel_sees.radiance, half.share);
        pixel_sees.transmittance = mix(other.transmittance, pixel_sees.transmittance, half.share);
    }
    textureStore(radiance_image, pixel.xy, vec4<f32>(pixel_sees.radiance, 1.0));
#ifdef CAPTURE
    var distance_m = bitcast<f32>(INFINITY_BITS);
    if below_horizon {
        let ray = view_ray(observer.altitude_m, cos(zenith_rad), 0.0, 0.0, true);
        distance_m = ray.start_m + ray.length_m;
    }
#ifdef SURFACE
    distance_m = select(distance_m, surface.a, surface.a < NO_SURFACE_M);
#endif
    textureStore(transmittance_image, pixel.xy, vec4<f32>(pixel_sees.transmittance, 1.0));
    textureStore(distance_image, pixel.xy, vec4<f32>(distance_m, 0.0, 0.0, 0.0));
#endif
}
