// Pass: what media send and leave in the pixels between those of the lattice that were marched, where it changes smoothly there; and a
// list of the cells in which it does not, whose pixels are marched.
//
// A workgroup fills a cell, by parabolas through what was marched (welkin::media_patch): up to where the cell's own rays end, if
// what they end on is smooth, else between two slots of the froxels before what each pixel sees.
//
// Definitions: MEDIA_CELL; MEDIA_FROXELS; SURFACE; LOCAL_VOLUMES; LOCAL_LIGHT_COUNT.

#import welkin::camera::view_direction
#import welkin::cell_kind::{kind_of_cell, MIXED_CELL}
#import welkin::cell_list::{entry_of_cell, CELL_TOTAL, LIST_HEADER, MOST_GROUPS}
#import welkin::cluster::{cluster_of, SLICES}
#import welkin::media_froxels::{
    share_of_light, slot_m, slots_around, slots_before, SlotRange, BEAM, DIFFUSE, DISTANCES, IMAGES, NO_SLOT, OWN, PER_OCTAVE, RADIANCE,
    TRANSMITTANCE, WHOLE,
}
#import welkin::media_lattice::{centre_pixel, corner_pixel, is_node, whole_cells, CELL, TOLERANCE}
#import welkin::media_patch::{
    allowed_error, at_middle, between, is_rough, media_beam_image, media_diffuse_image, media_radiance_image,
    media_transmittance_image, patch_of, Layer, Patch, STEEPEST,
}
#if LOCAL_LIGHT_COUNT > 0
#import welkin::cluster_members::{lamps_of, next_member, NONE}
#import welkin::local_light::local_lights
#endif
#import welkin::media_march::{observer_position, ray_of, NEVER_M}
#ifdef LOCAL_VOLUMES
#import welkin::cell_volumes::{find_volumes, forget_volumes, look_at_volumes, shows_edge_of_volume}
#endif
#ifdef SURFACE
#import welkin::media_march::surface_image
#endif

#ifdef MEDIA_FROXELS
@group(1) @binding(56) var surface_cells: texture_2d<f32>;
#endif
@group(1) @binding(54) var<storage, read_write> exact_media_cells: array<atomic<u32>>;

// Invocations of a workgroup of `local_media`, which take a pixel each.
const MARCHED_AT_ONCE: u32 = 64u;

// Of the slots that are looked at together, each image over the cell, and how it bends from slot to slot.
const SLOTS_AT_ONCE: u32 = 4u;
var<workgroup> patches: array<Patch, SLOTS_AT_ONCE * IMAGES>;
var<workgroup> bends: array<vec3<f32>, SLOTS_AT_ONCE * IMAGES>;
// Bits of the slots that pixels of the cell lie between.
var<workgroup> slots: atomic<u32>;
// Whether the cell cannot be filled from them, or not at all.
var<workgroup> is_rough_here: atomic<u32>;
var<workgroup> is_lost: atomic<u32>;
// Whether its rays' ends are not smooth.
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

// Between which slots a pixel's ray ends, and at what share of the way from the first to the second.
struct Way {
    before: u32,
    behind: u32,
    share: f32,
}

fn way_of(pixel: vec2<u32>) -> Way {
    var ray = ray_of(pixel);
    if ray.meets_ground || ray.end_m >= NEVER_M {
        return Way(WHOLE, WHOLE, 0.0);
    }
    let passed = slots_before(ray.end_m);
    if passed == 0u {
        return Way(NO_SLOT, 0u, ray.end_m / slot_m(0u));
    }
    let before_m = slot_m(passed - 1u);
    // Behind the last one nothing may follow.
    let share = select((ray.end_m - before_m) / (slot_m(passed) - before_m), 0.0, passed == DISTANCES);
    return Way(passed - 1u, passed, share);
}

// Bits of slots: distances from the cell's first one on, and those that are none.
const DISTANCE_BITS: u32 = 30u;

fn bit_of(slot: u32, first: u32) -> u32 {
    let place = select(slot - first, slot - WHOLE + DISTANCE_BITS, slot >= WHOLE);
    return select(0u, 1u << min(place, 31u), slot < NO_SLOT);
}

fn slot_of(bit: u32, first: u32) -> u32 {
    return select(first + bit, WHOLE + bit - DISTANCE_BITS, bit >= DISTANCE_BITS);
}

// The same share between the slots, which lie in proportion.
fn slot_share(way: Way) -> f32 {
    if way.before >= WHOLE || way.share <= 0.0 {
        return 0.0;
    }
    return PER_OCTAVE * log2(mix(1.0, slot_m(1u) / slot_m(0u), way.share));
}

// What an image holds where nothing lies before the camera.
fn nothing(image: u32) -> vec4<f32> {
    return vec4<f32>(select(1.0, 0.0, image == RADIANCE));
}

// By how much what a slot holds differs from what follows from the slots beside it, if matter and its light are even between those.
fn bend_of(layer: Layer, cell: vec2<u32>) -> vec3<f32> {
    if layer.slot + 1u >= WHOLE {
        return vec3<f32>(0.0);
    }
    var before = nothing(layer.image);
    var left = vec3<f32>(1.0);
    var before_m = 0.0;
    if layer.slot > 0u {
        before = at_middle(Layer(layer.image, layer.slot - 1u), cell);
        left = at_middle(Layer(TRANSMITTANCE, layer.slot - 1u), cell).rgb;
        before_m = slot_m(layer.slot - 1u);
    }
    let behind = at_middle(Layer(layer.image, layer.slot + 1u), cell);
    let left_behind = at_middle(Layer(TRANSMITTANCE, layer.slot + 1u), cell).rgb;
    let length_share = (slot_m(layer.slot) - before_m) / (slot_m(layer.slot + 1u) - before_m);
    return at_middle(layer, cell).rgb - mix(before.rgb, behind.rgb, share_of_light(left, left_behind, length_share));
}

