// Pass: the tile of noise that clouds' shapes are cut from: Perlin noise in billows (Schneider 2015), carved by finer
// Worley noise.
//
// A texel holds the bytes of four neighbours, (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) of its slice: linear
// interpolation then takes two loads in place of eight.

#import welkin::cloud_noise::{joined, position_of, smooth_octaves, unit_byte, worley, ONE}

@group(0) @binding(0) var cloud_shape_volume: texture_storage_3d<rgba8unorm, write>;

const TEXELS: i32 = 128;
const WIDE: u32 = 9u;
const SLICES: u32 = 2u;

// The workgroup's bytes, and one more row and column.
var<workgroup> bytes: array<f32, 162>;

fn shape(texel: vec3<i32>) -> f32 {
    var octaves: array<i32, 4>;
    for (var o = 0u; o < 4u; o++) {
        octaves[o] = worley(position_of(texel, 4 << o, TEXELS), 4 << o, 11u + o);
    }
    let smooth_noise = smooth_octaves(position_of(texel, 4, TEXELS), 4, 4u, 31u);
    let billows = joined(octaves[0], octaves[1], octaves[2]);
    let carving = joined(octaves[1], octaves[2], octaves[3]);
    let whole = billows + ((smooth_noise * (ONE - billows)) >> 12u);
    return unit_byte((whole - carving + ONE) * ONE / (2 * ONE - carving), 2300, 3900);
}

@compute @workgroup_size(8, 8, 2)
fn main(
    @builtin(global_invocation_id) texel: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_id) place: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    for (var i = index; i < WIDE * WIDE * SLICES; i += 128u) {
        let offset = vec3<u32>(i % WIDE, i / WIDE % WIDE, i / (WIDE * WIDE));
        bytes[i] = shape(vec3<i32>(group * vec3<u32>(8u, 8u, 2u) + offset) & vec3<i32>(TEXELS - 1));
    }
    workgroupBarrier();
    let first = (place.z * WIDE + place.y) * WIDE + place.x;
    let quad = vec4<f32>(bytes[first], bytes[first + 1u], bytes[first + WIDE], bytes[first + WIDE + 1u]);
    textureStore(cloud_shape_volume, texel, quad);
}
