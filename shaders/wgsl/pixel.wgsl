#define_import_path welkin::pixel
// What becomes of the light along a ray in a pixel: clouds before it, and the images that it is written to.
//
// Definitions: CAPTURE (also write transmittance and distance, for files and engines), CLOUDS,
// LOCAL_MEDIA (clouds are marched together with fog, volumes and local lights), SURFACE (something stands before the camera),
// OVERLAY (clouds or local media), FOR_SCREEN (radiance is kept in half floats, times `camera.pre_exposure`).

#import welkin::atmosphere::{phase_per_sr, SCATTERER_SLOTS}
#import welkin::camera::{camera, view_direction}
#import welkin::march::view_ray
#import welkin::observer::observer
#import welkin::sky::{shares_before, Shares, ALL}
#import welkin::smooth_sky::{SmoothSky, SINGLE_COUNT}

#ifdef FOR_SCREEN
@group(0) @binding(8) var radiance_image: texture_storage_2d<rgba16float, write>;
const LARGEST_HALF: f32 = 65504.0;
#else
@group(0) @binding(8) var radiance_image: texture_storage_2d<rgba32float, write>;
#endif
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
#else
#ifdef CLOUDS
@group(1) @binding(10) var cloud_radiance_image: texture_2d<f32>;
@group(1) @binding(11) var cloud_air_image: texture_2d<f32>;
@group(1) @binding(12) var cloud_diffuse_image: texture_2d<f32>;
#endif
#endif

// What clouds and local media do to a pixel: their own light, what they let through, and what they leave of the light of
// air and ground.
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
    let beam = textureLoad(media_beam_image, pixel, 0).rgb;
    let diffuse = textureLoad(media_diffuse_image, pixel, 0).rgb;
    let shares = shares_before(beam, diffuse, through.rgb, behind);
    return Overlay(media.rgb, through.rgb, shares, Shares(vec3<f32>(media.a), vec3<f32>(through.a)));
#else
#ifdef CLOUDS
    let clouds = textureLoad(cloud_radiance_image, pixel, 0);
    let beam = textureLoad(cloud_air_image, pixel, 0);
    let diffuse = textureLoad(cloud_diffuse_image, pixel, 0);
    return Overlay(clouds.rgb, vec3<f32>(clouds.a), Shares(beam.rgb, diffuse.rgb), Shares(vec3<f32>(beam.a), vec3<f32>(diffuse.a)));
#else
    return Overlay(vec3<f32>(0.0), vec3<f32>(1.0), ALL, ALL);
#endif
#endif
}

// Whose march tells what stands before the other side of the horizon, in a pixel that it runs through: the neighbour that
// looks farthest to that side. The pixel's own march is that of its middle.
fn media_across(pixel: vec2<u32>, below_horizon: bool) -> vec2<u32> {
    var across = pixel;
#ifdef OVERLAY
    let last = vec2<i32>(textureDimensions(radiance_image)) - 1;
    let side = select(1.0, -1.0, below_horizon);
    var farthest = side * view_direction(pixel).z;
    for (var i = 0; i < 4; i++) {
        let step = select(vec2<i32>(0, 2 * (i / 2) - 1), vec2<i32>(2 * (i / 2) - 1, 0), i % 2 == 0);
        let neighbour = vec2<u32>(clamp(vec2<i32>(pixel) + step, vec2<i32>(0), last));
        let height = side * view_direction(neighbour).z;
        if height > farthest {
            farthest = height;
            across = neighbour;
        }
    }
#endif
    return across;
}

struct Seen {
    radiance: vec3<f32>,
    transmittance: vec3<f32>,
}

// Light that the air has scattered once, with its phase functions.
fn singly_scattered(view: vec3<f32>, sky: SmoothSky) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
    for (var i = 0u; i < SINGLE_COUNT; i++) {
        let nu = clamp(dot(view, observer.lights[i / SCATTERER_SLOTS].direction), -1.0, 1.0);
        radiance += phase_per_sr(i % SCATTERER_SLOTS, nu) * sky.single[i];
    }
    return radiance;
}

// Sky or ground behind a pixel's clouds.
fn seen_through_clouds(pixel: vec2<u32>, view: vec3<f32>, sky: SmoothSky) -> Seen {
    let clouds = overlay(pixel, sky.transmittance);
    let air = clouds.air.straight * singly_scattered(view, sky) + clouds.air.diffuse * sky.diffuse;
    // What glows lies above all clouds.
    let ground = clouds.ground.straight * sky.ground_straight + clouds.ground.diffuse * sky.ground_diffuse;
    let radiance = clouds.radiance + air + clouds.transmittance * (ground + sky.glow);
    return Seen(radiance, clouds.transmittance * sky.transmittance);
}

fn put(pixel: vec2<u32>, view: vec3<f32>, seen: Seen) {
#ifdef FOR_SCREEN
    let exposed = min(camera.pre_exposure * seen.radiance, vec3<f32>(LARGEST_HALF));
    textureStore(radiance_image, pixel, vec4<f32>(exposed, 1.0));
#else
    textureStore(radiance_image, pixel, vec4<f32>(seen.radiance, 1.0));
#endif
#ifdef CAPTURE
    var distance_m = bitcast<f32>(INFINITY_BITS);
    let zenith_rad = atan2(length(view.xy), view.z);
    if zenith_rad > observer.view.horizon_rad {
        let ray = view_ray(observer.altitude_m, cos(zenith_rad), 0.0, 0.0, true);
        distance_m = ray.start_m + ray.length_m;
    }
#ifdef SURFACE
    let surface_m = textureLoad(surface_image, pixel, 0).a;
    distance_m = select(distance_m, surface_m, surface_m < NO_SURFACE_M);
#endif
    textureStore(transmittance_image, pixel, vec4<f32>(seen.transmittance, 1.0));
    textureStore(distance_image, pixel, vec4<f32>(distance_m, 0.0, 0.0, 0.0));
#endif
}
