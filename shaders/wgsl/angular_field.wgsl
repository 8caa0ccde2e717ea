#define_import_path welkin::angular_field
// Tables over the optical depth that light has come and the angle in which it leaves: of light that matter has scattered around a lamp
// (welkin::lamp_field), and of what its forward peak makes of a beam (welkin::beam_field).
//
// Legend
//   field     table of one kind of matter and source
//   depth     optical depth to the source, in the bands
//   nu        cosine between the direction in which light leaves and that away from the source
//   row, column   whole and part of an index

// Rows of depths, ever the same factor apart; columns of angles as sqrt(angle / π), then of lamps the net flux away from them and the integral
// over all directions, of beams the ceiling at which the peak begins.
@group(1) @binding(48) var<storage, read> angular_fields: array<vec4<f32>>;

// welkin::passes::blocks::angular_fields has the same numbers.
const DEPTHS: u32 = 32u;
const ANGLES: u32 = 48u;
const COLUMNS: u32 = ANGLES + 2u;
const FIRST_DEPTH: f32 = 0.02;
// ln of the last depth over the first, 60 / 0.02.
const LOG_DEPTHS: f32 = 8.00636757;
const NO_FIELD: u32 = 0xffffffffu;
const PI: f32 = 3.14159265;

fn row_of(depth: f32) -> f32 {
    return clamp(log(max(depth, FIRST_DEPTH) / FIRST_DEPTH) / LOG_DEPTHS, 0.0, 1.0) * f32(DEPTHS - 1u);
}

fn column_of(nu: f32) -> f32 {
    return sqrt(acos(clamp(nu, -1.0, 1.0)) / PI) * f32(ANGLES - 1u);
}

fn between_columns(first: u32, column: f32) -> vec3<f32> {
    let low = min(u32(column), ANGLES - 2u);
    return mix(angular_fields[first + low].rgb, angular_fields[first + low + 1u].rgb, column - f32(low));
}

fn at_angle(field: u32, row: f32, column: f32) -> vec3<f32> {
    let low = min(u32(row), DEPTHS - 2u);
    let first = (field * DEPTHS + low) * COLUMNS;
    return mix(between_columns(first, column), between_columns(first + COLUMNS, column), row - f32(low));
}

// What is scattered a second time or more, over what scattered light is counted by in such a table.
fn scattered_before(field: u32, depth: vec3<f32>, nu: f32) -> vec3<f32> {
    let column = column_of(nu);
    var found = at_angle(field, row_of(depth.r), column);
    // Most matter is grey.
    if any(depth.gb != depth.rr) {
        found.g = at_angle(field, row_of(depth.g), column).g;
        found.b = at_angle(field, row_of(depth.b), column).b;
    }
    return found;
}

// The first of the last two columns at a whole row.
fn last_columns(field: u32, row: u32) -> u32 {
    return (field * DEPTHS + row) * COLUMNS + ANGLES;
}
