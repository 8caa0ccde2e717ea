// Pass: the map of where clouds are and how high they reach, and the map of the flow that twists their edges.

#import welkin::cloud_noise::{joined, perlin_octaves, position_of, smooth_octaves, unit_byte, worley, ONE}

// Convective cells, sheets, thickness, development.
@group(0) @binding(0) var cloud_weather_map: texture_storage_2d<rgba8unorm, write>;
// Flow to the east and north at a texel and at the next to the east.
@group(0) @binding(1) var cloud_curl_map: texture_storage_2d<rgba8unorm, write>;

const WEATHER_TEXELS: i32 = 512;
const CURL_TEXELS: i32 = 128;

// A number of octaves that no compiler foresees, which would write all of them out: see welkin::loops.
fn counted(octaves: u32) -> u32 {
    return min(octaves, textureDimensions(cloud_weather_map).x);
}

fn smooth_noise(texel: vec3<i32>, cells: i32, octaves: u32, seed: u32) -> i32 {
    return smooth_octaves(position_of(texel, cells, WEATHER_TEXELS), cells, counted(octaves), seed);
}

fn weather(texel: vec3<i32>) -> vec4<f32> {
    var octaves: array<i32, 3>;
    for (var o = 0u; o < 3u; o++) {
        octaves[o] = worley(position_of(texel, 32 << o, WEATHER_TEXELS), 32 << o, 61u + o);
    }
    let cellular = (smooth_noise(texel, 4, 4u, 71u) + 2 * joined(octaves[0], octaves[1], octaves[2])) / 3;
    return vec4<f32>(
        unit_byte(cellular, 0, ONE), unit_byte(smooth_noise(texel, 8, 6u, 81u), 0, ONE),
        unit_byte(smooth_noise(texel, 32, 3u, 91u), 0, ONE), unit_byte(smooth_noise(texel, 8, 3u, 101u), 0, ONE)
    );
}

fn potential(x: i32, y: i32) -> i32 {
    let texel = vec3<i32>(vec2<i32>(x, y) & vec2<i32>(CURL_TEXELS - 1), 0);
    return perlin_octaves(position_of(texel, 8, CURL_TEXELS), 8, counted(3u), 51u);
}

fn flow(x: i32, y: i32) -> vec2<f32> {
    let east = potential(x, y + 1) - potential(x, y - 1);
    let north = potential(x - 1, y) - potential(x + 1, y);
    return vec2<f32>(unit_byte(east, -1024, 1024), unit_byte(north, -1024, 1024));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let at = vec3<i32>(vec2<i32>(texel.xy), 0);
    textureStore(cloud_weather_map, texel.xy, weather(at));
    if all(at.xy < vec2<i32>(CURL_TEXELS)) {
        textureStore(cloud_curl_map, texel.xy, vec4<f32>(flow(at.x, at.y), flow(at.x + 1, at.y)));
    }
}
