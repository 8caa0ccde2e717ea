#define_import_path welkin::media_slices
// Pixels of a cell between two slots of the froxels before it, which a workgroup fills together.
//
// Up to each slot what media send and leave is a parabola over the cell (welkin::media_patch). Between two of them matter and its light are
// taken as even, but for a bend that the slots beside them tell.
//
// Definitions: MEDIA_CELL; MEDIA_FROXELS.

#import welkin::media_froxels::{
    share_of_light, slot_m, slots_around, slots_before, SlotRange, DISTANCES, IMAGES, NO_SLOT, PER_OCTAVE, RADIANCE, TRANSMITTANCE,
    WHOLE,
}
#import welkin::media_lattice::CELL
#import welkin::media_march::{ray_of, NEVER_M}
#import welkin::media_patch::{allowed_error, at_middle, between, is_rough, patch_of, Layer, Patch, STEEPEST}

@group(1) @binding(56) var surface_cells: texture_2d<f32>;

// Of the slots that are looked at together, each image over the cell, and how it bends from slot to slot.
const SLOTS_AT_ONCE: u32 = 4u;
var<workgroup> slot_patches: array<Patch, SLOTS_AT_ONCE * IMAGES>;
var<workgroup> slot_bends: array<vec3<f32>, SLOTS_AT_ONCE * IMAGES>;
// Bits of the slots that pixels of the cell lie between.
var<workgroup> slots: atomic<u32>;
// Whether some pixel cannot be filled from them.
var<workgroup> is_uneven: atomic<u32>;

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
        slot.values[image] = between(slot_patches[place * IMAGES + image], share);
        slot.bends[image] = slot_bends[place * IMAGES + image];
    }
    return slot;
}

// The images in a pixel, and whether they will not do.
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

// What the pixels of a cell are by the slots that their rays end between: a pixel's images, and whether those of all the cell's pixels will
// do. The whole way is of no use where `is_mixed`. Several slots are looked at together, an image by each invocation.
fn in_slices(cell: vec2<u32>, middle: vec2<u32>, pixel: vec2<u32>, first: u32, is_mixed: bool) -> Filled {
    let reach = textureLoad(surface_cells, cell, 0).xy;
    let range = slots_around(reach.x, reach.y);
    let way = way_of(pixel);
    workgroupBarrier();
    if first == 0u {
        atomicStore(&slots, 0u);
        atomicStore(&is_uneven, 0u);
    }
    workgroupBarrier();
    atomicOr(&slots, bit_of(way.before, range.first) | bit_of(way.behind, range.first));
    workgroupBarrier();
    let share = vec2<f32>(pixel % CELL) / f32(CELL);
    var before: Slot;
    var behind: Slot;
    for (var image = 0u; image < IMAGES; image++) {
        before.values[image] = nothing(image);
    }
    if (is_mixed && way.behind == WHOLE) || range.end > range.first + DISTANCE_BITS {
        atomicOr(&is_uneven, 1u);
    }
    var asked = atomicLoad(&slots);
    while asked != 0u {
        let own = without_first(asked, first / IMAGES);
        if first < IMAGES * SLOTS_AT_ONCE && own != 0u {
            let layer = Layer(first % IMAGES, slot_of(firstTrailingBit(own), range.first));
            slot_patches[first] = patch_of(layer, cell, middle);
            slot_bends[first] = bend_of(layer, cell);
            if is_rough(layer, cell, middle, slot_patches[first]) {
                atomicOr(&is_uneven, 1u);
            }
        }
        workgroupBarrier();
        // Whoever reads on would read for nothing.
        if atomicLoad(&is_uneven) > 0u {
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
    var filled = in_slice(before, behind, way);
    if filled.fails {
        atomicOr(&is_uneven, 1u);
    }
    workgroupBarrier();
    filled.fails = atomicLoad(&is_uneven) > 0u;
    return filled;
}
