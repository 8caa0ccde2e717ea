#define_import_path welkin::cell_volumes
// Whether local volumes or their shadows end within a cell of pixels, which a workgroup looks at together:
//
//   one invocation calls forget_volumes, then all of them find_volumes and look_at_volumes with a barrier before each, and before
//   shows_edge_of_volume. Cells must be whole.
//
// Definitions: VOLUME_COUNT, FOG_COUNT; MEDIA_CELL, MEDIA_PERMILLE.

#import welkin::cluster::{cluster_of, SLICES, VOLUME_WORDS}
#import welkin::cluster_members::cluster_masks
#import welkin::media_ground::shading_depth
#import welkin::media_lattice::{centre_pixel, corner_pixel, CELL, TOLERANCE}
#import welkin::media_march::{observer_position, position_m, ray_of, NEVER_M}
#import welkin::observer::observer
#import welkin::volume_field::{local_span_m, place_of, volumes, FOG_COUNT, VOLUME_COUNT}

// WGSL has no empty arrays.
const WORD_SLOTS: u32 = max(VOLUME_WORDS, 1u);

// Bits of local volumes: those in the cell's tile, and of these the ones that some of the cell's rays meet, and that all do.
var<workgroup> in_tile: array<atomic<u32>, WORD_SLOTS>;
var<workgroup> met_by_some: array<atomic<u32>, WORD_SLOTS>;
var<workgroup> met_by_all: array<atomic<u32>, WORD_SLOTS>;
// Bits of those whose shadow may lie in the cell; and about where the cell's rays end, its radius in the fourth component, below 0 where
// they do not.
var<workgroup> may_shade: array<atomic<u32>, WORD_SLOTS>;
var<workgroup> ends: vec4<f32>;
// The least and the most that they leave of the first light where the cell's rays end, as bits of floats, whose order is that of numbers.
var<workgroup> least_light: atomic<u32>;
var<workgroup> most_light: atomic<u32>;

// What a pixel sees at the end of its ray, and -1 in the fourth component where that has none.
fn end_of(pixel: vec2<u32>) -> vec4<f32> {
    var ray = ray_of(pixel);
    return vec4<f32>(position_m(&ray, min(ray.end_m, 1e8)), select(0.0, -1.0, ray.end_m >= NEVER_M));
}

fn forget_volumes(cell: vec2<u32>) {
    ends = end_of(centre_pixel(cell));
    for (var i = 0u; i < 4u; i++) {
        let corner = end_of(corner_pixel(cell + vec2<u32>(i % 2u, i / 2u)));
        ends.a = select(max(ends.a, distance(ends.xyz, corner.xyz)), -1.0, min(ends.a, corner.a) < 0.0);
    }
    for (var word = 0u; word < VOLUME_WORDS; word++) {
        atomicStore(&may_shade[word], 0u);
        atomicStore(&in_tile[word], 0u);
        atomicStore(&met_by_some[word], 0u);
        atomicStore(&met_by_all[word], 0xffffffffu);
    }
    atomicStore(&least_light, bitcast<u32>(1.0));
    atomicStore(&most_light, 0u);
}

// How much farther than corners other pixels may see.
const BEYOND_CORNERS: f32 = 1.5;

// Of the tile's slices, and of all volumes, each invocation looks at some.
fn find_volumes(cell: vec2<u32>, first: u32) {
    let toward = observer.lights[0].direction;
    for (var i = first; ends.a >= 0.0 && i < VOLUME_COUNT - FOG_COUNT; i += CELL * CELL) {
        let to = volumes[FOG_COUNT + i].centre_m - ends.xyz;
        let along_m = dot(to, toward);
        let reach_m = length(volumes[FOG_COUNT + i].half_size_m) + BEYOND_CORNERS * ends.a;
        if along_m > -reach_m && distance(to, along_m * toward) < reach_m {
            atomicOr(&may_shade[i / 32u], 1u << (i % 32u));
        }
    }
    for (var slice = first; slice < SLICES; slice += CELL * CELL) {
        let cluster = cluster_of(corner_pixel(cell), slice);
        for (var word = 0u; word < VOLUME_WORDS; word++) {
            atomicOr(&in_tile[word], cluster_masks[cluster + word]);
        }
    }
}

// Notes what a pixel's ray meets, and what light is left at its end; whether one volume is uneven, so that neighbours look at unlike places of
// it.
fn look_at_volumes(pixel: vec2<u32>) -> bool {
    var ray = ray_of(pixel);
    let end = place_of(position_m(&ray, min(ray.end_m, 1e8)));
    var depth = 0.0;
    var is_uneven = false;
    for (var word = 0u; word < VOLUME_WORDS; word++) {
        var shades = atomicLoad(&may_shade[word]);
        while shades != 0u {
            depth += shading_depth(FOG_COUNT + 32u * word + firstTrailingBit(shades), end);
            shades &= shades - 1u;
        }
        var bits = atomicLoad(&in_tile[word]);
        var met = 0u;
        while bits != 0u {
            let bit = firstTrailingBit(bits);
            bits &= bits - 1u;
            let index = FOG_COUNT + 32u * word + bit;
            let span_m = local_span_m(index, observer_position(), ray.direction);
            if span_m.y > max(span_m.x, 0.0) {
                met |= 1u << bit;
                is_uneven = is_uneven || volumes[index].is_even == 0u;
            }
        }
        atomicOr(&met_by_some[word], met);
        atomicAnd(&met_by_all[word], met);
    }
    atomicMin(&least_light, bitcast<u32>(exp(-depth)));
    atomicMax(&most_light, bitcast<u32>(exp(-depth)));
    return is_uneven;
}

// Whether a local volume ends within the cell, or its shadow.
fn shows_edge_of_volume() -> bool {
    var found = bitcast<f32>(atomicLoad(&most_light)) - bitcast<f32>(atomicLoad(&least_light)) > TOLERANCE;
    for (var word = 0u; word < VOLUME_WORDS; word++) {
        found = found || atomicLoad(&met_by_some[word]) != atomicLoad(&met_by_all[word]);
    }
    return found;
}
