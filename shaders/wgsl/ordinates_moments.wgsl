// Pass: the moments of the light in clouds that a view ray needs: mean and flux of every cell, for sun and sky.
//
// One invocation a cell of one level.
//
// Definitions: those of welkin::ordinates_grid and welkin::ordinates_directions.

#import welkin::ordinates_grid::{ordinates, weight_of, LEVEL_COUNT}
#import welkin::ordinates_directions::{octant_signs, ring_components, ring_weight, DIRECTION_COUNT, RING_COUNT}

struct Part {
    level: u32,
}

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> ordinates_radiance: array<vec2<f32>>;
// Both times the cell's weight. xyz: I1 = 3 x mean of direction times radiance; w: I0, mean radiance. Light travels along
// directions.
@group(0) @binding(4) var ordinates_source: texture_3d<f32>;
@group(0) @binding(2) var ordinates_sunlight_image: texture_storage_3d<rgba16float, write>;
@group(0) @binding(3) var ordinates_skylight_image: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(16, 4, 2)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[part.level];
    if any(id >= box.size) {
        return;
    }
    let cells = box.size.x * box.size.y * box.size.z;
    let first = box.first_cell * DIRECTION_COUNT + id.x + box.size.x * (id.y + box.size.y * id.z);
    var sun = vec4<f32>(0.0);
    var sky = vec4<f32>(0.0);
    for (var octant = 0u; octant < 8u; octant++) {
        for (var ring = 0u; ring < RING_COUNT; ring++) {
            let light = ordinates_radiance[first + (octant * RING_COUNT + ring) * cells];
            let shares = ring_weight(ring) * vec4<f32>(3.0 * octant_signs(octant) * ring_components(ring), 1.0);
            sun += shares * light.x;
            sky += shares * light.y;
        }
    }
    let cell = vec3<u32>(id.xy, id.z + box.first_slice);
    let weight = weight_of(textureLoad(ordinates_source, cell, 0).x);
    textureStore(ordinates_sunlight_image, cell, weight * sun);
    textureStore(ordinates_skylight_image, cell, weight * sky);
}
