#define_import_path welkin::lamp_field
// Light of a lamp that even matter around it has scattered, as welkin_lut::lamp_field solves for it: tables over the optical
// depth from the lamp and the angle to the direction away from it.
//
// Legend: welkin::angular_field. What tables hold is over the lamp's intensity, over 1 - e^(-depth), and times the square of the distance.

#import welkin::angular_field::{angular_fields, last_columns, row_of, scattered_before, DEPTHS, NO_FIELD}
#import welkin::attenuation::opacity

// K: what is scattered a second time or more, per b, intensity and distance^-2, 1/sr.
fn scattered_again_per_sr(field: u32, depth: vec3<f32>, nu: f32) -> vec3<f32> {
    return scattered_before(field, depth, nu) * opacity(depth);
}

// How far the scattered field spreads about the direction away from the lamp: 1 - its mean cosine.
fn spread_of_field(field: u32, depth: vec3<f32>) -> f32 {
    let row = u32(row_of(max(depth.r, max(depth.g, depth.b))) + 0.5);
    let flux = last_columns(field, row);
    return 1.0 - angular_fields[flux].g / max(angular_fields[flux + 1u].g, 1e-20);
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
    let near = last_columns(field, low);
    let far = last_columns(field, low + 1u);
    let outward = mix(angular_fields[near].rgb, angular_fields[far].rgb, row - f32(low));
    let scalar = mix(angular_fields[near + 1u].rgb, angular_fields[far + 1u].rgb, row - f32(low));
    return opacity(depth) * (outward * max(cosine, 0.0) + 0.25 * max(scalar - outward, vec3<f32>(0.0)));
}
