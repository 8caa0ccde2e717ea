#define_import_path welkin::source_table
// Reading the tabulated source function: for each group of scatterers that share a density profile, ln of the mean of
// radiance over directions that their phase functions weigh: sum_c b_c int p_c I dw' / sum_c b_c.

#import welkin::atmosphere::{atmosphere, CONSTITUENT_SLOTS, PROFILE_GROUP_COUNT, SCATTERER_COUNT}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::march::LocalDirections
#import welkin::source_grid::{
    column_coordinate, row_coordinate, AZIMUTH_COUNT, COSINE_COUNT, TILE_SIZE
}

// Texture coordinates of a place in [0, 1]² within a tile.
fn tile_uv(place: vec2<f32>, tile: vec2<f32>, size: vec2<f32>) -> vec2<f32> {
    return (tile * vec2<f32>(TILE_SIZE) + mapping::inside_tile(place, vec2<f32>(TILE_SIZE)) + 0.5) / size;
}

// The four tiles around a direction, and the weight of each.
struct Corners {
    uv: array<vec2<f32>, 4>,
    weight: array<f32, 4>,
}

fn corners(table_size: vec2<f32>, altitude_m: f32, local: LocalDirections) -> Corners {
    let place = mapping::multiple_scattering_to_unit(altitude_m, local.mu_s, atmosphere.top_m, atmosphere.sun_warp);
    let mu_h = horizon_mu(atmosphere.radius_m, altitude_m);
    let row = row_coordinate(local.mu, mu_h, local.mu_s) - 0.5;
    let rows = vec2<f32>(floor(row), floor(row) + 1.0);
    let share = vec2<f32>(row - rows.x, column_coordinate(local.cos_phi) - 0.5);
    let last = vec2<f32>(f32(AZIMUTH_COUNT - 1u), f32(COSINE_COUNT - 1u));
    var found: Corners;
    for (var i = 0u; i < 2u; i++) {
        // Beyond the zenith or the nadir the grid goes on on the other side.
        let across = rows[i] < 0.0 || rows[i] > last.y;
        let column = select(share.y, f32(AZIMUTH_COUNT) - 1.0 - share.y, across);
        let tile_row = clamp(rows[i], 0.0, last.y);
        let column_low = floor(column);
        let row_weight = select(1.0 - share.x, share.x, i == 1u);
        for (var j = 0u; j < 2u; j++) {
            let tile = vec2<f32>(clamp(column_low + f32(j), 0.0, last.x), tile_row);
            let column_share = column - column_low;
            found.uv[2u * i + j] = tile_uv(place, tile, table_size);
            found.weight[2u * i + j] = row_weight * select(1.0 - column_share, column_share, j == 1u);
        }
    }
    return found;
}

// Radiance sent into the view direction per metre, 1/m per unit irradiance: sum_c b_c int p_c I dw'.
fn tabulated_source(
    table: texture_2d_array<f32>,
    table_sampler: sampler,
    altitude_m: f32,
    local: LocalDirections,
    density_of_each: array<f32, CONSTITUENT_SLOTS>,
) -> vec3<f32> {
    var density = density_of_each;
    var scattering: array<vec3<f32>, PROFILE_GROUP_COUNT>;
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        scattering[atmosphere.constituents[c].profile_group] += density[c] * atmosphere.constituents[c].scattering_per_m;
    }
    var around = corners(vec2<f32>(textureDimensions(table)), altitude_m, local);
    var source = vec3<f32>(0.0);
    for (var g = 0u; g < PROFILE_GROUP_COUNT; g++) {
        var logarithm = vec3<f32>(0.0);
        for (var i = 0u; i < 4u; i++) {
            logarithm += around.weight[i] * textureSampleLevel(table, table_sampler, around.uv[i], g, 0.0).rgb;
        }
        source += scattering[g] * exp(logarithm);
    }
    return source;
}

// Texture coordinates of one of the field's moments, by its tile.
fn moment_uv(tile: u32, table_size: vec2<f32>, altitude_m: f32, mu_s: f32) -> vec2<f32> {
    let place = mapping::multiple_scattering_to_unit(altitude_m, mu_s, atmosphere.top_m, atmosphere.sun_warp);
    return tile_uv(place, vec2<f32>(f32(tile), f32(COSINE_COUNT)), table_size);
}
