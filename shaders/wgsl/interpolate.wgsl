// Pass: linear radiance of every pixel, interpolated between the corners of its cell of the lattice with the bend that the
// centres show; and a list of the cells in which that is not enough, whose pixels `compose` evaluates one by one.
//
// Definitions: LATTICE_PPM, millionths by which interpolation may err; WHOLE_CELLS (an invocation fills all of a cell and
// not a column: fewer reads of the lattice, for devices of few invocations); LATTICE_TRANSMITTANCE (transmittance matters).

#import welkin::camera::{view_direction, view_through}
#import welkin::lattice::{
    cell_kind, centre_node, corner_node, entry_of_cell, CELL, CELL_TOTAL, LIST_HEADER, MIXED_CELL, MOST_GROUPS
}
#import welkin::pixel::{put, radiance_image, seen_through_clouds, singly_scattered}
#ifdef SURFACE
#import welkin::pixel::{surface_image, NO_SURFACE_M}
#endif
#import welkin::smooth_sky::{mixed, SmoothSky}

@group(0) @binding(20) var sky_lattice: texture_2d_array<f32>;
// For an indirect dispatch: workgroups along three axes. Then the number of cells, and each.
@group(0) @binding(21) var<storage, read_write> exact_cells: array<atomic<u32>>;

#ifdef WHOLE_CELLS
const COLUMNS: u32 = CELL;
#else
const COLUMNS: u32 = 1u;
#endif
const TOLERANCE: f32 = #{LATTICE_PPM}.0 * 1e-6;

// All light of a node without clouds.
fn clear_radiance(view: vec3<f32>, sky: SmoothSky) -> vec3<f32> {
    return singly_scattered(view, sky) + sky.diffuse + sky.ground_straight + sky.ground_diffuse + sky.glow;
}

struct Corners {
    upper_left: SmoothSky,
    lower_left: SmoothSky,
    upper_right: SmoothSky,
    lower_right: SmoothSky,
}

fn corners_of(cell: vec2<u32>) -> Corners {
    return Corners(
        corner_node(sky_lattice, cell),
        corner_node(sky_lattice, cell + vec2<u32>(0u, 1u)),
        corner_node(sky_lattice, cell + vec2<u32>(1u, 0u)),
        corner_node(sky_lattice, cell + vec2<u32>(1u, 1u)),
    );
}

// What a parabola through the cell adds to the light between its corners: at the centre, of its bend along rows and along
// columns.
struct Bend {
    along_row: vec3<f32>,
    along_column: vec3<f32>,
    // Whether what is left is below the tolerance.
    is_slight: bool,
}

// What the parabola leaves over what it mends: of third differences, a cell's side from the horizon, half at most. A kink of
// the tables between two nodes may leave all of it, twice the tolerance.
const RESIDUE: f32 = 0.5;

fn bend_of(cell: vec2<u32>, corners: Corners) -> Bend {
    let view = view_through(f32(CELL) * (vec2<f32>(cell) + 0.5));
    let centre = centre_node(sky_lattice, cell);
    // The picture's first column has no neighbour to its left; its last has one that lies outside the picture.
    let middle = vec2<u32>(max(cell.x, 1u), cell.y);
    let left = centre_node(sky_lattice, middle - vec2<u32>(1u, 0u));
    let right = centre_node(sky_lattice, middle + vec2<u32>(1u, 0u));
    let between = centre_node(sky_lattice, middle);
    let mean = mixed(
        mixed(corners.upper_left, corners.lower_left, 0.5), mixed(corners.upper_right, corners.lower_right, 0.5), 0.5
    );
    let radiance = clear_radiance(view, centre);
    let outer = clear_radiance(view, left) + clear_radiance(view, right);
    var bend: Bend;
    bend.along_row = 0.125 * (2.0 * clear_radiance(view, between) - outer);
    bend.along_column = radiance - clear_radiance(view, mean) - bend.along_row;
    bend.is_slight = all(RESIDUE * (abs(bend.along_row) + abs(bend.along_column)) <= TOLERANCE * radiance);
#ifdef LATTICE_TRANSMITTANCE
    let row = 0.125 * (left.transmittance + right.transmittance - 2.0 * between.transmittance);
    let both = mean.transmittance - centre.transmittance;
    bend.is_slight = bend.is_slight && all(abs(row) + abs(both - row) <= TOLERANCE * centre.transmittance);
#endif
    return bend;
}

fn list(cell: vec2<u32>) {
    let entry = atomicAdd(&exact_cells[CELL_TOTAL], 1u);
    atomicStore(&exact_cells[LIST_HEADER + entry], entry_of_cell(cell));
    atomicMax(&exact_cells[0], min(entry + 1u, MOST_GROUPS));
    atomicMax(&exact_cells[1], 1u);
    atomicMax(&exact_cells[2], 1u);
}

// Whether something stands before the sky in a cell.
fn holds_surface(cell: vec2<u32>, size: vec2<u32>) -> bool {
    var nearest_m = 1e38;
#ifdef SURFACE
    for (var i = 0u; i < CELL * CELL; i++) {
        let pixel = min(CELL * cell + vec2<u32>(i % CELL, i / CELL), size - 1u);
        nearest_m = min(nearest_m, textureLoad(surface_image, pixel, 0).a);
    }
    return nearest_m < NO_SURFACE_M;
#else
    return false;
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(radiance_image);
    let first = id.xy * vec2<u32>(COLUMNS, CELL);
    if any(first >= size) {
        return;
    }
    let cell = first / CELL;
    let corners = corners_of(cell);
    let bend = bend_of(cell, corners);
    if first.x % CELL == 0u {
        let mixes = cell_kind(sky_lattice, cell) == MIXED_CELL || holds_surface(cell, size);
        if mixes || !bend.is_slight {
            list(cell);
        }
    }
    // The tests of loops stand at their end: see `compose`.
    var row = first.y;
    loop {
        let down = (f32(row - first.y) + 0.5) / f32(CELL);
        let left = mixed(corners.upper_left, corners.lower_left, down);
        let right = mixed(corners.upper_right, corners.lower_right, down);
        let bent_down = 4.0 * down * (1.0 - down) * bend.along_column;
        var column = first.x;
        loop {
            let pixel = vec2<u32>(column, row);
            let across = (f32(column % CELL) + 0.5) / f32(CELL);
            let view = view_direction(pixel);
            var sky = mixed(left, right, across);
            sky.diffuse += bent_down + 4.0 * across * (1.0 - across) * bend.along_row;
            put(pixel, view, seen_through_clouds(pixel, view, sky));
            continuing {
                column += 1u;
                break if column >= min(first.x + COLUMNS, size.x);
            }
        }
        continuing {
            row += 1u;
            break if row >= min(first.y + CELL, size.y);
        }
    }
}
