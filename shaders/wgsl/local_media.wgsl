// Pass: the march through the sum of all media where a scene has fog, local volumes or local lights: clouds are one more
// kind of matter in it.
//
// A pixel's ray is marched (welkin::media_advance) up to what stands before the camera.
//
// Definitions: CLOUDS; MEDIA_LATTICE (only the pixels of the lattice, or of listed cells: welkin::media_lattice);
// MEDIA_FROXELS (what is found up to several distances is kept for the former, and they go on behind what stands before the camera:
// welkin::media_froxels).

#ifdef MEDIA_LATTICE
#import welkin::cell_list::{cell_of_entry, CELL_TOTAL, LIST_HEADER, MOST_GROUPS}
#endif
#ifdef CLOUDS
#import welkin::cloud_source::phases
#endif
#import welkin::media_advance::{advance, March, MAX_STEPS, PHASE_SLOTS}
#ifdef MEDIA_FROXELS
#import welkin::media_froxels::{froxel_layer, part_of, slot_m, slots_around, SlotRange, BEAM, DIFFUSE, RADIANCE, TRANSMITTANCE, WHOLE}
#endif
#import welkin::media_lattice::{centre_pixel, corner_pixel, is_node, CELL}
#import welkin::media_march::{clear_air, clear_way_of, follow_air, pass_air, place_in_step, ray_of, NEVER_M}
#import welkin::media_sum::{depth_of, found, found_at_end, Found, Sum}

// Light of clouds, fog and volumes at the observer, and what they leave of the beam on smooth ground at the end.
@group(1) @binding(50) var media_radiance_image: texture_storage_2d<rgba32float, write>;
// Their transmittance, and what they leave of the diffuse light there.
@group(1) @binding(51) var media_transmittance_image: texture_storage_2d<rgba32float, write>;
// int T S dT_air and T T_air at the end, as in the pass of the clouds: of the beam, and of diffuse light.
@group(1) @binding(52) var media_beam_image: texture_storage_2d<rgba32float, write>;
@group(1) @binding(53) var media_diffuse_image: texture_storage_2d<rgba32float, write>;
#ifdef MEDIA_FROXELS
// x, y: cell; z: slots, parts and images (welkin::media_froxels).
@group(1) @binding(55) var media_froxels: texture_storage_3d<rgba32float, write>;
@group(1) @binding(56) var surface_cells: texture_2d<f32>;
#endif

fn put(pixel: vec2<u32>, all: Found) {
    textureStore(media_radiance_image, pixel, all.radiance);
    textureStore(media_transmittance_image, pixel, all.transmittance);
    textureStore(media_beam_image, pixel, all.beam);
    textureStore(media_diffuse_image, pixel, all.diffuse);
}

#ifdef MEDIA_FROXELS
// Keeps what lies before a slot's distance.
fn keep(pixel: vec2<u32>, slot: u32, all: Found) {
    let cell = pixel / CELL;
    let part = part_of(pixel);
    textureStore(media_froxels, vec3<u32>(cell, froxel_layer(slot, part, RADIANCE)), all.radiance);
    textureStore(media_froxels, vec3<u32>(cell, froxel_layer(slot, part, TRANSMITTANCE)), all.transmittance);
    textureStore(media_froxels, vec3<u32>(cell, froxel_layer(slot, part, BEAM)), all.beam);
    textureStore(media_froxels, vec3<u32>(cell, froxel_layer(slot, part, DIFFUSE)), all.diffuse);
}

// A cell's parabolas ask the pixels of the lattice around it: up to so many cells before it and behind it, and one more at the
// picture's edges.
const ASKED_FROM_BEFORE: u32 = 2u;
const ASKED_FROM_BEHIND: u32 = 1u;

// The slots that cells may ask of the lattice's pixels in one of them.
fn slots_for(cell: vec2<u32>) -> SlotRange {
    let last = textureDimensions(surface_cells) - 1u;
    let first_cell = select(cell - min(cell, vec2<u32>(ASKED_FROM_BEFORE)), vec2<u32>(0u), cell <= vec2<u32>(ASKED_FROM_BEFORE + 1u));
    let last_cell = select(cell + ASKED_FROM_BEHIND, last, cell + ASKED_FROM_BEHIND + 2u >= last);
    var reach = vec2<f32>(NEVER_M, 0.0);
    for (var row = first_cell.y; row <= last_cell.y; row++) {
        for (var column = first_cell.x; column <= last_cell.x; column++) {
            let here = textureLoad(surface_cells, vec2<u32>(column, row), 0).xy;
            reach = vec2<f32>(min(reach.x, here.x), max(reach.y, here.y));
        }
    }
    return slots_around(reach.x, reach.y);
}
#endif

