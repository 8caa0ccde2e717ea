// Pass: one half of a red-black relaxation of the light in clouds: discrete ordinates on a grid of cells.
//
// One invocation a cell of one colour (parity of x + y + z), so that every upwind neighbour is of the other colour and
// the field is updated in place. Within the cell the scattered light is solved for exactly: all directions of a ring
// lose light alike, so that mean and flux of the field follow from two divisions and no iteration is needed where a cell
// is opaque. First-order upwind differences, so nothing becomes negative that its sources do not make so, void cells
// just stream, and what leaves one cell enters the next.
//
//   (sum_a |w_a|/h_a + c') psi_d = sum_a |w_a|/h_a psi_d(upwind_a) + b' (I0 + g' w_d . I1) + Q (1 - 3 g' w_d . s)
//   I0 = sum_d weight_d psi_d,   I1 = 3 sum_d weight_d w_d psi_d
//
// Legend
//   psi      radiance that travels along w_d; .x of the sun per unit irradiance, 1/sr, .y of a sky of radiance 1
//   c', b'   extinction and scattering of the similar medium with asymmetry g', 1/m
//   Q        the sun's light that is scattered for the first time, 1/m/sr; s points to the sun
//
// Definitions: those of welkin::ordinates_grid and welkin::ordinates_directions; START: the field of the next level (or
// darkness) is taken as a first guess, both colours at once.

#import welkin::ordinates_grid::{
    ordinates, cells_from_corner, Level, LEVEL_COUNT, REFINEMENT,
}
#import welkin::ordinates_directions::{octant_signs, ring_components, ring_weight, DIRECTION_COUNT, RING_COUNT}

const PI: f32 = 3.14159265358979;

struct Sweep {
    level: u32,
    // 0 or 1.
    colour: u32,
}

@group(0) @binding(0) var<uniform> sweep: Sweep;
@group(0) @binding(1) var ordinates_source: texture_3d<f32>;
@group(0) @binding(2) var ordinates_depth: texture_3d<f32>;
// By level, direction and cell.
@group(0) @binding(3) var<storage, read_write> ordinates_radiance: array<vec2<f32>>;

fn cell_count(box: Level) -> u32 {
    return box.size.x * box.size.y * box.size.z;
}

fn slot(box: Level, direction: u32, cell: vec3<u32>) -> u32 {
    let place = cell.x + box.size.x * (cell.y + box.size.y * cell.z);
    return box.first_cell * DIRECTION_COUNT + direction * cell_count(box) + place;
}

// The next level's field at a place; it holds every place in and next to this level.
fn coarser_radiance(level: u32, place_m: vec3<f32>, direction: u32) -> vec2<f32> {
    let box = ordinates.levels[level + 1u];
    let cell = min(vec3<u32>(cells_from_corner(place_m, level + 1u)), box.size - 1u);
    return ordinates_radiance[slot(box, direction, cell)];
}

// Light of the ground in clear air around the clouds.
fn clear_ground() -> vec2<f32> {
    return ordinates.ground_albedo * vec2<f32>(max(ordinates.toward_sun.z, 0.0) / PI, 1.0);
}

// Light that comes up from the ground into a lowest cell: what it sends down there, reflected.
fn ground_radiance(box: Level, cell: vec3<u32>) -> vec2<f32> {
    var down = vec2<f32>(0.0);
    var all_down = 0.0;
    for (var ring = 0u; ring < RING_COUNT; ring++) {
        let share = ring_components(ring).z * ring_weight(ring);
        // The first four octants go down.
        for (var octant = 0u; octant < 4u; octant++) {
            down += share * ordinates_radiance[slot(box, octant * RING_COUNT + ring, cell)];
            all_down += share;
        }
    }
    let column = vec2<u32>(cell.xy * REFINEMENT + REFINEMENT / 2u);
    let depth = textureLoad(ordinates_depth, vec3<u32>(column, box.first_slice * REFINEMENT), 0).x;
    let sun = max(ordinates.toward_sun.z, 0.0) * exp(-depth) / PI;
    return ordinates.ground_albedo * (down / all_down + vec2<f32>(sun, 0.0));
}

