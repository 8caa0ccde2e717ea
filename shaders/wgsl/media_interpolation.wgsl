// Pass: what media send and leave in the pixels between those of the lattice that were marched, where it changes smoothly there; and a
// list of the cells in which it does not, whose pixels are marched.
//
// A workgroup fills a cell. Over it each channel is a parabola through the cell's corners and its middle: how it bends along rows
// tell the middles of three cells side by side, along columns what its own corners and middle then lack. Corners along its edges and
// middles above and below tell the same another way, and where they differ there is an edge or a kink.
//
// Definitions: MEDIA_CELL; MEDIA_PERMILLE, thousandths by which interpolation may err; CLOUDS; SURFACE;
// LOCAL_VOLUMES; LOCAL_LIGHT_COUNT.

#import welkin::camera::view_direction
#import welkin::cell_kind::{kind_of_cell, MIXED_CELL}
#import welkin::cell_list::{entry_of_cell, CELL_TOTAL, LIST_HEADER, MOST_GROUPS}
#import welkin::cluster::{cluster_of, SLICES}
#import welkin::media_lattice::{centre_pixel, corner_pixel, is_node, whole_cells, CELL, TOLERANCE}
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

@group(1) @binding(50) var media_radiance_image: texture_storage_2d<rgba32float, read_write>;
@group(1) @binding(51) var media_transmittance_image: texture_storage_2d<rgba32float, read_write>;
@group(1) @binding(52) var media_beam_image: texture_storage_2d<rgba32float, read_write>;
@group(1) @binding(53) var media_diffuse_image: texture_storage_2d<rgba32float, read_write>;
@group(1) @binding(54) var<storage, read_write> exact_media_cells: array<atomic<u32>>;

const IMAGES: u32 = 4u;
// How far a parabola may rise over its chords, in tolerances: it is followed, but not trusted where it is steep.
const STEEPEST: f32 = 4.0;
// Below these transmittances and shares of light, errors count as if they were so large.
const LEAST_TRANSMITTANCE: f32 = 0.01;
const LEAST_SHARE: f32 = 0.05;
// Invocations of a workgroup of `local_media`, which take a pixel each.
const MARCHED_AT_ONCE: u32 = 64u;

fn load(image: u32, pixel: vec2<u32>) -> vec4<f32> {
    switch image {
        case 0u: { return textureLoad(media_radiance_image, pixel); }
        case 1u: { return textureLoad(media_transmittance_image, pixel); }
        case 2u: { return textureLoad(media_beam_image, pixel); }
        default: { return textureLoad(media_diffuse_image, pixel); }
    }
}

// What one image is in a cell.
struct Patch {
    upper_left: vec4<f32>,
    upper_right: vec4<f32>,
    lower_left: vec4<f32>,
    lower_right: vec4<f32>,
    along_row: vec4<f32>,
    along_column: vec4<f32>,
}

var<workgroup> patches: array<Patch, IMAGES>;
var<workgroup> is_spoilt: atomic<u32>;

// Errors of an image's channels count relative to these, where the channels are not larger.
fn least(image: u32) -> vec4<f32> {
    switch image {
        case 0u: { return vec4<f32>(vec3<f32>(0.0), LEAST_SHARE); }
        case 1u: { return vec4<f32>(vec3<f32>(LEAST_TRANSMITTANCE), LEAST_SHARE); }
        default: { return vec4<f32>(LEAST_TRANSMITTANCE); }
    }
}

// By how much a parabola through three middles rises over the chord of one cell.
fn rise(image: u32, middle: vec2<u32>, across: vec2<u32>) -> vec4<f32> {
    let outer = load(image, centre_pixel(middle - across)) + load(image, centre_pixel(middle + across));
    return 0.125 * (2.0 * load(image, centre_pixel(middle)) - outer);
}

fn patch_of(image: u32, cell: vec2<u32>, middle: vec2<u32>) -> Patch {
    var found: Patch;
    found.upper_left = load(image, corner_pixel(cell));
    found.upper_right = load(image, corner_pixel(cell + vec2<u32>(1u, 0u)));
    found.lower_left = load(image, corner_pixel(cell + vec2<u32>(0u, 1u)));
    found.lower_right = load(image, corner_pixel(cell + 1u));
    found.along_row = rise(image, vec2<u32>(middle.x, cell.y), vec2<u32>(1u, 0u));
    let mean = 0.25 * (found.upper_left + found.upper_right + found.lower_left + found.lower_right);
    found.along_column = load(image, centre_pixel(cell)) - mean - found.along_row;
    return found;
}

