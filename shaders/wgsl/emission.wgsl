#define_import_path welkin::emission
// Light that the air itself gives off, along a ray: shared by the passes that make tables of it.
//
// It depends on altitude and zenith angle alone. A ray is cut at its tangent point and wherever a profile has a kink or
// a jump, and each piece walked in panels that are even in v, with distance ∝ v² from the piece's low end. A panel gives
// (int source dt) T (1 - exp(-tau)) / tau, which is exact in thin air and, where source and extinction keep their ratio,
// in thick air too: a layer that absorbs and emits sends (1 - T) L_e however thick it is.
//
// Legend
//   source   a L_e, and what is scattered into the ray, W/m2/sr/nm per m
//   field    radiance looking along a direction, as coefficients of the zonal harmonics Y_l0
//
// Definitions: EMITTED (the air's own emission counts), RESCATTERED (so does emission that was scattered or came from
// the ground before, read from emission_field), GROUND; EMITTER_COUNT; EMITTING_EXPONENTIAL_END, EMITTING_TENT_END,
// where each profile's group ends among the emitters; BREAKPOINT_COUNT; ZONAL_COUNT, degrees of the field, more than
// that of the lights keeps: one column of texels is cheap.

#import welkin::atmosphere::{
    atmosphere, densities, exponential_density, extinction_at, layer_density, tent_density, PI, SCATTERER_COUNT
}
#import welkin::attenuation::mean_transmittance
#import welkin::geometry::distance_to_shell_from_above
#import welkin::mapping
#import welkin::march::{altitude_at, AirRay}
#import welkin::tables::sample_exactly

const EMITTER_COUNT: u32 = #{EMITTER_COUNT}u;
const EMITTING_EXPONENTIAL_END: u32 = #{EMITTING_EXPONENTIAL_END}u;
const EMITTING_TENT_END: u32 = #{EMITTING_TENT_END}u;
const EMITTER_SLOTS: u32 = max(EMITTER_COUNT, 1u);
const ZONAL_COUNT: u32 = #{ZONAL_COUNT}u;
const BREAKPOINT_COUNT: u32 = #{BREAKPOINT_COUNT}u;
const BREAKPOINT_SLOTS: u32 = max(BREAKPOINT_COUNT, 1u);
// Down through the breakpoints to the tangent point, up through them to the end.
const PIECE_COUNT: u32 = 2u * BREAKPOINT_COUNT + 2u;
// Panels of a piece, with two Gauss nodes each, which stay clear of the jumps at its ends.
const PANEL_COUNT: u32 = 8u;
const GAUSS_OFFSET: f32 = 0.2886751346;

struct Emitter {
    // a L_e at density 1.
    emission_per_m: vec3<f32>,
    // As in welkin::atmosphere::Constituent.
    profile_a: f32,
    profile_b: f32,
    padding_a: f32,
    padding_b: f32,
    padding_c: f32,
}

struct Emission {
    emitters: array<Emitter, EMITTER_SLOTS>,
    // x: altitude of a kink or a jump, ascending.
    breakpoints_m: array<vec4<f32>, BREAKPOINT_SLOTS>,
}

@group(0) @binding(15) var<uniform> emission: Emission;

#ifdef RESCATTERED
// Column l: coefficient of Y_l0; last column: irradiance on a horizontal plane from above. Rows as the altitudes of
// multiple_scattering_table.
@group(0) @binding(16) var emission_field: texture_2d<f32>;
// chi_l of each scatterer, row by row.
@group(0) @binding(17) var<storage, read> zonal_moments: array<f32>;

fn field_at(column: u32, altitude_m: f32) -> vec3<f32> {
    let size = vec2<f32>(textureDimensions(emission_field));
    let y = mapping::multiple_scattering_to_unit(altitude_m, 0.0, atmosphere.top_m, atmosphere.sun_warp).y;
    let uv = mapping::inset(vec2<f32>(f32(column) / (size.x - 1.0), y), size);
    return sample_exactly(emission_field, uv);
}
#endif

// Y_l0(mu) for all degrees.
fn zonal_harmonics(mu: f32) -> array<f32, ZONAL_COUNT> {
    var y: array<f32, ZONAL_COUNT>;
    var before = 0.0;
    var legendre = 1.0;
    for (var l = 0u; l < ZONAL_COUNT; l++) {
        y[l] = sqrt((2.0 * f32(l) + 1.0) / (4.0 * PI)) * legendre;
        let next = ((2.0 * f32(l) + 1.0) * mu * legendre - f32(l) * before) / f32(l + 1u);
        before = legendre;
        legendre = next;
    }
    return y;
}

fn emitted_at(altitude_m: f32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < EMITTING_EXPONENTIAL_END; i++) {
        let emitter = emission.emitters[i];
        sum += emitter.emission_per_m * exponential_density(emitter.profile_a, altitude_m);
    }
    for (var i = EMITTING_EXPONENTIAL_END; i < EMITTING_TENT_END; i++) {
        let emitter = emission.emitters[i];
        sum += emitter.emission_per_m * tent_density(emitter.profile_a, emitter.profile_b, altitude_m);
    }
    for (var i = EMITTING_TENT_END; i < EMITTER_COUNT; i++) {
        let emitter = emission.emitters[i];
        sum += emitter.emission_per_m * layer_density(emitter.profile_a, emitter.profile_b, altitude_m);
    }
    return sum;
}

