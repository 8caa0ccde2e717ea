#define_import_path welkin::ordinates_grid
// The boxes of cells in which the light in clouds is solved by discrete ordinates, and how they lie in textures.
//
// Legend
//   place         (x, y) of the clouds' map and altitude, m: the grid bends with the planet
//   level         a box of cells; 0 is the finest, every other one contains the one before it. All span the same
//                 altitudes and have equally many cells across; the cells of the next level are larger
//   cell          of the solution; `fine` texels are ORDINATES_REFINEMENT times smaller along each axis
//   slice         all levels lie in one 3D texture, one above the other along its third axis
//   c', b', g'    extinction, scattering and mean cosine of the similar medium in which the share f of scattered light
//                 (the phase function's second Legendre moment) counts as unscattered (Joseph, Wiscombe & Weinman 1976)
//
// Definitions
//   ORDINATES_LEVEL_COUNT   levels, at least 1
//   ORDINATES_REFINEMENT    fine texels along a cell's edge, at least 1
//   ORDINATES_PERIODIC      the outermost level repeats itself to all sides; without it, clear air is around it

const LEVEL_COUNT: u32 = #{ORDINATES_LEVEL_COUNT}u;
const REFINEMENT: u32 = #{ORDINATES_REFINEMENT}u;

struct Level {
    // Lowest corner.
    lowest_m: vec3<f32>,
    // Slice of the level's lowest cells; times REFINEMENT in fine textures.
    first_slice: u32,
    cell_m: vec3<f32>,
    // Number of the level's first cell among all cells.
    first_cell: u32,
    // Cells along x, y and altitude.
    size: vec3<u32>,
    padding: u32,
}

struct Ordinates {
    // Unit vector.
    toward_sun: vec3<f32>,
    // b' / c'.
    albedo: f32,
    // g'.
    reduced_cosine: f32,
    // Albedo of the ground, for light that comes back up.
    ground_albedo: f32,
    // a of ordinates_light.wgsl.
    falloff: f32,
    padding: f32,
    levels: array<Level, LEVEL_COUNT>,
}

@group(2) @binding(0) var<storage, read> ordinates: Ordinates;

fn highest_m(level: u32) -> vec3<f32> {
    let box = ordinates.levels[level];
    return box.lowest_m + vec3<f32>(box.size) * box.cell_m;
}

// The finest level that holds a place, or LEVEL_COUNT.
fn level_of(place_m: vec3<f32>) -> u32 {
    for (var level = 0u; level < LEVEL_COUNT; level++) {
        let inside = (place_m >= ordinates.levels[level].lowest_m) & (place_m <= highest_m(level));
#ifdef ORDINATES_PERIODIC
        if all(inside) || (level + 1u == LEVEL_COUNT && inside.z) {
            return level;
        }
#else
        if all(inside) {
            return level;
        }
#endif
    }
    return LEVEL_COUNT;
}

// Where a place lies in a level, in cells from its lowest corner; within the level's box.
fn cells_from_corner(place_m: vec3<f32>, level: u32) -> vec3<f32> {
    let box = ordinates.levels[level];
    let size = vec3<f32>(box.size);
    var cells = (place_m - box.lowest_m) / box.cell_m;
#ifdef ORDINATES_PERIODIC
    if level + 1u == LEVEL_COUNT {
        cells = vec3<f32>(cells.xy - size.xy * floor(cells.xy / size.xy), cells.z);
    }
#endif
    return clamp(cells, vec3<f32>(0.0), size);
}

// Texture coordinates of a place, for a texture of so many texels along a cell's edge. Half a texel is kept from the
// neighbouring levels' slices.
fn coordinates(place_m: vec3<f32>, level: u32, texture_size: vec3<f32>, texels_per_cell: f32) -> vec3<f32> {
    let box = ordinates.levels[level];
    let texels = cells_from_corner(place_m, level) * texels_per_cell;
    let height = f32(box.size.z) * texels_per_cell;
    let z = clamp(texels.z, 0.5, height - 0.5) + f32(box.first_slice) * texels_per_cell;
    return vec3<f32>(texels.xy, z) / texture_size;
}

// What a texel's light counts for between the centres of texels: light is scattered where there is cloud, and clear air
// beside a bright edge must not darken it. In hundredths of 1/m, which half floats hold well, and a little everywhere.
fn weight_of(extinction_per_m: f32) -> f32 {
    return 100.0 * extinction_per_m + 1e-3;
}
