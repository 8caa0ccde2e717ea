// Pass: what media send and leave in the pixels between those of the lattice that were marched, where it changes smoothly there; and a
// list of the cells in which it does not, whose pixels are marched.
//
// A workgroup fills a cell, by parabolas through what was marched up to where the cell's own rays end (welkin::media_patch), if that is smooth;
// else between two slots of the froxels before what each pixel sees (welkin::media_slices).
//
// Definitions: MEDIA_CELL; MEDIA_FROXELS; SURFACE; LOCAL_VOLUMES; LOCAL_LIGHT_COUNT.

#import welkin::camera::view_direction
#import welkin::cell_kind::{kind_of_cell, MIXED_CELL}
#import welkin::cell_list::{entry_of_cell, CELL_TOTAL, LIST_HEADER, MOST_GROUPS}
#import welkin::cluster::{cluster_of, SLICES}
#import welkin::media_froxels::{BEAM, DIFFUSE, IMAGES, OWN, RADIANCE, TRANSMITTANCE}
#import welkin::media_lattice::{centre_pixel, corner_pixel, is_node, whole_cells, CELL, TOLERANCE}
#import welkin::media_patch::{
    between, is_rough, media_beam_image, media_diffuse_image, media_radiance_image, media_transmittance_image, patch_of, Layer, Patch,
}
#ifdef MEDIA_FROXELS
#import welkin::media_slices::in_slices
#endif
#if LOCAL_LIGHT_COUNT > 0
#import welkin::cluster_members::{lamps_of, next_member, NONE}
#import welkin::local_light::local_lights
#endif
#import welkin::media_march::{observer_position, NEVER_M}
#ifdef LOCAL_VOLUMES
#import welkin::cell_volumes::{find_volumes, forget_volumes, look_at_volumes, shows_edge_of_volume}
#endif
#ifdef SURFACE
#import welkin::media_march::surface_image
#endif

@group(1) @binding(54) var<storage, read_write> exact_media_cells: array<atomic<u32>>;

// Invocations of a workgroup of `local_media`, which take a pixel each.
const MARCHED_AT_ONCE: u32 = 64u;

var<workgroup> patches: array<Patch, IMAGES>;
// Whether it must be marched.
var<workgroup> is_lost: atomic<u32>;
// Whether what was marched up to its rays' ends will not do.
var<workgroup> is_cut: atomic<u32>;
// Whether it shows the horizon or a disc.
var<workgroup> is_mixed: u32;

// Whether a cell shows the horizon or a disc.
fn shows_horizon_or_disc(cell: vec2<u32>) -> bool {
    let pixel = centre_pixel(cell);
    let view = view_direction(pixel);
    // From the middle of the middle pixel to the outer sides of those at the corners.
    let half_side = 0.5 * f32(CELL) + 0.5;
    return kind_of_cell(vec2<f32>(pixel) + 0.5, half_side, view, atan2(length(view.xy), view.z)) == MIXED_CELL;
}

#if LOCAL_LIGHT_COUNT > 0
// A lamp, and the middle of what it lights on the ground, are kept out of cells by so many of their half diagonals.
const LAMP_REACH: f32 = 3.0;

fn is_seen_near(view: vec3<f32>, to: vec3<f32>, reach: f32) -> bool {
    return distance(normalize(to), view) < reach;
}
#endif

// Whether a local light stands in the cell or beside it, or the middle of what it lights: that may be small. Of the slices of the cell's tile
// each invocation looks at some.
fn shows_lamp(cell: vec2<u32>, first: u32) -> bool {
    var found = false;
#if LOCAL_LIGHT_COUNT > 0
    let view = view_direction(centre_pixel(cell));
    let reach = LAMP_REACH * distance(view, view_direction(corner_pixel(cell)));
    let eye = observer_position();
    for (var slice = first; slice < SLICES; slice += CELL * CELL) {
        var lamps = lamps_of(cluster_of(corner_pixel(cell), slice));
        for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
            let lamp = local_lights[light];
            let down_m = lamp.position_m.z / max(-lamp.axis.z, 0.01);
            let foot_m = vec3<f32>(lamp.position_m.xy, 0.0);
            found = found || is_seen_near(view, lamp.position_m - eye, reach) || is_seen_near(view, foot_m - eye, reach)
                || is_seen_near(view, lamp.position_m + down_m * lamp.axis - eye, reach);
        }
    }
