// Pass: the source function of one order more, from that of the order before; source iteration.
//
// Adds what it finds to the sum of all orders. The last dispatch, whose own order nobody reads, adds the rest of the series:
// from the third order on, successive orders shrink by a constant ratio, so that the rest is geometric. It is the same shader,
// as drivers would compile another for as long again: that it is the last it knows by `order`, which is smaller than `sum` then.

#import welkin::atmosphere::atmosphere
#import welkin::convolution::{
    field, harmonic_of_field, keep_direction, keep_moment, mean_of_field, positive, LOGARITHM_COUNT, MOMENT_COUNT
}
#import welkin::field_radiance::{next_order_radiance, ray_from}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::source_grid::{
    direction_of, moment_texel, DIRECTION_COUNT, FIRST_HARMONIC_TILE, HARMONIC_COUNT, MEAN_TILE, TILE_SIZE
}

const INVOCATION_COUNT: u32 = #{GRID_INVOCATION_COUNT}u;

@group(0) @binding(6) var previous_order: texture_2d_array<f32>;
@group(0) @binding(7) var previous_sum: texture_2d_array<f32>;
#ifdef HALF_TABLES
@group(0) @binding(8) var order: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(8) var order: texture_storage_2d_array<rgba32float, write>;
#endif
#ifdef HALF_TABLES
@group(0) @binding(9) var sum: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(9) var sum: texture_storage_2d_array<rgba32float, write>;
#endif

// Below this, light is dark; it keeps logarithms finite.
const DARK: f32 = 1e-30;
// The largest ratio between orders that the tail believes.
const MAX_RATIO: f32 = 0.9;

// Whether no order comes after this one.
fn closes_series() -> bool {
    return textureDimensions(order).x < textureDimensions(sum).x;
}

// The whole series from this order on, relative to this order. The ratio of orders is that of means over directions:
// in single directions it is not yet constant where haze scatters forward and light comes round slowly.
fn remainder(place: vec2<u32>) -> vec3<f32> {
    let before = exp(textureLoad(previous_order, moment_texel(MEAN_TILE, place), 0, 0).rgb);
    let ratio = mean_of_field() / max(before, vec3<f32>(DARK));
    let series = 1.0 / (1.0 - clamp(ratio, vec3<f32>(0.0), vec3<f32>(MAX_RATIO)));
    return select(vec3<f32>(1.0), series, closes_series());
}

// Adds a positive quantity of this order, kept as its logarithm.
fn add(texel: vec2<u32>, layer: u32, value_or_dark: vec3<f32>, rest: vec3<f32>) {
    let value = max(value_or_dark, vec3<f32>(DARK));
    if !closes_series() {
        textureStore(order, texel, layer, vec4<f32>(log(value), 0.0));
    }
    let total = exp(textureLoad(previous_sum, texel, layer, 0).rgb) + value * rest;
    textureStore(sum, texel, layer, vec4<f32>(log(total), 0.0));
}

@compute @workgroup_size(#{GRID_INVOCATION_COUNT})
fn main(@builtin(workgroup_id) texel: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let unit = mapping::unit_from_texel(texel.xy, vec2<f32>(TILE_SIZE));
    let here = mapping::multiple_scattering_from_unit(unit, atmosphere.top_m, atmosphere.sun_warp);
    let mu_h = horizon_mu(atmosphere.radius_m, here.altitude_m);
    for (var i = invocation; i < DIRECTION_COUNT; i += INVOCATION_COUNT) {
        keep_direction(i, mu_h, here.mu);
        let direction = direction_of(i, mu_h, here.mu);
        let ray = ray_from(here.altitude_m, here.mu, direction.mu, cos(direction.phi_rad), direction.hits_ground);
        field[i] = next_order_radiance(previous_order, ray, direction.hits_ground);
    }
    workgroupBarrier();
    if invocation < MOMENT_COUNT {
        keep_moment(invocation);
    }
    workgroupBarrier();
    let rest = remainder(texel.xy);
    // One place that stores for all of them: drivers make much code of a store.
    for (var i = invocation; i < LOGARITHM_COUNT; i += INVOCATION_COUNT) {
        var found = positive(i, texel.xy);
        for (var layer = 0u; layer < found.layer_count; layer++) {
            add(found.texel, layer, found.values[layer], rest);
        }
    }
    if invocation < HARMONIC_COUNT {
        let before = exp(textureLoad(previous_sum, moment_texel(MEAN_TILE, texel.xy), 0, 0).rgb);
        let added = max(mean_of_field(), vec3<f32>(DARK)) * rest;
        let place = moment_texel(FIRST_HARMONIC_TILE + invocation, texel.xy);
        let harmonic_before = textureLoad(previous_sum, place, 0, 0).rgb;
        let harmonic = (before * harmonic_before + added * harmonic_of_field(invocation + 1u)) / (before + added);
        textureStore(sum, place, 0u, vec4<f32>(harmonic, 0.0));
    }
}
