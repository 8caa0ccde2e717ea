// Pass: linear radiance of every pixel, interpolated between the corners of its cell of the lattice with the bend that the
// centres show; and a list of the cells in which that is not enough, whose pixels `compose` evaluates one by one.
//
// Towards the horizon light bends far more from row to row than along a row. Where an invocation fills all of a cell, it evaluates
// both ends of each row there and interpolates between them alone.
//
// Definitions: LATTICE_PPM, millionths by which interpolation may err, at most; WHOLE_CELLS (an invocation fills all of a cell and
// not a column: fewer reads of the lattice, for devices of few invocations); LATTICE_TRANSMITTANCE (transmittance matters).

#import welkin::camera::{view_direction, view_through}
#import welkin::cell_kind::{GROUND_CELL, MIXED_CELL}
#import welkin::cell_list::{entry_of_cell, CELL_TOTAL, LIST_HEADER, MOST_GROUPS}
#import welkin::lattice::{cell_kind, centre_node, corner_node, CELL}
#ifdef WHOLE_CELLS
#import welkin::loops::counted
#endif
#import welkin::pixel::{put, radiance_image, seen_through_clouds, singly_scattered}
#ifdef SURFACE
#import welkin::pixel::{surface_image, NO_SURFACE_M}
#endif
#import welkin::smooth_sky::{mixed, SmoothSky}
#ifdef WHOLE_CELLS
#import welkin::smooth_sky::smooth_sky
#endif

@group(0) @binding(20) var sky_lattice: texture_2d_array<f32>;
// For an indirect dispatch: workgroups along three axes. Then the number of cells, and each.
@group(0) @binding(21) var<storage, read_write> exact_cells: array<atomic<u32>>;

#ifdef WHOLE_CELLS
const COLUMNS: u32 = CELL;
// Cells side by side: their pixels lie on few pages of memory, along which a processor can fetch ahead of the writes.
const GROUP_SIZE = vec2<u32>(32u, 1u);
#else
const COLUMNS: u32 = 1u;
const GROUP_SIZE = vec2<u32>(8u, 8u);
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
}

// Second differences of the light of three nodes in a row, as a parabola's height over the chord between two that are as
// far apart as these.
fn height_of(view: vec3<f32>, before: SmoothSky, middle: SmoothSky, after: SmoothSky) -> vec3<f32> {
    let outer = clear_radiance(view, before) + clear_radiance(view, after);
    return 0.125 * (2.0 * clear_radiance(view, middle) - outer);
}

// The cell in whose line neighbours on both sides exist: the picture's first has none before it, its last has one that
// lies outside the picture.
fn with_neighbours(cell: vec2<u32>) -> vec2<u32> {
    return max(cell, vec2<u32>(1u));
}

fn bend_of(view: vec3<f32>, cell: vec2<u32>, corners: Corners) -> Bend {
    let middle = vec2<u32>(with_neighbours(cell).x, cell.y);
    let mean = mixed(
        mixed(corners.upper_left, corners.lower_left, 0.5), mixed(corners.upper_right, corners.lower_right, 0.5), 0.5
    );
    var bend: Bend;
    bend.along_row = height_of(
        view,
        centre_node(sky_lattice, middle - vec2<u32>(1u, 0u)),
        centre_node(sky_lattice, middle),
        centre_node(sky_lattice, middle + vec2<u32>(1u, 0u)),
    );
    let centre = centre_node(sky_lattice, cell);
    bend.along_column = clear_radiance(view, centre) - clear_radiance(view, mean) - bend.along_row;
    return bend;
}

// What the parabola leaves over its own height, at most. Where light is smooth that is of third differences, a half in the
// first cells above the horizon. A kink, as tables have from row to row, leaves more: wherever it lies in a cell, up to 1.26
// of the height that three centres in a row show, and up to 1.11 of the larger of that and the cell's own.
const RESIDUE: f32 = 1.26;

// Whether it leaves less than the tolerance along every row, also along those of which least light comes.
fn is_slight_along_rows(view: vec3<f32>, corners: Corners, bend: Bend) -> bool {
    let least = min(
        min(clear_radiance(view, corners.upper_left), clear_radiance(view, corners.lower_left)),
        min(clear_radiance(view, corners.upper_right), clear_radiance(view, corners.lower_right)),
    );
    // Not where rows lead from the air into space.
    return all(least > vec3<f32>(0.0)) && all(RESIDUE * abs(bend.along_row) <= TOLERANCE * least);
}