#endif
    return found;
}

#ifdef SURFACE
fn surface_m(pixel: vec2<u32>) -> f32 {
    return min(textureLoad(surface_image, pixel, 0).a, NEVER_M);
}
#endif

// Whether what stands before the camera in a pixel is not as far away as between the cell's corners.
fn leaves_surface(cell: vec2<u32>, within: vec2<u32>) -> bool {
#ifdef SURFACE
    let corner = corner_pixel(cell);
    let left_m = vec2<f32>(surface_m(corner), surface_m(corner + vec2<u32>(0u, CELL)));
    let right_m = vec2<f32>(surface_m(corner + vec2<u32>(CELL, 0u)), surface_m(corner + CELL));
    let share = vec2<f32>(within) / f32(CELL);
    let sides_m = mix(left_m, right_m, share.x);
    let between_m = mix(sides_m.x, sides_m.y, share.y);
    return abs(surface_m(corner + within) - between_m) > TOLERANCE * between_m;
#else
    return false;
#endif
}

fn list(cell: vec2<u32>) {
    let entry = atomicAdd(&exact_media_cells[CELL_TOTAL], 1u);
    atomicStore(&exact_media_cells[LIST_HEADER + entry], entry_of_cell(cell));
    let groups = ((entry + 1u) * CELL * CELL + MARCHED_AT_ONCE - 1u) / MARCHED_AT_ONCE;
    atomicMax(&exact_media_cells[0], min(groups, MOST_GROUPS));
    atomicMax(&exact_media_cells[1], 1u);
    atomicMax(&exact_media_cells[2], 1u);
}

@compute @workgroup_size(#{MEDIA_CELL}, #{MEDIA_CELL})
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) first: u32,
) {
    let whole = whole_cells(textureDimensions(media_radiance_image));
    let is_whole = all(group.xy < whole);
    // Those that the picture cuts off are listed, whatever their neighbours are.
    let cell = min(group.xy, whole - 1u);
    let pixel = corner_pixel(cell) + id.xy;
    if first == 0u {
        atomicStore(&is_lost, u32(!is_whole));
        atomicStore(&is_cut, 0u);
        is_mixed = u32(shows_horizon_or_disc(cell));
#ifdef LOCAL_VOLUMES
        forget_volumes(cell);
#endif
    }
    workgroupBarrier();
#ifdef LOCAL_VOLUMES
    find_volumes(cell, first);
    workgroupBarrier();
    if look_at_volumes(pixel) {
        atomicOr(&is_lost, 1u);
    }
    workgroupBarrier();
    if first == 0u && shows_edge_of_volume() {
        atomicOr(&is_lost, 1u);
    }
#endif
    if shows_lamp(cell, first) {
        atomicOr(&is_lost, 1u);
    }
    let middle = clamp(cell, vec2<u32>(1u), whole - 2u);
    if first < IMAGES {
        let own = Layer(first, OWN);
        patches[first] = patch_of(own, cell, middle);
        if is_rough(own, cell, middle, patches[first]) {
            atomicOr(&is_cut, 1u);
        }
    }
    if leaves_surface(cell, id.xy) || is_mixed > 0u {
        atomicOr(&is_cut, 1u);
    }
    workgroupBarrier();
    var is_found = atomicLoad(&is_lost) == 0u;
    var found: array<vec4<f32>, IMAGES>;
    if is_found && atomicLoad(&is_cut) == 0u {
        for (var image = 0u; image < IMAGES; image++) {
            found[image] = between(patches[image], vec2<f32>(id.xy) / f32(CELL));
        }
    } else if is_found {
#ifdef MEDIA_FROXELS
        let filled = in_slices(cell, middle, pixel, first, is_mixed > 0u);
        found = filled.values;
        is_found = !filled.fails;
#else
        is_found = false;
#endif
    }
    if !is_found {
        if first == 0u {
            list(group.xy);
        }
        return;
    }
    if is_node(pixel) {
        return;
    }
    textureStore(media_radiance_image, pixel, found[RADIANCE]);
    textureStore(media_transmittance_image, pixel, found[TRANSMITTANCE]);
    textureStore(media_beam_image, pixel, found[BEAM]);
    textureStore(media_diffuse_image, pixel, found[DIFFUSE]);
}
