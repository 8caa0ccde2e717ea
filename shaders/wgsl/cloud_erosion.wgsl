// Pass: the tile of fine Worley noise that eats into clouds' edges. Texels hold four neighbours, as in cloud_shape.

#import welkin::cloud_noise::{joined, position_of, unit_byte, worley}

@group(0) @binding(0) var cloud_erosion_volume: texture_storage_3d<rgba8unorm, write>;

const TEXELS: i32 = 32;

fn erosion(texel: vec3<i32>) -> f32 {
    var octaves: array<i32, 3>;
    for (var o = 0u; o < 3u; o++) {
        octaves[o] = worley(position_of(texel & vec3<i32>(TEXELS - 1), 4 << o, TEXELS), 4 << o, 41u + o);
    }
    return unit_byte(joined(octaves[0], octaves[1], octaves[2]), 900, 3500);
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let at = vec3<i32>(texel);
    // One after the other, of a number that no compiler foresees, which would write the noise out four times: welkin::loops.
    let neighbour_count = min(4u, textureDimensions(cloud_erosion_volume).x);
    var quad: vec4<f32>;
    for (var i = 0u; i < neighbour_count; i++) {
        let value = erosion(at + vec3<i32>(vec3<u32>(i & 1u, i >> 1u, 0u)));
        quad = select(quad, vec4<f32>(value), vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(i));
    }
    textureStore(cloud_erosion_volume, texel, quad);
}
