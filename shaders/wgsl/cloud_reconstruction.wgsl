// Pass: clouds of every pixel, from those that this frame has marched and from the frame before.
//
// A pixel that was not marched takes what the frame before shows of the same piece of cloud: the point at the clouds'
// mean distance, carried back by the wind, as the camera saw it then. Unless nothing has moved, what it takes is held
// between the least and the most of the nine samples around (Karis 2014), so that nothing stays that is no longer there.
// Where the frame before did not look, samples are interpolated.
//
// Legend
//   sample    a pixel that was marched: one of each block of CLOUD_BLOCK x CLOUD_BLOCK
//   place     of a pixel or between pixels, from the picture's top left corner
//
// Definitions: CLOUD_BLOCK; CAPTURE (distances are asked for); WHOLE_BLOCKS (an invocation follows all pixels around a sample and not
// one of their columns: what the samples around have in common is read once, for devices of few invocations); FILTERED (the device
// interpolates 32-bit floats).

#import welkin::camera::{camera, view_through}
#import welkin::cloud_field::{cloud_layers, CLOUD_LAYER_COUNT}
#import welkin::cloud_frame::cloud_frame
#import welkin::observer::observer

@group(0) @binding(0) var cloud_radiance_samples: texture_2d<f32>;
@group(0) @binding(1) var cloud_air_samples: texture_2d<f32>;
@group(0) @binding(2) var cloud_diffuse_samples: texture_2d<f32>;
@group(0) @binding(3) var cloud_distance_samples: texture_2d<f32>;
@group(0) @binding(4) var cloud_radiance_history: texture_2d<f32>;
@group(0) @binding(5) var cloud_air_history: texture_2d<f32>;
@group(0) @binding(6) var cloud_diffuse_history: texture_2d<f32>;
@group(0) @binding(7) var table_sampler: sampler;
@group(0) @binding(8) var cloud_radiance_image: texture_storage_2d<rgba32float, write>;
// What clouds leave of other light, near 1 at most: to half floats' 11 digits.
@group(0) @binding(9) var cloud_air_image: texture_storage_2d<rgba16float, write>;
@group(0) @binding(12) var cloud_diffuse_image: texture_storage_2d<rgba16float, write>;
#ifdef CAPTURE
@group(0) @binding(11) var cloud_distance_image: texture_storage_2d<r32float, write>;
#endif

const BLOCK: i32 = #{CLOUD_BLOCK};
#ifdef WHOLE_BLOCKS
const COLUMNS: i32 = BLOCK;
// Blocks side by side, as in interpolate.wgsl.
const GROUP_SIZE = vec2<u32>(32u, 1u);
#else
const COLUMNS: i32 = 1;
const GROUP_SIZE = vec2<u32>(32u, 2u);
#endif
// Share of a new sample in a pixel that was marched; the rest is what was there, which evens out the samples' noise.
const NEW_SHARE: f32 = 0.7;
// Where there is no cloud, the point that is followed is as good as infinitely far, m.
const FAR_M: f32 = 1e7;
// Beside every picture, and so far that no pixel between it and a place in one is in that either.
const UNSEEN = vec2<f32>(-1e9);

// The three images of the clouds at a pixel.
struct Texels {
    radiance: vec4<f32>,
    air: vec4<f32>,
    diffuse: vec4<f32>,
}

fn mixed(a: Texels, b: Texels, share: f32) -> Texels {
    return Texels(mix(a.radiance, b.radiance, share), mix(a.air, b.air, share), mix(a.diffuse, b.diffuse, share));
}

fn sample_at(index: vec2<i32>) -> Texels {
    let i = clamp(index, vec2<i32>(0), vec2<i32>(textureDimensions(cloud_radiance_samples)) - 1);
    return Texels(
        textureLoad(cloud_radiance_samples, i, 0), textureLoad(cloud_air_samples, i, 0),
        textureLoad(cloud_diffuse_samples, i, 0),
    );
}

