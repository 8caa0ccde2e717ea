// Pass: what clouds, fog and volumes send and leave up to each slice of a host's froxels, whatever the host has drawn there.
// A column's ray is marched once, and stops at each slice.
//
// Definitions: CLOUDS.

#ifdef CLOUDS
#import welkin::cloud_source::phases
#endif
#import welkin::froxel_grid::{column_direction, column_place, slice_distance_m}
#import welkin::media_advance::{advance, March, MAX_STEPS, PHASE_SLOTS}
#import welkin::media_march::{clear_air, clear_way_along, follow_air, pass_air, place_in_step}
#import welkin::media_sum::{depth_of, found, Sum}

// As the images of all media, for each slice of each column.
@group(1) @binding(50) var froxel_media_radiance: texture_storage_3d<rgba32float, write>;
@group(1) @binding(51) var froxel_media_transmittance: texture_storage_3d<rgba32float, write>;
@group(1) @binding(52) var froxel_media_beam: texture_storage_3d<rgba32float, write>;
@group(1) @binding(53) var froxel_media_diffuse: texture_storage_3d<rgba32float, write>;

// A march that has come so near to where it must stop has come there, as a share of the distance.
const ARRIVED: f32 = 0.999999;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let column = id.xy;
    let size = textureDimensions(froxel_media_radiance);
    if any(column >= size.xy) {
        return;
    }
    let pixel = vec2<u32>(column_place(column, size.xy));
    var ray = clear_way_along(column_direction(column, size.xy), pixel);
    let offset = place_in_step(column, 0.0);
    var phase: array<f32, PHASE_SLOTS>;
#ifdef CLOUDS
    phase = phases(ray.direction);
#endif
    var sum: Sum;
    var air = clear_air();
    var march: March;
    for (var slice = 0u; slice < size.z; slice++) {
        march.cut_m = min(slice_distance_m(slice), ray.end_m);
        while march.steps < MAX_STEPS && march.t_m < ARRIVED * march.cut_m && !march.is_over {
            advance(&march, &sum, &air, &ray, offset, &phase);
            march.steps += 1u;
        }
        // Where no more is seen, the air goes on.
        pass_air(&air, &ray, exp(-depth_of(sum)), max(march.cut_m, air.passed_m));
        var air_here = air;
        follow_air(&air_here, &ray);
        let all = found(sum, &air_here);
        let froxel = vec3<u32>(column, slice);
        textureStore(froxel_media_radiance, froxel, all.radiance);
        textureStore(froxel_media_transmittance, froxel, all.transmittance);
        textureStore(froxel_media_beam, froxel, all.beam);
        textureStore(froxel_media_diffuse, froxel, all.diffuse);
    }
}
