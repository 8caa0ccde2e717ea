// Pass: the moments of the light in clouds that a view ray needs: mean and flux in every fine texel, for sun and sky.
//
// One invocation a cell of one level. The light of a cell has a slope, as in the sweep. Inside an opaque cell the sun's
// light changes as its beam does as well. With e the beam over 4 pi, n the direction in which it falls and s_n = s . n,
// I1 - 3 e s_n n does not change and I0 + 3 e s_n^2 is linear: those are kept, and a view ray puts back what the beam is at
// its place. There it also puts what lumps send to themselves, e (m / k - t / c): m the mean of the
// texels' extinctions t and k the cell's, with which they let light through, and c a texel's mean.
//
// Definitions: those of welkin::ordinates_grid and welkin::ordinates_directions.

#import welkin::ordinates_grid::{ordinates, weight_of, LEVEL_COUNT, REFINEMENT}
#import welkin::ordinates_directions::{
    octant_signs, ring_components, ring_weight, DIRECTION_COUNT, RING_COUNT, SLOT_COUNT,
}

// Of a cell's light no less than this is left anywhere in it: slopes are straight, and light never ends.
const LEAST: f32 = 0.1;

struct Part {
    level: u32,
}

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var<storage, read> ordinates_radiance: array<vec2<f32>>;
@group(0) @binding(4) var ordinates_source: texture_3d<f32>;
@group(0) @binding(5) var ordinates_low_faces: texture_3d<f32>;
@group(0) @binding(6) var ordinates_high_faces: texture_3d<f32>;
@group(0) @binding(7) var ordinates_extinction: texture_3d<f32>;
@group(0) @binding(9) var ordinates_passing: texture_3d<f32>;
// Both times the texel's weight. xyz: I1 = 3 x mean of direction times radiance; w: I0, mean radiance. Light travels along
// directions.
@group(0) @binding(2) var ordinates_sunlight_image: texture_storage_3d<rgba16float, write>;
@group(0) @binding(3) var ordinates_skylight_image: texture_storage_3d<rgba16float, write>;
// Times the texel's weight: s_n n, s_n^2, as far as the cell takes light from the beam; less a third of m / k - t / c.
@group(0) @binding(8) var ordinates_beam_image: texture_storage_3d<rgba16float, write>;

// What the beam does in a cell.
struct Beam {
    // s_n n, s_n^2, times the cell's opacity.
    falling: vec4<f32>,
    // 3 e: mean, and at the cell's middle if it changed linearly from face to face.
    mean: f32,
    middle: f32,
}

fn beam_in(cell: vec3<u32>, matter: vec4<f32>, cell_m: vec3<f32>) -> Beam {
    let low = textureLoad(ordinates_low_faces, cell, 0).xyz;
    let high = textureLoad(ordinates_high_faces, cell, 0).xyz;
    let rise = (high - low) / cell_m;
    let steepness = dot(rise, rise);
    if matter.x <= 0.0 || steepness <= 0.0 {
        return Beam(vec4<f32>(0.0), 0.0, 0.0);
    }
    let normal = rise * inverseSqrt(steepness);
    let cosine = dot(normal, ordinates.toward_sun);
    let mean = 3.0 * matter.y / (matter.x * matter.w);
    let middle = mean + dot(normal * normal, 0.5 * (low + high));
    return Beam(matter.z * cosine * vec4<f32>(normal, cosine), mean, middle);
}

// Moments at a place so many cells from the centre, where they rise by so much along each axis of the cell.
fn at(moments: vec4<f32>, rise: vec3<f32>, offset: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(moments.xyz, max(moments.w + dot(rise, offset), LEAST * moments.w));
}

@compute @workgroup_size(16, 4, 2)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[part.level];
    if any(id >= box.size) {
        return;
    }
    let cells = box.size.x * box.size.y * box.size.z;
    let first = box.first_cell * SLOT_COUNT + id.x + box.size.x * (id.y + box.size.y * id.z);
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
    let matter = textureLoad(ordinates_source, cell, 0);
    let beam = beam_in(cell, matter, box.cell_m);
    let turning = -matter.x * (1.0 - ordinates.reduced_cosine * ordinates.albedo) * box.cell_m;
    let sky_rise = turning * sky.xyz;
    // Across the direction in which the beam falls, what is scattered once drives the slope too, as in the sweep.
    let dipole = -3.0 * ordinates.reduced_cosine * matter.y * ordinates.toward_sun;
    let driven = turning * sun.xyz + dipole * box.cell_m;
    sun += vec4<f32>(-beam.mean * beam.falling.xyz, beam.falling.w * beam.middle);
    let sun_rise = driven + 3.0 * matter.y * box.cell_m * beam.falling.xyz;
    for (var i = 0u; i < REFINEMENT * REFINEMENT * REFINEMENT; i++) {
        let inside = vec3<u32>(i, i / REFINEMENT, i / (REFINEMENT * REFINEMENT)) % REFINEMENT;
        let texel = cell * REFINEMENT + inside;
        let offset = (vec3<f32>(inside) + 0.5) / f32(REFINEMENT) - 0.5;
        let mean_per_m = textureLoad(ordinates_extinction, texel, 0).x;
        let weight = weight_of(mean_per_m);
        let lumps = max(matter.w - textureLoad(ordinates_passing, texel, 0).x / max(mean_per_m, 1e-20), 0.0);
        textureStore(ordinates_sunlight_image, texel, weight * at(sun, sun_rise, offset));
        textureStore(ordinates_beam_image, texel, weight * (beam.falling - vec4<f32>(0.0, 0.0, 0.0, lumps / 3.0)));
        textureStore(ordinates_skylight_image, texel, weight * at(sky, sky_rise, offset));
    }
}
