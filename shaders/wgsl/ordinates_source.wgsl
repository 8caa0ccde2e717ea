// Pass: what each cell of the solution does to light: extinction, and sunlight scattered for the first time.
//
// One invocation a cell of one level. The source is the mean over the cell's fine texels of extinction times what is
// left of the sun there, each averaged over the texel, so that a texel takes from the beam what the beam loses in it.
//
// Clouds are lumpier than cells are small. A cell's extinction k is that with which it lets light through, as the texels' is,
// less than the mean c. What a lump scatters is J = I0 + Q / k, as bright as it must be for all of it to leave the cell; a view
// ray adds Q / c of that itself, so that lumps must have more light than the cell's mean I0 by what they send to themselves.
//
// Along each axis the beam is taken for an exponential that has this mean, and from one half of the cell to the other
// the ratio that it has there, but falls no faster than the cell's own extinction makes it: a shadow's edge through thin
// air is no scattered light.

#import welkin::ordinates_grid::{ordinates, Level, REFINEMENT}

// Of texels along an axis of a cell, side by side.
const LINES: u32 = REFINEMENT * REFINEMENT;

const FOUR_PI: f32 = 12.5663706143592;

struct Part {
    level: u32,
}

@group(0) @binding(0) var<uniform> part: Part;
@group(0) @binding(2) var ordinates_depth: texture_3d<f32>;
// Extinction, 1/m; scattered sunlight per unit irradiance over 4 pi, 1/m/sr; share of the beam that the cell would
// take from it; the texels' mean extinction over the cell's, at least 1.
@group(0) @binding(1) var ordinates_passing: texture_3d<f32>;
@group(0) @binding(3) var ordinates_source_image: texture_storage_3d<rgba32float, write>;
// By how much 3 times the beam over 4 pi is brighter at the cell's faces than in its mean, 1/sr.
@group(0) @binding(4) var ordinates_low_faces_image: texture_storage_3d<rgba16float, write>;
@group(0) @binding(5) var ordinates_high_faces_image: texture_storage_3d<rgba16float, write>;

// Mean of e^-(middle + t) over a box in which t rises linearly from minus half to half along each axis.
fn mean_transmittance(middle: f32, half: vec3<f32>) -> f32 {
    let total = half.x + half.y + half.z;
    // Before the box nothing is left out: its brightest corner is no brighter than the beam.
    let each = half * min(1.0, middle / max(total, 1e-20));
    // (1 - e^-2x) / 2x.
    let exact = (1.0 - exp(-2.0 * each)) / max(2.0 * each, vec3<f32>(1e-20));
    let shares = select(exact, 1.0 - each, each < vec3<f32>(0.01));
    return exp(each.x + each.y + each.z - middle) * shares.x * shares.y * shares.z;
}

fn depth_at(texel: vec3<u32>) -> f32 {
    return textureLoad(ordinates_depth, texel, 0).x;
}

// By how much the depth of a texel rises from its middle to its faces: as to the neighbour to which it changes more,
// for the other may be clear, but no more than its own extinction makes it.
fn half_depths(box: Level, texel: vec3<u32>, depth: f32, extinction_per_m: f32) -> vec3<f32> {
    let lowest = vec3<u32>(0u, 0u, box.first_slice * REFINEMENT);
    let highest = lowest + box.size * REFINEMENT - 1u;
    let path_m = box.cell_m / f32(REFINEMENT) / max(abs(ordinates.toward_sun), vec3<f32>(1e-3));
    var rise = vec3<f32>(0.0);
    for (var axis = 0u; axis < 3u; axis++) {
        var before = texel;
        var after = texel;
        before[axis] = max(texel[axis], lowest[axis] + 1u) - 1u;
        after[axis] = min(texel[axis] + 1u, highest[axis]);
        rise[axis] = max(abs(depth_at(before) - depth), abs(depth_at(after) - depth));
    }
    return 0.5 * min(rise, extinction_per_m * path_m);
}

// Logarithm of the beam's ratio between the higher and the lower face, from extinctions and scattered light of the higher
// and the lower half; at most so much.
fn beam_growth(per_m: vec2<f32>, lit_per_m: vec2<f32>, most: f32) -> f32 {
    if REFINEMENT < 2u || any(per_m <= vec2<f32>(0.0)) {
        return 0.0;
    }
    let beam = max(lit_per_m / per_m, vec2<f32>(1e-30));
    return clamp(2.0 * log(beam.x / beam.y), -most, most);
}

