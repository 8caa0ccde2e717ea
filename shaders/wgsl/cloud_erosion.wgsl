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
    let quad = vec4<f32>(
        erosion(at), erosion(at + vec3<i32>(1, 0, 0)), erosion(at + vec3<i32>(0, 1, 0)), erosion(at + vec3<i32>(1, 1, 0))
    );
    textureStore(cloud_erosion_volume, texel, quad);
}