#ifndef FILTERED
fn radiance_before(index: vec2<i32>) -> vec4<f32> {
    let i = clamp(index, vec2<i32>(0), vec2<i32>(textureDimensions(cloud_radiance_history)) - 1);
    return textureLoad(cloud_radiance_history, i, 0);
}
#endif

// Between four pixels.
fn interpolated_history(place: vec2<f32>) -> Texels {
    let uv = place / camera.size;
#ifdef FILTERED
    let radiance = textureSampleLevel(cloud_radiance_history, table_sampler, uv, 0.0);
#else
    let low = floor(place - 0.5);
    let share = place - 0.5 - low;
    let i = vec2<i32>(low);
    let upper = mix(radiance_before(i), radiance_before(i + vec2<i32>(1, 0)), share.x);
    let lower = mix(radiance_before(i + vec2<i32>(0, 1)), radiance_before(i + vec2<i32>(1, 1)), share.x);
    let radiance = mix(upper, lower, share.y);
#endif
    let air = textureSampleLevel(cloud_air_history, table_sampler, uv, 0.0);
    return Texels(radiance, air, textureSampleLevel(cloud_diffuse_history, table_sampler, uv, 0.0));
}

fn interpolated_samples(pixel: vec2<i32>) -> Texels {
    let at = vec2<f32>(pixel - vec2<i32>(cloud_frame.first_pixel)) / f32(BLOCK);
    let low = floor(at);
    let share = at - low;
    let i = vec2<i32>(low);
    let upper = mixed(sample_at(i), sample_at(i + vec2<i32>(1, 0)), share.x);
    let lower = mixed(sample_at(i + vec2<i32>(0, 1)), sample_at(i + vec2<i32>(1, 1)), share.x);
    return mixed(upper, lower, share.y);
}

// What the samples around a pixel have in common.
struct Around {
    least: Texels,
    most: Texels,
    // Of the nearest clouds: their edge moves with what is in front.
    distance_m: f32,
}

fn around(nearest: vec2<i32>) -> Around {
    let first = sample_at(nearest);
    var bounds = Around(first, first, FAR_M);
    let last = vec2<i32>(textureDimensions(cloud_distance_samples)) - 1;
    for (var k = 0; k < 9; k++) {
        let index = nearest + vec2<i32>(k % 3 - 1, k / 3 - 1);
        let sample = sample_at(index);
        bounds.least.radiance = min(bounds.least.radiance, sample.radiance);
        bounds.least.air = min(bounds.least.air, sample.air);
        bounds.least.diffuse = min(bounds.least.diffuse, sample.diffuse);
        bounds.most.radiance = max(bounds.most.radiance, sample.radiance);
        bounds.most.air = max(bounds.most.air, sample.air);
        bounds.most.diffuse = max(bounds.most.diffuse, sample.diffuse);
        let distance_m = textureLoad(cloud_distance_samples, clamp(index, vec2<i32>(0), last), 0).x;
        bounds.distance_m = min(bounds.distance_m, distance_m);
    }
    return bounds;
}

// How far wind has carried the clouds at an altitude since the frame before, m.
fn drift_m(altitude_m: f32) -> vec2<f32> {
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let up_m = altitude_m - cloud_layers[layer].base_m;
        if up_m >= 0.0 && up_m <= cloud_layers[layer].thickness_m {
            return cloud_frame.drift_m[layer];
        }
    }
    return vec2<f32>(0.0);
}

// Where the frame before saw the clouds at a distance behind a place of this one.
fn place_before(place: vec2<f32>, distance_m: f32) -> vec2<f32> {
    let point = vec3<f32>(0.0, 0.0, observer.altitude_m) + view_through(place) * distance_m;
    let then = point - vec3<f32>(drift_m(point.z), cloud_frame.altitude_m);
    let ahead = dot(then, cloud_frame.forward);
    if ahead <= 0.0 {
        return UNSEEN;
    }
    let x = dot(then, cloud_frame.right) / (ahead * cloud_frame.half_width);
    let y = dot(then, cloud_frame.up) / (ahead * cloud_frame.half_height);
    return 0.5 * (vec2<f32>(x, -y) + 1.0) * camera.size;
}

