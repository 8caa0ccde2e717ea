// Pass: optical depth of the clouds' similar medium from every fine texel towards the sun.
//
// One invocation a texel of one level. A ray goes from the finest level that holds it to coarser ones, in steps of half
// a texel's mean chord that end where a level does, until it leaves the grid or nothing is left of the light.
//
// Definitions: those of welkin::ordinates_grid.

#import welkin::ordinates_grid::{ordinates, LEVEL_COUNT, REFINEMENT, coordinates, highest_m, level_of}

struct Part {
    level: u32,
}

// Beyond this depth e^-depth is nothing.
const OPAQUE: f32 = 60.0;
// A ray along a periodic layer would never end.
const MAX_STEPS: u32 = 2048u;

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var ordinates_passing: texture_3d<f32>;
@group(0) @binding(2) var table_sampler: sampler;
@group(0) @binding(3) var ordinates_depth_image: texture_storage_3d<r32float, write>;

// Distance to where a ray leaves a level that holds its place.
fn exit_m(place_m: vec3<f32>, direction: vec3<f32>, level: u32) -> f32 {
    let ahead_m = select(place_m - ordinates.levels[level].lowest_m, highest_m(level) - place_m, direction > vec3<f32>(0.0));
    let along_m = max(ahead_m, vec3<f32>(0.0)) / max(abs(direction), vec3<f32>(1e-6));
#ifdef ORDINATES_PERIODIC
    if level + 1u == LEVEL_COUNT {
        return along_m.z;
    }
#endif
    return min(min(along_m.x, along_m.y), along_m.z);
}

fn depth_along(start_m: vec3<f32>, direction: vec3<f32>) -> f32 {
    let texture_size = vec3<f32>(textureDimensions(ordinates_passing));
    var place_m = start_m;
    var depth = 0.0;
    for (var i = 0u; i < MAX_STEPS && depth < OPAQUE; i++) {
        let at = level_of(place_m);
        if at == LEVEL_COUNT {
            break;
        }
        let texel_m = ordinates.levels[at].cell_m / f32(REFINEMENT);
        // Half of volume over projected area.
        let longest_m = 0.5 / dot(abs(direction), 1.0 / texel_m);
        let step_m = min(longest_m, exit_m(place_m, direction, at));
        let middle = coordinates(place_m + 0.5 * step_m * direction, at, texture_size, f32(REFINEMENT));
        depth += step_m * textureSampleLevel(ordinates_passing, table_sampler, middle, 0.0).x;
        // A little more, so that rounding leaves no place on the boundary.
        place_m += (step_m + 1e-3 * longest_m) * direction;
    }
    return depth;
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[part.level];
    if any(id >= box.size * REFINEMENT) {
        return;
    }
    let place_m = box.lowest_m + (vec3<f32>(id) + 0.5) * box.cell_m / f32(REFINEMENT);
    let depth = depth_along(place_m, ordinates.toward_sun);
    let slice = box.first_slice * REFINEMENT;
    textureStore(ordinates_depth_image, vec3<u32>(id.xy, id.z + slice), vec4<f32>(depth, 0.0, 0.0, 0.0));
}
