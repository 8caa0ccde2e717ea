// Pass: one half of a red-black relaxation of the light in clouds: discrete ordinates on a grid of cells.
//
// One invocation a cell of one colour (parity of x + y + z), so that every upwind neighbour is of the other colour and
// the field is updated in place. Within the cell the scattered light is solved for exactly: all directions of a ring
// lose light alike, so that mean and flux of the field follow from two divisions and no iteration is needed where a cell
// is opaque. What leaves one cell enters the next, and void cells just stream.
//
//   sum_a |w_a|/h_a (out_a - in_a) + c' psi_d = b' (I0 + g' w_d . I1) + Q (1 - 3 g' w_d . s)
//   I0 = sum_d weight_d psi_d,   I1 = 3 sum_d weight_d w_d psi_d
//
// Light is not the same all through an opaque cell. What leaves it has the slope that the first moment of this equation
// gives, so that light spreads as in the limit of many scatterings however wide cells are, and it takes along the flux
// that the beam has lost on its way in:
//
//   out_a = psi_d +- slope_a + 3 w_d . s e_a,   slope_a = -k_a h_a/2 ((c' - g' b') I1_a + 3 g' Q s_a)
//
// k is 1 but in the most opaque cells, which would need as many sweeps as they have depth.
//
// Legend
//   psi      radiance that travels along w_d; .x of the sun per unit irradiance, 1/sr, .y of a sky of radiance 1
//   c', b'   extinction and scattering of the similar medium with asymmetry g', 1/m
//   Q        the sun's light that is scattered for the first time, 1/m/sr; s points to the sun
//   e_a      by how much the beam at the face is brighter than in the cell, over 4 pi
//
// Definitions: those of welkin::ordinates_grid and welkin::ordinates_directions; START: the field of the next level (or
// darkness) is taken as a first guess, both colours at once.

#import welkin::ordinates_grid::{
    ordinates, cells_from_corner, Level, LEVEL_COUNT, REFINEMENT,
}
#import welkin::ordinates_directions::{octant_signs, ring_components, ring_weight, DIRECTION_COUNT, RING_COUNT, SLOT_COUNT}

const PI: f32 = 3.14159265358979;
// Depth of a cell, by what turns the flux, that its slope shows at most.
const STEEPEST: f32 = 6.0;

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
@group(0) @binding(4) var ordinates_low_faces: texture_3d<f32>;
@group(0) @binding(5) var ordinates_high_faces: texture_3d<f32>;

fn cell_count(box: Level) -> u32 {
    return box.size.x * box.size.y * box.size.z;
}

fn slot(box: Level, direction: u32, cell: vec3<u32>) -> u32 {
    let place = cell.x + box.size.x * (cell.y + box.size.y * cell.z);
    return box.first_cell * SLOT_COUNT + direction * cell_count(box) + place;
}

// What light that leaves a cell has beside the cell's own: through one face.
struct Face {
    // The same in all directions.
    rise: vec2<f32>,
    // Times w . s; of the sun's alone.
    beam: f32,
}

// How the light of a cell differs at the face to the higher neighbour along an axis, or to the lower one.
fn face(box: Level, cell: vec3<u32>, axis: u32, is_high: bool) -> Face {
    let texel = vec3<u32>(cell.xy, cell.z + box.first_slice);
    let slope = ordinates_radiance[slot(box, DIRECTION_COUNT + axis, cell)];
    if is_high {
        return Face(slope, textureLoad(ordinates_high_faces, texel, 0)[axis]);
    }
    return Face(-slope, textureLoad(ordinates_low_faces, texel, 0)[axis]);
}

fn through(face: Face, omega: vec3<f32>) -> vec2<f32> {
    return face.rise + vec2<f32>(face.beam * dot(omega, ordinates.toward_sun), 0.0);
}

// Where the next level keeps its field at a place; it holds every place in and next to this level.
fn coarser_slot(level: u32, place_m: vec3<f32>, direction: u32) -> u32 {
    let box = ordinates.levels[level + 1u];
    let cell = min(vec3<u32>(cells_from_corner(place_m, level + 1u)), box.size - 1u);
    return slot(box, direction, cell);
}

// Light of the ground in clear air around the clouds.
fn clear_ground() -> vec2<f32> {
    return ordinates.ground_albedo * vec2<f32>(max(ordinates.toward_sun.z, 0.0) / PI, 1.0);
}

