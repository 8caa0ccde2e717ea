#define_import_path welkin::source_grid
// The directions in which the source function is tabulated at each (altitude, mu_s), and where they lie in the table.
//
// Zenith angles are cut at the horizon, where radiance has a kink, and at the light, around which there is a glow:
// ground, low sky, high sky. So both stay where they are on the grid while altitude and mu_s change, and interpolation
// between texels does not blur them. Within each part, and on half a turn of azimuth, nodes crowd at both ends:
// sin²(pi y / 2) of the midpoints of equal parts of y, with Fejer's weights.
//
// The table is one picture of tiles: each tile has all mu_s (x) and altitudes (y) of one direction; tiles stand in a row
// by azimuth, and rows of tiles follow each other by zenith angle, nadir first. One row more holds the radiance field's
// moments in its first tiles, and is as long as they need: ln of its irradiance from above, ln of its mean, and I_lm / I_00 up
// to degree 2.
//
// Definitions: GRID_GROUND_COUNT, GRID_LOW_COUNT, GRID_HIGH_COUNT (cosines in each part), GRID_AZIMUTH_COUNT;
// GRID_MU_S_COUNT, GRID_ALTITUDE_COUNT (texels of a tile)

#import welkin::geometry::precise_acos
#import welkin::march::GaussNode

