#define_import_path welkin::volume_grid
// Grids in which the light of fog and local volumes is kept: blocks of cells, one for each local volume, and for each bank
// of fog several nested ones around the point below the camera, each four times as wide as the one inside it.
//
// Legend
//   block     a cube of VOLUME_CELLS³ texels; blocks lie beside each other in the texture, VOLUME_COLUMNS to a row
//   share     place in a block, [0, 1]³: of a local volume's box, or of the map and of the fog's thickness
//
// Definitions: VOLUME_CELLS, VOLUME_COLUMNS, VOLUME_ROWS, FOG_LEVELS, FOG_CELL_M (of the innermost level), LIGHT_COUNT.

#import welkin::volume_field::{turned, volumes, Place, FOG_COUNT}

const CELLS: u32 = #{VOLUME_CELLS}u;
const COLUMNS: u32 = #{VOLUME_COLUMNS}u;
const ROWS: u32 = #{VOLUME_ROWS}u;
const FOG_LEVELS: u32 = #{FOG_LEVELS}u;

// Half of the width of a level of fog, m.
fn fog_reach_m(level: u32) -> f32 {
    return 0.5 * f32(CELLS) * #{FOG_CELL_M}.0 * f32(1u << (2u * level));
}

// The innermost level that holds a point; beyond all, the last.
fn fog_level(map: vec2<f32>) -> u32 {
    let off_m = max(abs(map.x), abs(map.y));
    var level = 0u;
    while level + 1u < FOG_LEVELS && off_m >= 0.9 * fog_reach_m(level) {
        level += 1u;
    }
    return level;
}

// Where a share of a block lies in the texture, for one of `parts` that lie above each other.
fn block_uvw(block: u32, share: vec3<f32>, part: u32, parts: u32) -> vec3<f32> {
    let inset = clamp(share * f32(CELLS), vec3<f32>(0.5), vec3<f32>(f32(CELLS) - 0.5));
    let first = vec3<f32>(vec3<u32>(block % COLUMNS, block / COLUMNS, part) * CELLS);
    return (first + inset) / vec3<f32>(vec3<u32>(COLUMNS, ROWS, parts) * CELLS);
}

// Slices of fog are thin where it is dense. The first lies on its bottom and the last on its top, where light falls fastest.
fn share_of_height(height: f32) -> f32 {
    return (sqrt(saturate(height)) * f32(CELLS - 1u) + 0.5) / f32(CELLS);
}

fn height_of_share(share: f32) -> f32 {
    let up = saturate((share * f32(CELLS) - 0.5) / f32(CELLS - 1u));
    return up * up;
}

// A point in the block that holds it.
struct Spot {
    block: u32,
    share: vec3<f32>,
}

fn spot_of(index: u32, place: Place) -> Spot {
    if index < FOG_COUNT {
        let level = fog_level(place.map);
        let height = (place.altitude_m - volumes[index].bottom_m) / (volumes[index].top_m - volumes[index].bottom_m);
        let share = vec3<f32>(0.5 + 0.5 * place.map / fog_reach_m(level), share_of_height(height));
        return Spot(volumes[index].first_block + level, share);
    }
    let q = turned(index, place.p - volumes[index].centre_m) / volumes[index].half_size_m;
    return Spot(volumes[index].first_block, 0.5 + 0.5 * q);
}

// The point in the middle of a cell of a volume's block.
fn place_in_block(index: u32, level: u32, share: vec3<f32>) -> Place {
    var place: Place;
    if index < FOG_COUNT {
        place.map = (2.0 * share.xy - 1.0) * fog_reach_m(level);
        place.altitude_m = mix(volumes[index].bottom_m, volumes[index].top_m, height_of_share(share.z));
        place.p = vec3<f32>(place.map, place.altitude_m);
        return place;
    }
    let q = (2.0 * share - 1.0) * volumes[index].half_size_m;
    let turn = volumes[index].turn;
    place.p = volumes[index].centre_m + vec3<f32>(q.x * turn.x + q.y * turn.y, q.y * turn.x - q.x * turn.y, q.z);
    return place;
}
