#define_import_path welkin::media_froxels
// What media send and leave up to several distances before the camera: froxels of the frustum, at the corners and in the middles of the cells
// that marched media are interpolated over. So edges of what stands before the camera need no march of their own.
//
// Legend
//   slot      a distance, or the whole way behind all that stands there; as what an image of the pixels holds
//   part      of a cell: its corner or its middle
//
// Only slots near what stands before the camera in a cell and the cells around it are kept, and the whole way.
//
// Definitions: MEDIA_FROXELS; MEDIA_CELL; MEDIA_PERMILLE.

#import welkin::attenuation::share_of_opacity
#import welkin::media_lattice::CELL

const DISTANCES: u32 = 40u;
// The slot of the whole way, and what is no froxel but what pixels hold: up to where each one's ray ends.
const WHOLE: u32 = DISTANCES;
const OWN: u32 = DISTANCES + 1u;
// Where there is nothing yet: at the observer.
const NO_SLOT: u32 = DISTANCES + 2u;
// The first distance, m, and how many there are to twice the distance: the last is at 10 km.
const FIRST_M: f32 = 12.0;
const PER_OCTAVE: f32 = 4.0;

const CORNER: u32 = 0u;
const MIDDLE: u32 = 1u;
const PARTS: u32 = 2u;

const RADIANCE: u32 = 0u;
const TRANSMITTANCE: u32 = 1u;
const BEAM: u32 = 2u;
const DIFFUSE: u32 = 3u;
const IMAGES: u32 = 4u;

fn slot_m(slot: u32) -> f32 {
    return FIRST_M * exp2(f32(slot) / PER_OCTAVE);
}

// How many slots lie before a distance.
fn slots_before(distance_m: f32) -> u32 {
    let guess = u32(clamp(ceil(log2(max(distance_m, FIRST_M) / FIRST_M) * PER_OCTAVE), 0.0, f32(DISTANCES)));
    // Rounding may count one too few or too many.
    let fewer = select(guess, guess - 1u, guess > 0u && slot_m(max(guess, 1u) - 1u) >= distance_m);
    return select(fewer, min(fewer + 1u, DISTANCES), slot_m(fewer) < distance_m);
}

// Slots from the first to before the end.
struct SlotRange {
    first: u32,
    end: u32,
}

// The slots between which, and the one before and the one behind which, surfaces from a nearest to a farthest distance lie; none without
// any.
fn slots_around(nearest_m: f32, farthest_m: f32) -> SlotRange {
    if farthest_m < nearest_m {
        return SlotRange(DISTANCES, 0u);
    }
    let first = slots_before(nearest_m);
    return SlotRange(first - min(first, 2u), min(slots_before(farthest_m) + 2u, DISTANCES));
}

// The layer that holds one of the images of a part.
fn froxel_layer(slot: u32, part: u32, image: u32) -> u32 {
    return (slot * PARTS + part) * IMAGES + image;
}

// The part of its cell that a pixel of the lattice is.
fn part_of(pixel: vec2<u32>) -> u32 {
    return select(CORNER, MIDDLE, any(pixel % CELL != vec2<u32>(0u)));
}

// The share of a slice's light that comes from before a share of its length, by the transmittances up to both of its ends.
fn share_of_light(first: vec3<f32>, last: vec3<f32>, length_share: f32) -> vec3<f32> {
    let depth = -log(clamp(last / max(first, vec3<f32>(1e-20)), vec3<f32>(1e-10), vec3<f32>(1.0)));
    return share_of_opacity(depth, length_share);
}