// Whether it does in all of the cell.
fn is_slight(view: vec3<f32>, cell: vec2<u32>, bend: Bend) -> bool {
    let middle = vec2<u32>(cell.x, with_neighbours(cell).y);
    let above = middle - vec2<u32>(0u, 1u);
    let below = middle + vec2<u32>(0u, 1u);
    let kind = cell_kind(sky_lattice, cell);
    if any(vec2<f32>(cell_kind(sky_lattice, above), cell_kind(sky_lattice, below)) != vec2<f32>(kind)) {
        return false;
    }
    let column = height_of(
        view, centre_node(sky_lattice, above), centre_node(sky_lattice, middle), centre_node(sky_lattice, below)
    );
    let height = abs(bend.along_row) + max(abs(bend.along_column), abs(column));
    let centre = centre_node(sky_lattice, cell);
    return all(RESIDUE * height <= TOLERANCE * clear_radiance(view, centre));
}

// By how much transmittance, which has no parabola, bends along a row.
fn transmittance_along_row(cell: vec2<u32>) -> vec3<f32> {
    let middle = vec2<u32>(with_neighbours(cell).x, cell.y);
    let left = centre_node(sky_lattice, middle - vec2<u32>(1u, 0u)).transmittance;
    let right = centre_node(sky_lattice, middle + vec2<u32>(1u, 0u)).transmittance;
    return 0.125 * (2.0 * centre_node(sky_lattice, middle).transmittance - left - right);
}

// A kink leaves up to twice the height that the centre shows.
fn is_straight(cell: vec2<u32>, height: vec3<f32>) -> bool {
    return all(2.0 * height <= TOLERANCE * centre_node(sky_lattice, cell).transmittance);
}

fn transmittance_is_straight_along_rows(cell: vec2<u32>) -> bool {
#ifdef LATTICE_TRANSMITTANCE
    return is_straight(cell, abs(transmittance_along_row(cell)));
#else
    return true;
#endif
}

fn transmittance_is_straight(cell: vec2<u32>, corners: Corners) -> bool {
#ifdef LATTICE_TRANSMITTANCE
    let along_row = transmittance_along_row(cell);
    let mean = 0.25 * (
        corners.upper_left.transmittance + corners.lower_left.transmittance + corners.upper_right.transmittance
            + corners.lower_right.transmittance
    );
    let centre = centre_node(sky_lattice, cell).transmittance;
    return is_straight(cell, abs(along_row) + abs(centre - mean - along_row));
#else
    return true;
#endif
}

#ifdef WHOLE_CELLS
// Both ends of a row of a cell's pixels, each evaluated for itself.
struct Ends {
    left: SmoothSky,
    right: SmoothSky,
}

fn ends_of_row(cell: vec2<u32>, row: u32) -> Ends {
    let below_horizon = cell_kind(sky_lattice, cell) == GROUND_CELL;
    var ends: Ends;
    for (var side = 0u; side < counted(2u); side++) {
        let view = view_through(vec2<f32>(f32(CELL * (cell.x + side)), f32(row) + 0.5));
        let sky = smooth_sky(view, atan2(length(view.xy), view.z), below_horizon);
        if side == 0u {
            ends.left = sky;
        } else {
            ends.right = sky;
        }
    }
    return ends;
}
#endif

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

@compute @workgroup_size(GROUP_SIZE.x, GROUP_SIZE.y)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(radiance_image);
    let first = id.xy * vec2<u32>(COLUMNS, CELL);
    if any(first >= size) {
        return;
    }
    let cell = first / CELL;
    let corners = corners_of(cell);
    let middle_view = view_through(f32(CELL) * (vec2<f32>(cell) + 0.5));
    let bend = bend_of(middle_view, cell, corners);
    var row_by_row = false;
    if first.x % CELL == 0u {
        let mixes = cell_kind(sky_lattice, cell) == MIXED_CELL || holds_surface(cell, size);
        let slight = is_slight(middle_view, cell, bend) && transmittance_is_straight(cell, corners);
#ifdef WHOLE_CELLS
        row_by_row = !slight && is_slight_along_rows(middle_view, corners, bend) && transmittance_is_straight_along_rows(cell);
#endif
        if mixes || !(slight || row_by_row) {
            list(cell);
#ifdef WHOLE_CELLS
            // `compose` writes all of its pixels.
            return;
#endif
        }
    }
    // The tests of loops stand at their end: see `compose`.
    var row = first.y;
    loop {
        let down = (f32(row - first.y) + 0.5) / f32(CELL);
        var left = mixed(corners.upper_left, corners.lower_left, down);
        var right = mixed(corners.upper_right, corners.lower_right, down);
        var bent_down = 4.0 * down * (1.0 - down) * bend.along_column;
#ifdef WHOLE_CELLS
        for (var i = 0u; i < 1u && row_by_row; i++) {
            let ends = ends_of_row(cell, row);
            left = ends.left;
            right = ends.right;
            bent_down = vec3<f32>(0.0);
        }
#endif
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