// Marches a pixel's ray; one that keeps froxels goes on behind what stands before the camera.
fn march(pixel: vec2<u32>, keeps: bool) {
    var ray = ray_of(pixel);
    let offset = place_in_step(pixel, 0.0);
    var phase: array<f32, PHASE_SLOTS>;
#ifdef CLOUDS
    phase = phases(ray.direction);
#endif
    var sum: Sum;
    var air = clear_air();
    var march: March;
    march.cut_m = NEVER_M;
#ifdef MEDIA_FROXELS
    let whole_way = clear_way_of(pixel);
    var asked = SlotRange(0u, 0u);
    if keeps {
        asked = slots_for(pixel / CELL);
    }
    var slot = asked.first;
    march.cut_m = select(NEVER_M, slot_m(slot), slot < asked.end);
    let legs = select(1u, 2u, keeps && ray.end_m < whole_way.end_m);
    for (var leg = 0u; leg < legs; leg++) {
        march.is_over = false;
#endif
        while march.steps < MAX_STEPS && march.t_m < ray.end_m && !march.is_over {
            advance(&march, &sum, &air, &ray, offset, &phase);
            march.steps += 1u;
#ifdef MEDIA_FROXELS
            if march.t_m >= 0.999999 * march.cut_m {
                var air_here = air;
                follow_air(&air_here, &ray);
                keep(pixel, slot, found(sum, &air_here));
                slot += 1u;
                march.cut_m = select(NEVER_M, slot_m(slot), slot < asked.end);
            }
#endif
        }
#ifdef MEDIA_FROXELS
        var air_behind = air;
        let all = found_at_end(sum, &air_behind, &ray);
        if leg == 0u {
            put(pixel, all);
        }
        if keeps && leg + 1u == legs {
            keep(pixel, WHOLE, all);
        }
        ray = whole_way;
    }
    for (; slot < asked.end; slot++) {
        pass_air(&air, &ray, exp(-depth_of(sum)), min(slot_m(slot), ray.end_m));
        follow_air(&air, &ray);
        keep(pixel, slot, found(sum, &air));
    }
#else
    put(pixel, found_at_end(sum, &air, &ray));
#endif
}

#ifdef MEDIA_LATTICE
// Cells whose pixels are marched one by one, and their number: none before those of the lattice are there.
@group(1) @binding(54) var<storage, read> exact_media_cells: array<u32>;

const GROUP_SIZE: u32 = 64u;
#ifdef MEDIA_FROXELS
const KEEPS_FROXELS: bool = true;
#else
const KEEPS_FROXELS: bool = false;
#endif

struct Asked {
    pixel: vec2<u32>,
    is_asked: bool,
}

// x, y: cell; z: 0 for the pixel in its corner, 1 for the one in its middle.
fn asked_of_lattice(id: vec3<u32>) -> Asked {
    let pixel = select(corner_pixel(id.xy), centre_pixel(id.xy), id.z == 1u);
    return Asked(pixel, all(pixel < textureDimensions(media_radiance_image)));
}

fn asked_of_list(index: u32) -> Asked {
    let cell = cell_of_entry(exact_media_cells[LIST_HEADER + index / (CELL * CELL)]);
    let pixel = corner_pixel(cell) + vec2<u32>(index % CELL, index / CELL % CELL);
    // What was cut for froxels is marched again, as the pixels beside it are.
    let is_done = is_node(pixel) && !KEEPS_FROXELS;
    return Asked(pixel, all(pixel < textureDimensions(media_radiance_image)) && !is_done);
}

@compute @workgroup_size(8, 8)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) first: u32,
) {
    let listed = CELL * CELL * exact_media_cells[CELL_TOTAL];
    var index = GROUP_SIZE * group.x + first;
    loop {
        var asked = asked_of_lattice(id);
        if listed > 0u {
            asked = asked_of_list(min(index, listed - 1u));
            asked.is_asked = asked.is_asked && index < listed;
        }
        if asked.is_asked {
            march(asked.pixel, listed == 0u);
        }
        continuing {
            index += GROUP_SIZE * MOST_GROUPS;
            break if index >= listed;
        }
    }
}
#else
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if all(id.xy < textureDimensions(media_radiance_image)) {
        march(id.xy, false);
    }
}
#endif