// What the images are in a pixel up to a slot, and how that bends.
struct Slot {
    values: array<vec4<f32>, IMAGES>,
    bends: array<vec3<f32>, IMAGES>,
}

fn read_slot(place: u32, share: vec2<f32>) -> Slot {
    var slot: Slot;
    for (var image = 0u; image < IMAGES; image++) {
        slot.values[image] = between(patches[place * IMAGES + image], share);
        slot.bends[image] = bends[place * IMAGES + image];
    }
    return slot;
}

struct Filled {
    values: array<vec4<f32>, IMAGES>,
    fails: bool,
}

// What a pixel is between two slots. A slice bends by a quarter of what two do.
fn in_slice(before: Slot, behind: Slot, way: Way) -> Filled {
    let light = share_of_light(before.values[TRANSMITTANCE].rgb, behind.values[TRANSMITTANCE].rgb, way.share);
    let slot_share = slot_share(way);
    var filled = Filled(before.values, false);
    for (var image = 0u; image < IMAGES; image++) {
        let even = mix(before.values[image], behind.values[image], vec4<f32>(light, way.share));
        let bend = mix(before.bends[image], behind.bends[image], slot_share);
        let bent = even.rgb + slot_share * (1.0 - slot_share) * bend;
        filled.values[image] = vec4<f32>(select(bent, vec3<f32>(0.0), bent < vec3<f32>(0.0)), even.a);
        let allowed = allowed_error(image, even).rgb;
        let differs = 0.25 * abs(behind.bends[image] - before.bends[image]) > allowed;
        // Behind the last distance nothing may change.
        let goes_on = way.behind == WHOLE && any(abs(behind.values[image].rgb - before.values[image].rgb) > allowed);
        filled.fails = filled.fails || goes_on || any(differs) || any(0.25 * abs(bend) > STEEPEST * allowed);
    }
    return filled;
}

fn without_first(bits: u32, count: u32) -> u32 {
    var left = bits;
    for (var i = 0u; i < count; i++) {
        left &= left - 1u;
    }
    return left;
}

// What a pixel of the cell is by the slots that its ray ends between; `is_off` if the pixel knows that they will not do. Whether they will
// tells is_rough_here. Several slots are looked at together, an image by each invocation.
fn interpolated(cell: vec2<u32>, within: vec2<u32>, first: u32, range: SlotRange, way: Way, is_off: bool) -> array<vec4<f32>, IMAGES> {
    workgroupBarrier();
    if first == 0u {
        atomicStore(&slots, 0u);
        atomicStore(&is_rough_here, 0u);
    }
    workgroupBarrier();
    atomicOr(&slots, bit_of(way.before, range.first) | bit_of(way.behind, range.first));
    workgroupBarrier();
    let middle = clamp(cell, vec2<u32>(1u), whole_cells(textureDimensions(media_radiance_image)) - 2u);
    let share = vec2<f32>(within) / f32(CELL);
    var before: Slot;
    var behind: Slot;
    for (var image = 0u; image < IMAGES; image++) {
        before.values[image] = nothing(image);
    }
    if is_off || range.end > range.first + DISTANCE_BITS {
        atomicOr(&is_rough_here, 1u);
    }
    var asked = atomicLoad(&slots);
    while asked != 0u {
        let own = without_first(asked, first / IMAGES);
        if first < IMAGES * SLOTS_AT_ONCE && own != 0u {
            let layer = Layer(first % IMAGES, slot_of(firstTrailingBit(own), range.first));
            patches[first] = patch_of(layer, cell, middle);
            bends[first] = bend_of(layer, cell);
            if is_rough(layer, cell, middle, patches[first]) {
                atomicOr(&is_rough_here, 1u);
            }
        }
        workgroupBarrier();
        // Whoever reads on would read for nothing.
        if atomicLoad(&is_rough_here) > 0u {
            break;
        }
        for (var place = 0u; place < SLOTS_AT_ONCE && asked != 0u; place++) {
            let slot = slot_of(firstTrailingBit(asked), range.first);
            asked &= asked - 1u;
            if slot == way.before || slot == way.behind {
                behind = read_slot(place, share);
            }
            if slot == way.before {
                before = behind;
            }
        }
        workgroupBarrier();
    }
    let filled = in_slice(before, behind, way);
    if filled.fails {
        atomicOr(&is_rough_here, 1u);
    }
    workgroupBarrier();
    return filled.values;
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
    if leaves_surface(cell, id.xy) || is_mixed > 0u {
        atomicOr(&is_cut, 1u);
    }
    workgroupBarrier();
    var is_found = false;
    var found: array<vec4<f32>, IMAGES>;
    if atomicLoad(&is_lost) == 0u {
        if atomicLoad(&is_cut) == 0u {
            found = interpolated(cell, id.xy, first, SlotRange(0u, 0u), Way(OWN, OWN, 0.0), false);
            is_found = atomicLoad(&is_rough_here) == 0u;
        }
#ifdef MEDIA_FROXELS
        if !is_found {
            let way = way_of(pixel);
            let reach = textureLoad(surface_cells, cell, 0).xy;
            found = interpolated(cell, id.xy, first, slots_around(reach.x, reach.y), way, is_mixed > 0u && way.behind == WHOLE);
            is_found = atomicLoad(&is_rough_here) == 0u;
        }
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
