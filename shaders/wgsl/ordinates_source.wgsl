// Pass: what each cell of the solution does to light: mean extinction, and sunlight scattered for the first time.
//
// One invocation a cell of one level. The source is the mean over the cell's fine texels of extinction times what is
// left of the sun there, each averaged over the texel along the beam, so that a texel takes from the beam what the beam
// loses in it.

#import welkin::ordinates_grid::{ordinates, REFINEMENT}

const FOUR_PI: f32 = 12.5663706143592;

struct Part {
    level: u32,
}

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(1) var ordinates_extinction: texture_3d<f32>;
@group(0) @binding(2) var ordinates_depth: texture_3d<f32>;
// Mean extinction, 1/m; scattered sunlight per unit irradiance over 4 pi, 1/m/sr.
@group(0) @binding(3) var ordinates_source_image: texture_storage_3d<rgba32float, write>;

// Mean of e^-t over depths from `middle` - half to `middle` + half; half is at most `middle`, so that nothing overflows.
fn mean_transmittance(middle: f32, half: f32) -> f32 {
    if half < 0.05 {
        return exp(-middle) * (1.0 + half * half / 6.0);
    }
    return (exp(half - middle) - exp(-half - middle)) / (2.0 * half);
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[part.level];
    if any(id >= box.size) {
        return;
    }
    let cell = vec3<u32>(id.xy, id.z + box.first_slice);
    let chord_m = 1.0 / dot(abs(ordinates.toward_sun), f32(REFINEMENT) / box.cell_m);
    var extinction_per_m = 0.0;
    var lit_per_m = 0.0;
    for (var i = 0u; i < REFINEMENT * REFINEMENT * REFINEMENT; i++) {
        let inside = vec3<u32>(i, i / REFINEMENT, i / (REFINEMENT * REFINEMENT)) % REFINEMENT;
        let texel = cell * REFINEMENT + inside;
        let here_per_m = textureLoad(ordinates_extinction, texel, 0).x;
        let depth = textureLoad(ordinates_depth, texel, 0).x;
        // What lies before the texel's centre within it cannot be more than the depth there.
        let half_depth = min(0.5 * here_per_m * chord_m, depth);
        extinction_per_m += here_per_m;
        lit_per_m += here_per_m * mean_transmittance(depth, half_depth);
    }
    let share = 1.0 / f32(REFINEMENT * REFINEMENT * REFINEMENT);
    let source = share * lit_per_m * ordinates.albedo / FOUR_PI;
    textureStore(ordinates_source_image, cell, vec4<f32>(share * extinction_per_m, source, 0.0, 0.0));
}
