#define_import_path welkin::cluster
// Clusters: tiles of pixels cut into slices of distance, each with the local volumes and lights that may matter in it, as
// bits (Olsson, Billeter & Assarsson 2012). Words of bits: volumes without fog, lights, and of these the ones that are so near
// that froxels do not hold their light.
//
// Definitions: VOLUME_COUNT, FOG_COUNT, LOCAL_LIGHT_COUNT, CLUSTER_COLUMNS, LAMP_FROXELS.

const TILE: u32 = 16u;
const COLUMNS: u32 = #{CLUSTER_COLUMNS}u;
const SLICES: u32 = 24u;
// Where the first slice ends, and by what factor the next ends are farther: the last of them at 45 km.
const NEAR_M: f32 = 4.0;
const LOG_RATIO: f32 = 0.5849625;
const VOLUME_WORDS: u32 = (#{VOLUME_COUNT}u - #{FOG_COUNT}u + 31u) / 32u;
const LIGHT_WORDS: u32 = (#{LOCAL_LIGHT_COUNT}u + 31u) / 32u;
#ifdef LAMP_FROXELS
const NEAR_WORDS: u32 = LIGHT_WORDS;
#else
const NEAR_WORDS: u32 = 0u;
#endif
// WGSL has no empty arrays.
const WORDS: u32 = max(VOLUME_WORDS + LIGHT_WORDS + NEAR_WORDS, 1u);

fn slice_of(distance_m: f32) -> u32 {
    let beyond = log2(max(distance_m, 0.5 * NEAR_M) / NEAR_M) / LOG_RATIO;
    return u32(clamp(floor(beyond) + 1.0, 0.0, f32(SLICES - 1u)));
}

// Where a slice begins, m.
fn slice_start_m(slice: u32) -> f32 {
    return select(NEAR_M * exp2((f32(slice) - 1.0) * LOG_RATIO), 0.0, slice == 0u);
}

// Where a slice ends, m; the last one does not.
fn slice_end_m(slice: u32) -> f32 {
    return select(NEAR_M * exp2(f32(slice) * LOG_RATIO), 1e30, slice + 1u >= SLICES);
}

// The first slice that ends beyond a distance: rounding may still count an end to the slice before it.
fn slice_beyond(distance_m: f32) -> u32 {
    let slice = slice_of(distance_m);
    return select(slice + 1u, slice, slice_end_m(slice) > distance_m);
}

// The first word of a cluster.
fn cluster_of(pixel: vec2<u32>, slice: u32) -> u32 {
    let tile = pixel / TILE;
    return ((tile.y * COLUMNS + tile.x) * SLICES + slice) * WORDS;
}
