// Pass: light of one order more, from the field of the order before; spherical-harmonic source iteration.
//
// Adds what it finds to the sum of all orders. The last dispatch, whose own order nobody reads, adds the rest of the series:
// from the third order on, successive orders shrink by a constant ratio, so that the rest is geometric. It is the same shader,
// as drivers would compile another for as long again: that it is the last it knows by `order`, which is smaller than `sum` then.

#import welkin::atmosphere::atmosphere
#import welkin::directions::{direction_of, field, irradiance, keep_ring_sums, project, DIRECTION_COUNT, INVOCATION_COUNT}
#import welkin::field_radiance::{next_order_radiance, ray_from}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::tables::IRRADIANCE_LAYER

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

// The whole series from this order on, relative to this order.
fn remainder(this_order: vec3<f32>, order_before: vec3<f32>) -> vec3<f32> {
    let ratio = clamp(this_order / max(order_before, vec3<f32>(DARK)), vec3<f32>(0.0), vec3<f32>(MAX_RATIO));
    return select(vec3<f32>(1.0), 1.0 / (1.0 - ratio), closes_series());
}

// What is kept of this order and of the sum with it.
struct Kept {
    order: vec3<f32>,
    sum: vec3<f32>,
}

// Of a positive quantity, the mean radiance or the irradiance, its logarithm.
fn logarithmic(value: vec3<f32>, order_before: vec3<f32>, sum_before: vec3<f32>) -> Kept {
    let total = exp(sum_before) + value * remainder(value, exp(order_before));
    return Kept(log(value), log(total));
}

@compute @workgroup_size(#{INVOCATION_COUNT})
fn main(@builtin(workgroup_id) texel: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let size = vec2<f32>(textureDimensions(sum));
    let unit = mapping::unit_from_texel(texel.xy, size);
    let here = mapping::multiple_scattering_from_unit(unit, atmosphere.top_m, atmosphere.sun_warp);
    let mu_s = here.mu;
    let mu_h = horizon_mu(atmosphere.radius_m, here.altitude_m);
    for (var i = invocation; i < DIRECTION_COUNT; i += INVOCATION_COUNT) {
        let direction = direction_of(i, mu_h);
        let ray = ray_from(here.altitude_m, mu_s, direction.mu, direction.cos_phi, direction.hits_ground);
        field[i] = next_order_radiance(previous_order, ray, direction.hits_ground);
    }
    workgroupBarrier();
    keep_ring_sums(invocation, mu_h);
    workgroupBarrier();
    let mean = max(project(0u, mu_h), vec3<f32>(DARK));
    let mean_before = exp(textureLoad(previous_order, texel.xy, 0, 0).rgb);
    let mean_sum_before = exp(textureLoad(previous_sum, texel.xy, 0, 0).rgb);
    let rest = remainder(mean, mean_before);
    // One place that stores for all layers: drivers make much code of a store.
    for (var layer = invocation; layer <= IRRADIANCE_LAYER; layer += INVOCATION_COUNT) {
        let order_before = textureLoad(previous_order, texel.xy, layer, 0).rgb;
        let sum_before = textureLoad(previous_sum, texel.xy, layer, 0).rgb;
        var kept: Kept;
        if layer == 0u {
            kept = logarithmic(mean, order_before, sum_before);
        } else if layer == IRRADIANCE_LAYER {
            kept = logarithmic(max(irradiance(mu_h), vec3<f32>(DARK)), order_before, sum_before);
        } else {
            let coefficient = project(layer, mu_h);
            let total = mean_sum_before * sum_before + coefficient * rest;
            kept = Kept(coefficient / mean, total / (mean_sum_before + mean * rest));
        }
        if !closes_series() {
            textureStore(order, texel.xy, layer, vec4<f32>(kept.order, 0.0));
        }
        textureStore(sum, texel.xy, layer, vec4<f32>(kept.sum, 0.0));
    }
}
