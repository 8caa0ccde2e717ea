#define_import_path welkin::lamp_field
// Light of a lamp that even matter around it has scattered, as welkin_lut::lamp_field solves for it: tables over the optical
// depth from the lamp and the angle to the direction away from it.
//
// Legend
//   field     table of one kind of matter: phase function, albedo and size
//   depth     optical depth to the lamp, in the bands
//   nu        cosine between the direction in which light leaves and that away from the lamp
// What tables hold is over the lamp's intensity, over 1 - e^(-depth), and times the square of the distance.

#import welkin::attenuation::opacity

// Rows of depths, ever the same factor apart; columns of angles as sqrt(angle / π), then the net flux away from the lamp and the integral
// over all directions.
@group(1) @binding(48) var<storage, read> lamp_fields: array<vec4<f32>>;

// welkin::passes::blocks::lamp_fields has the same numbers.
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

fn between_columns(first: u32, column: f32) -> vec3<f32> {
    let low = min(u32(column), ANGLES - 2u);
    return mix(lamp_fields[first + low].rgb, lamp_fields[first + low + 1u].rgb, column - f32(low));
}

fn at_angle(field: u32, row: f32, column: f32) -> vec3<f32> {
    let low = min(u32(row), DEPTHS - 2u);
    let first = (field * DEPTHS + low) * COLUMNS;
    return mix(between_columns(first, column), between_columns(first + COLUMNS, column), row - f32(low));
}

// K: what is scattered a second time or more, per b, intensity and distance^-2, 1/sr.
fn scattered_again_per_sr(field: u32, depth: vec3<f32>, nu: f32) -> vec3<f32> {
    let column = sqrt(acos(clamp(nu, -1.0, 1.0)) / PI) * f32(ANGLES - 1u);
    var found = at_angle(field, row_of(depth.r), column);
    // Most matter is grey.
    if any(depth.gb != depth.rr) {
        found.g = at_angle(field, row_of(depth.g), column).g;
        found.b = at_angle(field, row_of(depth.b), column).b;
    }
    return found * opacity(depth);
}

// How far the scattered field spreads about the direction away from the lamp: 1 - its mean cosine.
fn spread_of_field(field: u32, depth: vec3<f32>) -> f32 {
    let row = u32(row_of(max(depth.r, max(depth.g, depth.b))) + 0.5);
    let flux = (field * DEPTHS + row) * COLUMNS + ANGLES;
    return 1.0 - lamp_fields[flux].g / max(lamp_fields[flux + 1u].g, 1e-20);
}

// What ground leaves of the scattered light that comes from a lamp at one altitude to a place at another. Light that goes the way d by
// detours is taken for a Brownian bridge, which meets the ground with the probability e^(-2 h z / V) (the reflection principle); a
// way with one bend anywhere that arrives under a mean squared angle of 2 (1 - mean cosine) has V = 2/3 (1 - mean cosine) d².
fn above_ground(spread: f32, lamp_m: f32, place_m: f32, distance_m: f32, ground_albedo: vec3<f32>) -> vec3<f32> {
    let heights = max(lamp_m, 0.0) * max(place_m, 0.0);
    return 1.0 - (1.0 - ground_albedo) * exp(-3.0 * heights / max(spread * distance_m * distance_m, 1e-6));
}

// Irradiance of scattered light on a plane, over the lamp's intensity and distance^-2; the cosine is that between its normal and the
// direction of the lamp. What flows outward comes from the lamp's side, the rest from everywhere.
fn scattered_irradiance(field: u32, depth: vec3<f32>, cosine: f32) -> vec3<f32> {
    if field == NO_FIELD {
        return vec3<f32>(0.0);
    }
    let row = row_of(max(depth.r, max(depth.g, depth.b)));
    let low = min(u32(row), DEPTHS - 2u);
    let near = (field * DEPTHS + low) * COLUMNS + ANGLES;
    let far = near + COLUMNS;
    let outward = mix(lamp_fields[near].rgb, lamp_fields[far].rgb, row - f32(low));
    let scalar = mix(lamp_fields[near + 1u].rgb, lamp_fields[far + 1u].rgb, row - f32(low));
    return opacity(depth) * (outward * max(cosine, 0.0) + 0.25 * max(scalar - outward, vec3<f32>(0.0)));
}
