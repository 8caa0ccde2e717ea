// Pass: how far away what stands before the camera is in each cell that marched media are interpolated over. Froxels are kept for these
// distances alone.
//
// Definitions: MEDIA_CELL.

#import welkin::media_lattice::{corner_pixel, CELL}

// What stands before the camera: its distance, m, beside its light; none is at this distance or beyond.
@group(0) @binding(19) var surface_image: texture_2d<f32>;
const NO_SURFACE_M: f32 = 1e30;
// The nearest and the farthest surface, m: NO_SURFACE_M and 0 where there is none.
@group(1) @binding(56) var surface_cells: texture_storage_2d<rgba32float, write>;

// As bits of floats, whose order is that of numbers.
var<workgroup> nearest: atomic<u32>;
var<workgroup> farthest: atomic<u32>;

@compute @workgroup_size(#{MEDIA_CELL}, #{MEDIA_CELL})
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) first: u32,
) {
    if first == 0u {
        atomicStore(&nearest, bitcast<u32>(NO_SURFACE_M));
        atomicStore(&farthest, 0u);
    }
    workgroupBarrier();
    let pixel = min(corner_pixel(group.xy) + id.xy, textureDimensions(surface_image) - 1u);
    let distance_m = textureLoad(surface_image, pixel, 0).a;
    if distance_m < NO_SURFACE_M {
        atomicMin(&nearest, bitcast<u32>(distance_m));
        atomicMax(&farthest, bitcast<u32>(distance_m));
    }
    workgroupBarrier();
    if first == 0u {
        let reach = vec2<f32>(bitcast<f32>(atomicLoad(&nearest)), bitcast<f32>(atomicLoad(&farthest)));
        textureStore(surface_cells, group.xy, vec4<f32>(reach, 0.0, 0.0));
    }
}
