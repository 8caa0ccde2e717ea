// Pass: light of one order more, from the field of the order before; spherical-harmonic source iteration.
//
// Adds what it finds to the sum of all orders. The last pass (definition CLOSE_SERIES) adds the rest of the series:
// from the third order on, successive orders shrink by a constant ratio, so that the rest is geometric.

#import welkin::atmosphere::atmosphere
#import welkin::directions::{direction_of, field, irradiance, project, DIRECTION_COUNT, INVOCATION_COUNT}
#import welkin::field_radiance::{next_order_radiance, ray_from}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::spherical_harmonics::COEFFICIENT_COUNT
#import welkin::tables::IRRADIANCE_LAYER

@group(0) @binding(6) var previous_order: texture_2d_array<f32>;
@group(0) @binding(7) var previous_sum: texture_2d_array<f32>;
#ifndef CLOSE_SERIES
#ifdef HALF_TABLES
@group(0) @binding(8) var order: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(8) var order: texture_storage_2d_array<rgba32float, write>;
#endif
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

// The whole series from this order on, relative to this order.
fn remainder(this_order: vec3<f32>, order_before: vec3<f32>) -> vec3<f32> {
#ifdef CLOSE_SERIES
    return 1.0 / (1.0 - clamp(this_order / max(order_before, vec3<f32>(DARK)), vec3<f32>(0.0), vec3<f32>(MAX_RATIO)));
#else
    return vec3<f32>(1.0);
#endif
}

// A positive quantity, kept as its logarithm: the mean radiance, or the irradiance.
fn add_logarithmic(texel: vec2<u32>, layer: u32, value: vec3<f32>) {
    let before = exp(textureLoad(previous_order, texel, layer, 0).rgb);
    let total = exp(textureLoad(previous_sum, texel, layer, 0).rgb) + value * remainder(value, before);
#ifndef CLOSE_SERIES
    textureStore(order, texel, layer, vec4<f32>(log(value), 0.0));
#endif
    textureStore(sum, texel, layer, vec4<f32>(log(total), 0.0));
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
    if invocation == 0u {
        add_logarithmic(texel.xy, 0u, max(project(0u, mu_h), vec3<f32>(DARK)));
        add_logarithmic(texel.xy, IRRADIANCE_LAYER, max(irradiance(mu_h), vec3<f32>(DARK)));
    }
    let mean = max(project(0u, mu_h), vec3<f32>(DARK));
    let mean_before = exp(textureLoad(previous_order, texel.xy, 0, 0).rgb);
    let mean_sum_before = exp(textureLoad(previous_sum, texel.xy, 0, 0).rgb);
    let rest = remainder(mean, mean_before);
    for (var k = invocation + 1u; k < COEFFICIENT_COUNT; k += INVOCATION_COUNT) {
        let coefficient = project(k, mu_h);
        let total = mean_sum_before * textureLoad(previous_sum, texel.xy, k, 0).rgb + coefficient * rest;
#ifndef CLOSE_SERIES
        textureStore(order, texel.xy, k, vec4<f32>(coefficient / mean, 0.0));
#endif
        textureStore(sum, texel.xy, k, vec4<f32>(total / (mean_sum_before + mean * rest), 0.0));
    }
}