// Extinction with which a cell lets through what its texels do in the mean, along each axis by lines of them.
fn passing_extinction(box: Level, cell: vec3<u32>) -> f32 {
    let texel_m = box.cell_m / f32(REFINEMENT);
    var sum = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        var depths: array<f32, LINES>;
        var least = 1e30;
        for (var line = 0u; line < LINES; line++) {
            var inside: vec3<u32>;
            inside[(axis + 1u) % 3u] = line % REFINEMENT;
            inside[(axis + 2u) % 3u] = line / REFINEMENT;
            for (var i = 0u; i < REFINEMENT; i++) {
                inside[axis] = i;
                depths[line] += texel_m[axis] * textureLoad(ordinates_passing, cell * REFINEMENT + inside, 0).x;
            }
            least = min(least, depths[line]);
        }
        var passed = 0.0;
        for (var line = 0u; line < LINES; line++) {
            passed += exp(least - depths[line]) / f32(LINES);
        }
        sum += (least - log(passed)) / box.cell_m[axis];
    }
    return max(sum / 3.0, 0.0);
}

// x / (e^x - 1).
fn bernoulli(x: f32) -> f32 {
    if abs(x) < 0.01 {
        return 1.0 - 0.5 * x;
    }
    return x / (exp(x) - 1.0);
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[part.level];
    if any(id >= box.size) {
        return;
    }
    let cell = vec3<u32>(id.xy, id.z + box.first_slice);
    // Of the cell, and of its higher half along each axis.
    var extinction_per_m = 0.0;
    var lit_per_m = 0.0;
    var higher_per_m = vec3<f32>(0.0);
    var higher_lit_per_m = vec3<f32>(0.0);
    for (var i = 0u; i < REFINEMENT * REFINEMENT * REFINEMENT; i++) {
        let inside = vec3<u32>(i, i / REFINEMENT, i / (REFINEMENT * REFINEMENT)) % REFINEMENT;
        let texel = cell * REFINEMENT + inside;
        let here_per_m = textureLoad(ordinates_passing, texel, 0).x;
        let depth = depth_at(texel);
        let half = half_depths(box, texel, depth, here_per_m);
        let here_lit_per_m = here_per_m * mean_transmittance(depth, half);
        let is_higher = vec3<f32>(2u * inside + 1u > vec3<u32>(REFINEMENT));
        extinction_per_m += here_per_m;
        lit_per_m += here_lit_per_m;
        higher_per_m += is_higher * here_per_m;
        higher_lit_per_m += is_higher * here_lit_per_m;
    }
    let share = 1.0 / f32(REFINEMENT * REFINEMENT * REFINEMENT);
    let source = share * lit_per_m * ordinates.albedo / FOUR_PI;
    let c = passing_extinction(box, cell);
    let lumps = select(1.0, share * extinction_per_m / c, c > 0.0);
    let opacity = 1.0 - exp(-c / dot(abs(ordinates.toward_sun), 1.0 / box.cell_m));
    // By how much the beam is brighter than in the mean.
    var low = vec3<f32>(0.0);
    var high = vec3<f32>(0.0);
    if lit_per_m > 0.0 {
        let mean = lit_per_m / extinction_per_m;
        for (var axis = 0u; axis < 3u; axis++) {
            let growth = beam_growth(
                vec2<f32>(higher_per_m[axis], extinction_per_m - higher_per_m[axis]),
                vec2<f32>(higher_lit_per_m[axis], lit_per_m - higher_lit_per_m[axis]),
                c * box.cell_m[axis] / max(abs(ordinates.toward_sun[axis]), 1e-3),
            );
            low[axis] = min(mean * bernoulli(growth), 1.0) - mean;
            high[axis] = min(mean * bernoulli(-growth), 1.0) - mean;
        }
    }
    let beam = 3.0 * ordinates.albedo / FOUR_PI;
    textureStore(ordinates_source_image, cell, vec4<f32>(c, source, opacity, max(lumps, 1.0)));
    textureStore(ordinates_low_faces_image, cell, vec4<f32>(beam * low, 0.0));
    textureStore(ordinates_high_faces_image, cell, vec4<f32>(beam * high, 0.0));
}