// The same for a parabola near four corners in a line, over the chord between the two in the middle.
fn rise_of_edge(image: u32, first: vec2<u32>, across: vec2<u32>) -> vec4<f32> {
    let chord = load(image, corner_pixel(first)) + load(image, corner_pixel(first + across));
    return 0.0625 * (chord - load(image, corner_pixel(first - across)) - load(image, corner_pixel(first + 2u * across)));
}

// Whether an image must not be interpolated in a cell. `middle` has neighbours on all sides.
fn is_rough(image: u32, cell: vec2<u32>, middle: vec2<u32>, found: Patch) -> bool {
    let right = vec2<u32>(1u, 0u);
    let down = vec2<u32>(0u, 1u);
    let above = rise_of_edge(image, vec2<u32>(middle.x, cell.y), right);
    let below = rise_of_edge(image, vec2<u32>(middle.x, cell.y) + down, right);
    let left_side = rise_of_edge(image, vec2<u32>(cell.x, middle.y), down);
    let right_side = rise_of_edge(image, vec2<u32>(cell.x, middle.y) + right, down);
    let along_column = rise(image, vec2<u32>(cell.x, middle.y), down);
    let differ = max(
        max(abs(found.along_row - above), abs(found.along_row - below)),
        max(max(abs(found.along_column - left_side), abs(found.along_column - right_side)), abs(found.along_column - along_column)),
    );
    let height = abs(found.along_row) + max(abs(found.along_column), abs(along_column));
    let allowed = TOLERANCE * max(abs(load(image, centre_pixel(cell))), least(image));
    let is_steep = any(height > STEEPEST * allowed) || any(differ > allowed);
#ifdef CLOUDS
    // Their edges may lie between the lattice's pixels.
    return is_steep || (image == 2u && (height.a > 0.0 || found.upper_left.a + found.lower_right.a > 0.0));
#else
    return is_steep;
#endif
}

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

fn between(found: Patch, share: vec2<f32>) -> vec4<f32> {
    let chord = mix(
        mix(found.upper_left, found.upper_right, share.x), mix(found.lower_left, found.lower_right, share.x), share.y
    );
    let bend = 4.0 * share * (1.0 - share);
    let value = chord + bend.x * found.along_row + bend.y * found.along_column;
    // What is no number stays none, and is seen.
    return select(value, vec4<f32>(0.0), value < vec4<f32>(0.0));
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
    let cell = group.xy;
    let whole = whole_cells(textureDimensions(media_radiance_image));
    let is_whole = all(cell < whole);
    if first == 0u {
        atomicStore(&is_spoilt, 0u);
#ifdef LOCAL_VOLUMES
        forget_volumes(min(cell, whole - 1u));
#endif
    }
    workgroupBarrier();
#ifdef LOCAL_VOLUMES
    find_volumes(cell, first);
    workgroupBarrier();
#endif
    var spoils = !is_whole;
    if is_whole {
        let middle = clamp(cell, vec2<u32>(1u), whole - 2u);
        if first < IMAGES {
            let found = patch_of(first, cell, middle);
            patches[first] = found;
            spoils = is_rough(first, cell, middle, found);
        }
        if first == IMAGES {
            spoils = shows_horizon_or_disc(cell);
        }
        spoils = spoils || leaves_surface(cell, id.xy) || shows_lamp(cell, first);
#ifdef LOCAL_VOLUMES
        spoils = look_at_volumes(corner_pixel(cell) + id.xy) || spoils;
#endif
    }
    if spoils {
        atomicOr(&is_spoilt, 1u);
    }
    workgroupBarrier();
    var is_listed = atomicLoad(&is_spoilt) > 0u;
#ifdef LOCAL_VOLUMES
    is_listed = is_listed || shows_edge_of_volume();
#endif
    if is_listed {
        if first == 0u {
            list(cell);
        }
        return;
    }
    let pixel = corner_pixel(cell) + id.xy;
    if is_node(pixel) {
        return;
    }
    let share = vec2<f32>(id.xy) / f32(CELL);
    textureStore(media_radiance_image, pixel, between(patches[0], share));
    textureStore(media_transmittance_image, pixel, between(patches[1], share));
    textureStore(media_beam_image, pixel, between(patches[2], share));
    textureStore(media_diffuse_image, pixel, between(patches[3], share));
}