// Light that comes up from the ground into a lowest cell: what it sends down there, reflected.
fn ground_radiance(box: Level, cell: vec3<u32>) -> vec2<f32> {
    let leaving = face(box, cell, 2u, false);
    var down = vec2<f32>(0.0);
    var all_down = 0.0;
    for (var ring = 0u; ring < RING_COUNT; ring++) {
        let share = ring_components(ring).z * ring_weight(ring);
        // The first four octants go down.
        for (var octant = 0u; octant < 4u; octant++) {
            let omega = octant_signs(octant) * ring_components(ring);
            down += share * (ordinates_radiance[slot(box, octant * RING_COUNT + ring, cell)] + through(leaving, omega));
            all_down += share;
        }
    }
    let column = vec2<u32>(cell.xy * REFINEMENT + REFINEMENT / 2u);
    let depth = textureLoad(ordinates_depth, vec3<u32>(column, box.first_slice * REFINEMENT), 0).x;
    let sun = max(ordinates.toward_sun.z, 0.0) * exp(-depth) / PI;
    return ordinates.ground_albedo * (max(down / all_down, vec2<f32>(0.0)) + vec2<f32>(sun, 0.0));
}

// The neighbour of a cell in the same level; whether there is one.
struct Neighbour {
    cell: vec3<u32>,
    exists: bool,
}

fn neighbour_of(box: Level, place: vec3<i32>) -> Neighbour {
    let size = vec3<i32>(box.size);
    var cell = place;
#ifdef ORDINATES_PERIODIC
    if sweep.level + 1u == LEVEL_COUNT {
        cell = vec3<i32>((place.xy + size.xy) % size.xy, place.z);
    }
#endif
    return Neighbour(vec3<u32>(cell), all(cell >= vec3<i32>(0)) && all(cell < size));
}

// Where light comes from that enters a cell through a face, for all directions at once.
struct Upwind {
    // From a cell, of this level or the next: its first slot, and how far apart those of its directions are.
    is_cell: bool,
    first_slot: u32,
    stride: u32,
    // Of the next level nothing but the cell's own light.
    face: Face,
    // From outside of all levels: light that rises. The sky's falls.
    rising: vec2<f32>,
}

// What is upwind of a cell through the lower or the higher face along an axis.
fn upwind_of(box: Level, cell: vec3<u32>, axis: u32, is_high: bool) -> Upwind {
    var place = vec3<i32>(cell);
    place[axis] += select(-1, 1, is_high);
    var upwind: Upwind;
    let neighbour = neighbour_of(box, place);
    if neighbour.exists {
        upwind.is_cell = true;
        upwind.first_slot = slot(box, 0u, neighbour.cell);
        upwind.stride = cell_count(box);
        // The lower neighbour's light comes through its high face.
        upwind.face = face(box, neighbour.cell, axis, !is_high);
    } else if axis == 2u && !is_high && cell.z == 0u {
        upwind.rising = ground_radiance(box, cell);
    } else if place.z < i32(box.size.z) {
        if sweep.level + 1u < LEVEL_COUNT {
            let place_m = box.lowest_m + (vec3<f32>(place) + 0.5) * box.cell_m;
            upwind.is_cell = true;
            upwind.first_slot = coarser_slot(sweep.level, place_m, 0u);
            upwind.stride = cell_count(ordinates.levels[sweep.level + 1u]);
        }
        upwind.rising = clear_ground();
    }
    return upwind;
}

// What is upwind through a cell's six faces; of those along an axis the lower one first.
struct Inflow {
    faces: array<Upwind, 6>,
}

fn inflow_of(box: Level, cell: vec3<u32>) -> Inflow {
    var inflow: Inflow;
    for (var axis = 0u; axis < 3u; axis++) {
        for (var side = 0u; side < 2u; side++) {
            inflow.faces[2u * axis + side] = upwind_of(box, cell, axis, side == 1u);
        }
    }
    return inflow;
}

fn start(box: Level, cell: vec3<u32>) {
    let place_m = box.lowest_m + (vec3<f32>(cell) + 0.5) * box.cell_m;
    for (var direction = 0u; direction < DIRECTION_COUNT; direction++) {
        var guess = vec2<f32>(0.0);
        if sweep.level + 1u < LEVEL_COUNT {
            guess = ordinates_radiance[coarser_slot(sweep.level, place_m, direction)];
        }
        ordinates_radiance[slot(box, direction, cell)] = guess;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        ordinates_radiance[slot(box, DIRECTION_COUNT + axis, cell)] = vec2<f32>(0.0);
    }
}