// The same within a block, in which it is as good as linear: of the centre of its first pixel, and what a pixel to the right and one
// down add to it.
struct Flow {
    first: vec2<f32>,
    right: vec2<f32>,
    down: vec2<f32>,
}

fn flow(first: vec2<i32>, distance_m: f32) -> Flow {
    let centre = vec2<f32>(first) + 0.5;
    let before = place_before(centre, distance_m);
    let down = (place_before(centre + vec2<f32>(0.0, f32(BLOCK)), distance_m) - before) / f32(BLOCK);
#ifdef WHOLE_BLOCKS
    let right = (place_before(centre + vec2<f32>(f32(COLUMNS), 0.0), distance_m) - before) / f32(COLUMNS);
#else
    let right = vec2<f32>(0.0);
#endif
    return Flow(before, right, down);
}

// A pixel that was seen at a place before, with the sample nearest to it, and what the samples around that one have in common.
fn follow(pixel: vec2<i32>, place: vec2<f32>, nearest: vec2<i32>, bounds: ptr<function, Around>) {
    let was_seen = all(place >= vec2<f32>(0.0)) && all(place <= camera.size);
    var texels: Texels;
    if was_seen {
        texels = interpolated_history(place);
        if cloud_frame.still == 0.0 {
            texels.radiance = clamp(texels.radiance, (*bounds).least.radiance, (*bounds).most.radiance);
            texels.air = clamp(texels.air, (*bounds).least.air, (*bounds).most.air);
            texels.diffuse = clamp(texels.diffuse, (*bounds).least.diffuse, (*bounds).most.diffuse);
        }
        if all(pixel == nearest * BLOCK + vec2<i32>(cloud_frame.first_pixel)) {
            texels = mixed(texels, sample_at(nearest), NEW_SHARE);
        }
    } else {
        texels = interpolated_samples(pixel);
    }
    textureStore(cloud_radiance_image, pixel, texels.radiance);
    textureStore(cloud_air_image, pixel, texels.air);
    textureStore(cloud_diffuse_image, pixel, texels.diffuse);
#ifdef CAPTURE
    let last = vec2<i32>(textureDimensions(cloud_distance_samples)) - 1;
    textureStore(cloud_distance_image, pixel, textureLoad(cloud_distance_samples, clamp(nearest, vec2<i32>(0), last), 0));
#endif
}

@compute @workgroup_size(GROUP_SIZE.x, GROUP_SIZE.y)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    // Half a block to every side of a sample; the first of them may lie beside the picture.
    let size = vec2<i32>(textureDimensions(cloud_radiance_image));
    let first = vec2<i32>(id.xy) * vec2<i32>(COLUMNS, BLOCK) + vec2<i32>(cloud_frame.first_pixel) - BLOCK - BLOCK / 2;
    if any(first >= size) {
        return;
    }
    let middle = first + vec2<i32>(COLUMNS, BLOCK) / 2 - vec2<i32>(cloud_frame.first_pixel);
    let nearest = vec2<i32>(floor(vec2<f32>(middle) / f32(BLOCK) + 0.5));
    var bounds = around(nearest);
    let before = flow(first, bounds.distance_m);
    let end = min(first + vec2<i32>(COLUMNS, BLOCK), size);
    for (var y = max(first.y, 0); y < end.y; y++) {
        for (var x = max(first.x, 0); x < end.x; x++) {
            let within = vec2<f32>(vec2<i32>(x, y) - first);
            let place = before.first + within.x * before.right + within.y * before.down;
            follow(vec2<i32>(x, y), place, nearest, &bounds);
        }
    }
}
