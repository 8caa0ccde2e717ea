#define_import_path welkin::view_integrals
// The integrals along a view ray that tables of the sky are made of, for unit irradiance of the light.
//
// Definitions: MULTIPLE_SCATTERING; FAN_COUNT, rays that are walked together (where FANS is defined).

#import welkin::atmosphere::{atmosphere, densities, SCATTERER_COUNT, SCATTERER_SLOTS}
#import welkin::loops::counted
#import welkin::march::{
    leg_advance, leg_finish, leg_is_empty, leg_of, local_directions, AirRay, LEG_COUNT, NODE_COUNT
}
#import welkin::tables::{multiply_scattered_source, optical_depth_to_top}

// Below this, light is dark; it keeps logarithms finite.
const DARK: f32 = 1e-30;

struct Integrals {
    // int b T T_light dt of each scatterer: its phase function is missing.
    single: array<vec3<f32>, SCATTERER_SLOTS>,
    // Multiply scattered radiance.
    multiple: vec3<f32>,
}

// A table that nothing reads must not be asked for.
#ifdef MULTIPLE_SCATTERING
fn integrate(ray: AirRay, table: texture_2d_array<f32>) -> Integrals {
#else
fn integrate(ray: AirRay) -> Integrals {
#endif
    var sum: Integrals;
    var tau = vec3<f32>(0.0);
    for (var i = 0u; i < counted(LEG_COUNT); i++) {
        var leg = leg_of(ray, i);
        if leg_is_empty(leg) {
            continue;
        }
        for (var n = 0u; n < NODE_COUNT; n++) {
            let node = leg_advance(&leg, ray, n, &tau);
            let local = local_directions(ray, node);
            var density = densities(node.altitude_m);
#ifdef MULTIPLE_SCATTERING
            let source = multiply_scattered_source(table, node.altitude_m, local, density);
            sum.multiple += node.weight_m * exp(-tau) * source;
#endif
            if leg.dark {
                continue;
            }
            let lit = node.weight_m * exp(-tau - optical_depth_to_top(node.altitude_m, local.mu_s));
            for (var c = 0u; c < SCATTERER_COUNT; c++) {
                sum.single[c] += density[c] * lit;
            }
        }
        leg_finish(&leg, ray, &tau);
    }
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        sum.single[c] *= atmosphere.constituents[c].scattering_per_m;
    }
    return sum;
}

#ifdef FANS
const FAN_COUNT: u32 = #{FAN_COUNT}u;

// Of rays of one zenith angle from one altitude, as columns of a table are, none of which meets the planet's shadow: they pass
// the same air, which is walked once, and differ in how their light comes in.
#ifdef MULTIPLE_SCATTERING
fn integrate_fan(rays: array<AirRay, FAN_COUNT>, table: texture_2d_array<f32>) -> array<Integrals, FAN_COUNT> {
#else
fn integrate_fan(rays: array<AirRay, FAN_COUNT>) -> array<Integrals, FAN_COUNT> {
#endif
    var fan = rays;
    let ray = fan[0];
    var sums: array<Integrals, FAN_COUNT>;
    var tau = vec3<f32>(0.0);
    for (var i = 0u; i < counted(LEG_COUNT); i++) {
        var leg = leg_of(ray, i);
        if leg_is_empty(leg) {
            continue;
        }
        for (var n = 0u; n < NODE_COUNT; n++) {
            let node = leg_advance(&leg, ray, n, &tau);
            let seen = node.weight_m * exp(-tau);
            var density = densities(node.altitude_m);
            for (var k = 0u; k < FAN_COUNT; k++) {
                let local = local_directions(fan[k], node);
#ifdef MULTIPLE_SCATTERING
                sums[k].multiple += seen * multiply_scattered_source(table, node.altitude_m, local, density);
#endif
                let lit = seen * exp(-optical_depth_to_top(node.altitude_m, local.mu_s));
                for (var c = 0u; c < SCATTERER_COUNT; c++) {
                    sums[k].single[c] += density[c] * lit;
                }
            }
        }
        leg_finish(&leg, ray, &tau);
    }
    for (var k = 0u; k < FAN_COUNT; k++) {
        for (var c = 0u; c < SCATTERER_COUNT; c++) {
            sums[k].single[c] *= atmosphere.constituents[c].scattering_per_m;
        }
    }
    return sums;
}
#endif

// Light falls exponentially into the planet's shadow and towards space; its logarithm is what interpolates well.
fn logarithm(light: vec3<f32>) -> vec3<f32> {
    return log(max(light, vec3<f32>(DARK)));
}