// Light that enters a cell along a direction through the faces that it meets, times |w_a| / h_a.
fn entering(inflow: ptr<function, Inflow>, octant: u32, direction: u32, along: vec3<f32>, omega: vec3<f32>) -> vec2<f32> {
    var light = vec2<f32>(0.0);
    for (var axis = 0u; axis < 3u; axis++) {
        let upwind = (*inflow).faces[2u * axis + select(0u, 1u, omega[axis] < 0.0)];
        if upwind.is_cell {
            let radiance = ordinates_radiance[upwind.first_slot + direction * upwind.stride];
            light += along[axis] * (radiance + through(upwind.face, omega));
        } else {
            // The first four octants go down.
            light += along[axis] * select(vec2<f32>(0.0, 1.0), upwind.rising, octant >= 4u);
        }
    }
    return light;
}

fn relax(box: Level, cell: vec3<u32>) {
    let texel = vec3<u32>(cell.xy, cell.z + box.first_slice);
    let matter = textureLoad(ordinates_source, texel, 0).xy;
    let low = textureLoad(ordinates_low_faces, texel, 0).xyz;
    let high = textureLoad(ordinates_high_faces, texel, 0).xyz;
    let extinction = matter.x;
    let scattering = ordinates.albedo * matter.x;
    let reduced_cosine = ordinates.reduced_cosine;
    let toward_sun = ordinates.toward_sun;
    // What turns the flux, how much of it the slope along each axis shows at either face, and with it what a flux brings
    // about in the cell: what is scattered forward and, as the slope takes it from what leaves, half of what turns it.
    let turning = extinction - reduced_cosine * scattering;
    let shown = 0.5 * min(vec3<f32>(1.0), STEEPEST / max(turning * box.cell_m, vec3<f32>(1e-6)));
    let tilt = reduced_cosine * scattering + shown * turning;
    let dipole = 3.0 * reduced_cosine * matter.y * toward_sun;
    var inflow = inflow_of(box, cell);
    var gathered: array<vec2<f32>, DIRECTION_COUNT>;
    var mean = vec2<f32>(0.0);
    var flux: array<vec2<f32>, 3>;
    for (var octant = 0u; octant < 8u; octant++) {
        let signs = octant_signs(octant);
        let leaving = select(low, high, signs > vec3<f32>(0.0));
        for (var ring = 0u; ring < RING_COUNT; ring++) {
            let direction = octant * RING_COUNT + ring;
            let along = ring_components(ring) / box.cell_m;
            let omega = signs * ring_components(ring);
            let towards = dot(omega, toward_sun);
            var light = entering(&inflow, octant, direction, along, omega);
            light.x += matter.y - dot((1.0 - shown) * dipole, omega) - towards * dot(along, leaving);
            light /= along.x + along.y + along.z + extinction;
            gathered[direction] = light;
            let share = ring_weight(ring) * light;
            mean += share;
            flux[0] += 3.0 * omega.x * share;
            flux[1] += 3.0 * omega.y * share;
            flux[2] += 3.0 * omega.z * share;
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
    let flux_gain = 1.0 / (1.0 - tilt * returned);
    for (var axis = 0u; axis < 3u; axis++) {
        flux[axis] *= flux_gain[axis];
    }
    for (var octant = 0u; octant < 8u; octant++) {
        for (var ring = 0u; ring < RING_COUNT; ring++) {
            let components = ring_components(ring);
            let along = components / box.cell_m;
            let omega = octant_signs(octant) * components;
            let tilted = tilt * omega;
            let turned = tilted.x * flux[0] + tilted.y * flux[1] + tilted.z * flux[2];
            let direction = octant * RING_COUNT + ring;
            ordinates_radiance[slot(box, direction, cell)] =
                gathered[direction] + (scattering * mean + turned) / (along.x + along.y + along.z + extinction);
        }
    }
    for (var axis = 0u; axis < 3u; axis++) {
        let falling = turning * flux[axis] + vec2<f32>(dipole[axis], 0.0);
        ordinates_radiance[slot(box, DIRECTION_COUNT + axis, cell)] = -shown[axis] * box.cell_m[axis] * falling;
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
