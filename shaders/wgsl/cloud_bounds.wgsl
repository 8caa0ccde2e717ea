// Pass: the largest bytes of the clouds' noise around each block of texels, for skipping empty space.
//
// The density grows with shape and weather, and wind only moves the tiles: so the maxima bound it for every layer and
// time. Each holds for its block of 8 texels and a block's length to every side (welkin_lut::cloud::CloudBounds).

@group(0) @binding(0) var cloud_shape_volume: texture_3d<f32>;
@group(0) @binding(1) var cloud_weather_map: texture_2d<f32>;
@group(0) @binding(2) var cloud_shape_bounds: texture_storage_3d<rgba8unorm, write>;
@group(0) @binding(3) var cloud_weather_bounds: texture_storage_2d<rgba8unorm, write>;

const BLOCK: i32 = 8;
const SHAPE_TEXELS: i32 = 128;
const SHAPE_BLOCKS: i32 = 16;
const WEATHER_TEXELS: i32 = 512;
const WEATHER_BLOCKS: i32 = 64;

fn shape_bound(block: vec3<i32>) -> f32 {
    let first = block * BLOCK - BLOCK - 1;
    var most = vec4<f32>(0.0);
    for (var z = 0; z < 3 * BLOCK + 2; z++) {
        // Texels hold their next neighbours along x and y.
        for (var y = 0; y < 3 * BLOCK + 2; y += 2) {
            for (var x = 0; x < 3 * BLOCK + 2; x += 2) {
                let texel = (first + vec3<i32>(x, y, z)) & vec3<i32>(SHAPE_TEXELS - 1);
                most = max(most, textureLoad(cloud_shape_volume, texel, 0));
            }
        }
    }
    return max(max(most.x, most.y), max(most.z, most.w));
}

fn weather_bound(block: vec2<i32>) -> vec4<f32> {
    let first = block * BLOCK - BLOCK - 1;
    var most = vec4<f32>(0.0);
    for (var y = 0; y < 3 * BLOCK + 2; y++) {
        for (var x = 0; x < 3 * BLOCK + 2; x++) {
            let texel = (first + vec2<i32>(x, y)) & vec2<i32>(WEATHER_TEXELS - 1);
            most = max(most, textureLoad(cloud_weather_map, texel, 0));
        }
    }
    return most;
}

// One invocation a block of either tile: both have as many.
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = i32(id.x);
    let shape_block = vec3<i32>(i, i / SHAPE_BLOCKS, i / (SHAPE_BLOCKS * SHAPE_BLOCKS)) & vec3<i32>(SHAPE_BLOCKS - 1);
    textureStore(cloud_shape_bounds, shape_block, vec4<f32>(shape_bound(shape_block), 0.0, 0.0, 0.0));
    let weather_block = vec2<i32>(i, i / WEATHER_BLOCKS) & vec2<i32>(WEATHER_BLOCKS - 1);
    textureStore(cloud_weather_bounds, weather_block, weather_bound(weather_block));
}
