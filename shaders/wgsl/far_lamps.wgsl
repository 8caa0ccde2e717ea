#define_import_path welkin::far_lamps
// What local lights far from a place bring there, from the froxels of the pass lamp_froxels.

#import welkin::cluster::TILE
#import welkin::lamp_grid::{FIRST_M, PER_OCTAVE, SLICES}
#import welkin::tables::table_sampler

@group(1) @binding(49) var lamp_froxels: texture_3d<f32>;

// t_m before a pixel: per b to a bank of fog, in the direction of the camera; or as irradiance of the ground.
fn from_far_lamps(part: u32, pixel: vec2<u32>, t_m: f32) -> vec3<f32> {
    let size = vec3<f32>(textureDimensions(lamp_froxels));
    let node = (vec2<f32>(pixel) + 0.5) / f32(TILE);
    let slice = clamp(log2(max(t_m, FIRST_M) / FIRST_M) * PER_OCTAVE, 0.5, f32(SLICES) - 0.5);
    let texel = vec3<f32>(node + 0.5, f32(part * SLICES) + slice);
    return textureSampleLevel(lamp_froxels, table_sampler, texel / size, 0.0).rgb;
}