fn source_at(ray: AirRay, distance_m: f32, altitude_m: f32) -> vec3<f32> {
    var source = vec3<f32>(0.0);
#ifdef EMITTED
    source += emitted_at(altitude_m);
#endif
#ifdef RESCATTERED
    let r_start = atmosphere.radius_m + ray.altitude_m;
    let mu = clamp((r_start * ray.mu + distance_m) / (atmosphere.radius_m + altitude_m), -1.0, 1.0);
    var density = densities(altitude_m);
    var y = zonal_harmonics(mu);
    var scattered = vec3<f32>(0.0);
    for (var l = 0u; l < ZONAL_COUNT; l++) {
        var scattering = vec3<f32>(0.0);
        for (var c = 0u; c < SCATTERER_COUNT; c++) {
            scattering += zonal_moments[c * ZONAL_COUNT + l] * density[c] * atmosphere.constituents[c].scattering_per_m;
        }
        scattered += scattering * y[l] * field_at(l, altitude_m);
    }
    source += max(scattered, vec3<f32>(0.0));
#endif
    return source;
}

// Distance to where a ray leaves a shell upwards; 0 or less when it does so nowhere ahead.
fn upward_crossing_m(ray: AirRay, shell_m: f32) -> f32 {
    let gap = (shell_m - ray.altitude_m) * (2.0 * atmosphere.radius_m + shell_m + ray.altitude_m);
    let b = (atmosphere.radius_m + ray.altitude_m) * ray.mu;
    let discriminant = b * b + gap;
    if discriminant <= 0.0 {
        return 0.0;
    }
    let root = sqrt(discriminant);
    return select(root - b, gap / max(root + b, 1e-20), b >= 0.0);
}

// Where a piece of the ray ends; the caller clamps it between the piece before and the ray's end.
fn piece_end_m(ray: AirRay, piece: u32) -> f32 {
    let tangent_m = clamp(ray.tangent_m, 0.0, ray.length_m);
    if piece < BREAKPOINT_COUNT {
        let shell_m = emission.breakpoints_m[BREAKPOINT_COUNT - 1u - piece].x;
        return min(distance_to_shell_from_above(atmosphere.radius_m, ray.altitude_m, ray.mu, shell_m), tangent_m);
    }
    if piece == BREAKPOINT_COUNT {
        return tangent_m;
    }
    if piece < PIECE_COUNT - 1u {
        return upward_crossing_m(ray, emission.breakpoints_m[piece - BREAKPOINT_COUNT - 1u].x);
    }
    return ray.length_m;
}

// Adds what a piece sends to the ray's start; tau becomes the optical depth from there to the piece's end.
fn walk_piece(
    ray: AirRay,
    start_m: f32,
    end_m: f32,
    tau: ptr<function, vec3<f32>>,
    radiance: ptr<function, vec3<f32>>,
) {
    let length_m = end_m - start_m;
    let descending = 0.5 * (start_m + end_m) < ray.tangent_m;
    for (var panel = 0u; panel < PANEL_COUNT; panel++) {
        let index = select(panel, PANEL_COUNT - 1u - panel, descending);
        let middle_v = (f32(index) + 0.5) / f32(PANEL_COUNT);
        var source = vec3<f32>(0.0);
        var panel_tau = vec3<f32>(0.0);
        for (var side = -1.0; side < 2.0; side += 2.0) {
            let v = middle_v + side * GAUSS_OFFSET / f32(PANEL_COUNT);
            let along_m = length_m * v * v;
            let distance_m = start_m + select(along_m, length_m - along_m, descending);
            let altitude_m = altitude_at(ray, distance_m);
            // dt = 2 length v dv, over half a panel.
            let weight_m = length_m * v / f32(PANEL_COUNT);
            source += weight_m * source_at(ray, distance_m, altitude_m);
            panel_tau += weight_m * extinction_at(altitude_m);
        }
        *radiance += exp(-*tau) * source * mean_transmittance(panel_tau);
        *tau += panel_tau;
    }
}

// Radiance that arrives at the start of a ray, that of the ground at its end included.
fn glow_along(ray: AirRay, hits_ground: bool) -> vec3<f32> {
    var tau = vec3<f32>(0.0);
    var radiance = vec3<f32>(0.0);
    var start_m = 0.0;
    for (var piece = 0u; piece < PIECE_COUNT; piece++) {
        let end_m = clamp(piece_end_m(ray, piece), start_m, ray.length_m);
        if end_m > start_m {
            walk_piece(ray, start_m, end_m, &tau, &radiance);
        }
        start_m = end_m;
    }
#ifdef RESCATTERED
#ifdef GROUND
    if hits_ground {
        radiance += exp(-tau) * atmosphere.ground_albedo / PI * field_at(ZONAL_COUNT, 0.0);
    }
#endif
#endif
    return radiance;
}