// Light that enters a cell along a direction from the neighbour at a place.
fn upwind(box: Level, cell: vec3<u32>, place: vec3<i32>, octant: u32, direction: u32) -> vec2<f32> {
    var neighbour = place;
    let size = vec3<i32>(box.size);
    if neighbour.z < 0 {
        return ground_radiance(box, cell);
    }
    if neighbour.z >= size.z {
        return vec2<f32>(0.0, 1.0);
    }
    if any(neighbour < vec3<i32>(0)) || any(neighbour >= size) {
        if sweep.level + 1u < LEVEL_COUNT {
            let place_m = box.lowest_m + (vec3<f32>(neighbour) + 0.5) * box.cell_m;
            return coarser_radiance(sweep.level, place_m, direction);
        }
#ifdef ORDINATES_PERIODIC
        neighbour = (neighbour + size) % size;
#else
        return select(vec2<f32>(0.0, 1.0), clear_ground(), octant >= 4u);
#endif
    }
    return ordinates_radiance[slot(box, direction, vec3<u32>(neighbour))];
}

fn start(box: Level, cell: vec3<u32>) {
    let place_m = box.lowest_m + (vec3<f32>(cell) + 0.5) * box.cell_m;
    for (var direction = 0u; direction < DIRECTION_COUNT; direction++) {
        var guess = vec2<f32>(0.0);
        if sweep.level + 1u < LEVEL_COUNT {
            guess = coarser_radiance(sweep.level, place_m, direction);
        }
        ordinates_radiance[slot(box, direction, cell)] = guess;
    }
}

fn relax(box: Level, cell: vec3<u32>) {
    let matter = textureLoad(ordinates_source, vec3<u32>(cell.xy, cell.z + box.first_slice), 0).xy;
    let extinction = matter.x;
    let scattering = ordinates.albedo * matter.x;
    let reduced_cosine = ordinates.reduced_cosine;
    var gathered: array<vec2<f32>, DIRECTION_COUNT>;
    var mean = vec2<f32>(0.0);
    var flux_x = vec2<f32>(0.0);
    var flux_y = vec2<f32>(0.0);
    var flux_z = vec2<f32>(0.0);
    for (var octant = 0u; octant < 8u; octant++) {
        let signs = octant_signs(octant);
        let upwind_cell = vec3<i32>(cell) - vec3<i32>(signs);
        let here = vec3<i32>(cell);
        for (var ring = 0u; ring < RING_COUNT; ring++) {
            let direction = octant * RING_COUNT + ring;
            let along = ring_components(ring) / box.cell_m;
            let omega = signs * ring_components(ring);
            var light = along.x * upwind(box, cell, vec3<i32>(upwind_cell.x, here.yz), octant, direction)
                + along.y * upwind(box, cell, vec3<i32>(here.x, upwind_cell.y, here.z), octant, direction)
                + along.z * upwind(box, cell, vec3<i32>(here.xy, upwind_cell.z), octant, direction);
            light.x += matter.y * (1.0 - 3.0 * reduced_cosine * dot(omega, ordinates.toward_sun));
            light /= along.x + along.y + along.z + extinction;
            gathered[direction] = light;
            let share = ring_weight(ring) * light;
            mean += share;
            flux_x += 3.0 * omega.x * share;
            flux_y += 3.0 * omega.y * share;
            flux_z += 3.0 * omega.z * share;
        }
    }
    // What is not scattered back into the cell's own field.
    var kept = 0.0;
    var returned = vec3<f32>(0.0);
    for (var ring = 0u; ring < RING_COUNT; ring++) {
        let components = ring_components(ring);
        let along = components / box.cell_m;
        let streaming = along.x + along.y + along.z;
        let share = 8.0 * ring_weight(ring) / (streaming + extinction);
        kept += share * (streaming + extinction - scattering);
        returned += 3.0 * share * components * components;
    }
    mean /= kept;
    let flux_gain = 1.0 / (1.0 - reduced_cosine * scattering * returned);
    flux_x *= flux_gain.x;
    flux_y *= flux_gain.y;
    flux_z *= flux_gain.z;
    for (var octant = 0u; octant < 8u; octant++) {
        for (var ring = 0u; ring < RING_COUNT; ring++) {
            let components = ring_components(ring);
            let along = components / box.cell_m;
            let omega = octant_signs(octant) * components;
            let scattered = mean + reduced_cosine * (omega.x * flux_x + omega.y * flux_y + omega.z * flux_z);
            let direction = octant * RING_COUNT + ring;
            ordinates_radiance[slot(box, direction, cell)] =
                gathered[direction] + scattering / (along.x + along.y + along.z + extinction) * scattered;
        }
    }
}

// Across x an invocation owns two cells, of which one has the colour.
@compute @workgroup_size(16, 4, 2)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let box = ordinates.levels[sweep.level];
    let x = 2u * id.x + ((id.y + id.z + sweep.colour) & 1u);
    let cell = vec3<u32>(x, id.yz);
    if any(cell >= box.size) {
        return;
    }
#ifdef START
    start(box, cell);
#else
    relax(box, cell);
#endif
}