const PI: f32 = 3.14159265358979;
const GROUND_COUNT: u32 = #{GRID_GROUND_COUNT}u;
const LOW_COUNT: u32 = #{GRID_LOW_COUNT}u;
const HIGH_COUNT: u32 = #{GRID_HIGH_COUNT}u;
const AZIMUTH_COUNT: u32 = #{GRID_AZIMUTH_COUNT}u;
const COSINE_COUNT: u32 = GROUND_COUNT + LOW_COUNT + HIGH_COUNT;
const DIRECTION_COUNT: u32 = COSINE_COUNT * AZIMUTH_COUNT;
const TILE_SIZE: vec2<u32> = vec2<u32>(#{GRID_MU_S_COUNT}u, #{GRID_ALTITUDE_COUNT}u);
// The low sky spans at least this much of mu above the horizon, however low the light.
const LEAST_LOW_SKY: f32 = 0.1;

// Nodes on [0, 1] of the three parts, then of half a turn.
@group(0) @binding(2) var<uniform> grid_nodes: array<GaussNode, COSINE_COUNT + AZIMUTH_COUNT>;

struct GridDirection {
    mu: f32,
    phi_rad: f32,
    // What the direction stands for, both of its mirror images counted, sr.
    solid_angle_sr: f32,
    hits_ground: bool,
}

// Where the low sky ends and the high sky begins.
fn split_mu(horizon_mu: f32, mu_s: f32) -> f32 {
    return clamp(mu_s, horizon_mu + LEAST_LOW_SKY, 1.0);
}

// A part of the sphere between two cosines, and the rows of directions in it.
struct GridPart {
    low_mu: f32,
    high_mu: f32,
    first_row: u32,
    row_count: u32,
}

fn part_of(row: u32, horizon_mu: f32, mu_s: f32) -> GridPart {
    let split = split_mu(horizon_mu, mu_s);
    if row < GROUND_COUNT {
        return GridPart(-1.0, horizon_mu, 0u, GROUND_COUNT);
    }
    if row < GROUND_COUNT + LOW_COUNT {
        return GridPart(horizon_mu, split, GROUND_COUNT, LOW_COUNT);
    }
    return GridPart(split, 1.0, GROUND_COUNT + LOW_COUNT, HIGH_COUNT);
}

fn direction_of(index: u32, horizon_mu: f32, mu_s: f32) -> GridDirection {
    let row = index / AZIMUTH_COUNT;
    let node = grid_nodes[row];
    let azimuth = grid_nodes[COSINE_COUNT + index % AZIMUTH_COUNT];
    let part = part_of(row, horizon_mu, mu_s);
    var direction: GridDirection;
    direction.hits_ground = row < GROUND_COUNT;
    direction.mu = mix(part.low_mu, part.high_mu, node.abscissa);
    direction.phi_rad = PI * azimuth.abscissa;
    direction.solid_angle_sr = (part.high_mu - part.low_mu) * node.weight * 2.0 * PI * azimuth.weight;
    return direction;
}

// Where a share of a cell lies in [0, 1] of its part, of so many cells, and what a unit of the share stands for there.
fn in_cell(cell: u32, share: f32, cell_count: u32) -> vec2<f32> {
    let angle_rad = PI * (f32(cell) + share) / f32(cell_count);
    let sine = sin(0.5 * angle_rad);
    return vec2<f32>(sine * sine, 0.5 * PI / f32(cell_count) * sin(angle_rad));
}

// One of many directions that fill the cell around a direction of the grid, by its shares of the cell's height and
// width in ]0, 1[; its solid angle is per unit of both shares.
fn direction_in_cell(index: u32, shares: vec2<f32>, horizon_mu: f32, mu_s: f32) -> GridDirection {
    let row = index / AZIMUTH_COUNT;
    let part = part_of(row, horizon_mu, mu_s);
    let height = in_cell(row - part.first_row, shares.x, part.row_count);
    let width = in_cell(index % AZIMUTH_COUNT, shares.y, AZIMUTH_COUNT);
    var direction: GridDirection;
    direction.hits_ground = row < GROUND_COUNT;
    direction.mu = mix(part.low_mu, part.high_mu, height.x);
    direction.phi_rad = PI * width.x;
    direction.solid_angle_sr = (part.high_mu - part.low_mu) * height.y * 2.0 * PI * width.y;
    return direction;
}

// The inverse of sin²(pi y / 2) on [0, 1].
fn even(x: f32) -> f32 {
    return 1.0 - precise_acos(sqrt(clamp(x, 0.0, 1.0))) * 2.0 / PI;
}

// Row of tiles of a direction, counted in tiles; nodes lie at halves.
fn row_coordinate(mu: f32, horizon_mu: f32, mu_s: f32) -> f32 {
    let split = split_mu(horizon_mu, mu_s);
    if mu < horizon_mu {
        return f32(GROUND_COUNT) * even((mu + 1.0) / (horizon_mu + 1.0));
    }
    if mu < split {
        return f32(GROUND_COUNT) + f32(LOW_COUNT) * even((mu - horizon_mu) / (split - horizon_mu));
    }
    return f32(GROUND_COUNT + LOW_COUNT) + f32(HIGH_COUNT) * even((mu - split) / max(1.0 - split, 1e-6));
}

// Column of tiles of an azimuth, counted in tiles; nodes lie at halves.
fn column_coordinate(cos_phi: f32) -> f32 {
    return f32(AZIMUTH_COUNT) * even(precise_acos(clamp(cos_phi, -1.0, 1.0)) / PI);
}

// The texel of a direction at a place of every tile.
fn texel_of(direction: u32, place: vec2<u32>) -> vec2<u32> {
    return place + TILE_SIZE * vec2<u32>(direction % AZIMUTH_COUNT, direction / AZIMUTH_COUNT);
}

// Which tile of the last row holds what of the field.
const IRRADIANCE_TILE: u32 = 0u;
const MEAN_TILE: u32 = 1u;
// I_k / I_00 for k = 1 to 5 lie in the tiles from here on: spherical harmonics of degrees 1 and 2.
const FIRST_HARMONIC_TILE: u32 = 2u;
const HARMONIC_COUNT: u32 = 5u;

// The texel of one of them at a place of every tile.
fn moment_texel(tile: u32, place: vec2<u32>) -> vec2<u32> {
    return place + TILE_SIZE * vec2<u32>(tile, COSINE_COUNT);
}
