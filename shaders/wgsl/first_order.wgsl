// Pass: light scattered once, or reflected once by the ground, as spherical harmonics at every altitude and sun.
//
// One workgroup per texel, one invocation per direction; for unit irradiance of the light.

#import welkin::atmosphere::{atmosphere, densities, phase_per_sr, PI, SCATTERER_COUNT}
#import welkin::directions::{direction_of, field, irradiance, project, DIRECTION_COUNT, INVOCATION_COUNT}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::march::{
    air_ray, cut_at_shadow, ground_mu_s, leg_advance, leg_finish, leg_is_empty, leg_of, local_directions, AirRay,
    LEG_COUNT, NODE_COUNT
}
#import welkin::spherical_harmonics::COEFFICIENT_COUNT
#import welkin::tables::{direct_ground_irradiance, optical_depth_to_top, IRRADIANCE_LAYER}

@group(0) @binding(6) var first_order: texture_storage_2d_array<rgba32float, write>;

// Below this, light is dark; it keeps logarithms finite.
const DARK: f32 = 1e-30;

fn single_scattering(ray: AirRay, hits_ground: bool) -> vec3<f32> {
    var tau = vec3<f32>(0.0);
    var radiance = vec3<f32>(0.0);
    for (var i = 0u; i < LEG_COUNT; i++) {
        var leg = leg_of(ray, i);
        if leg_is_empty(leg) {
            continue;
        }
        for (var n = 0u; n < NODE_COUNT; n++) {
            let node = leg_advance(&leg, ray, n, &tau);
            if leg.dark {
                continue;
            }
            let mu_s = local_directions(ray, node).mu_s;
            var density = densities(node.altitude_m);
            var source = vec3<f32>(0.0);
            for (var c = 0u; c < SCATTERER_COUNT; c++) {
                source += density[c] * phase_per_sr(c, ray.nu) * atmosphere.constituents[c].scattering_per_m;
            }
            radiance += node.weight_m * source * exp(-tau - optical_depth_to_top(node.altitude_m, mu_s));
        }
        leg_finish(&leg, ray, &tau);
    }
    if hits_ground {
        radiance += exp(-tau) * atmosphere.ground_albedo / PI * direct_ground_irradiance(ground_mu_s(ray));
    }
    return radiance;
}

@compute @workgroup_size(#{INVOCATION_COUNT})
fn main(@builtin(workgroup_id) texel: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let size = vec2<f32>(textureDimensions(first_order));
    let here = mapping::multiple_scattering_from_unit(mapping::unit_from_texel(texel.xy, size), atmosphere.top_m);
    let mu_s = here.mu;
    let mu_h = horizon_mu(atmosphere.radius_m, here.altitude_m);
    for (var i = invocation; i < DIRECTION_COUNT; i += INVOCATION_COUNT) {
        let direction = direction_of(i, mu_h);
        let sines = sqrt(max((1.0 - direction.mu * direction.mu) * (1.0 - mu_s * mu_s), 0.0));
        let nu = clamp(direction.mu * mu_s + sines * direction.cos_phi, -1.0, 1.0);
        let ray = cut_at_shadow(air_ray(here.altitude_m, direction.mu, mu_s, nu, direction.hits_ground));
        field[i] = single_scattering(ray, direction.hits_ground);
    }
    workgroupBarrier();
    for (var k = invocation; k < COEFFICIENT_COUNT; k += INVOCATION_COUNT) {
        let mean = max(project(0u, mu_h), vec3<f32>(DARK));
        let value = select(project(k, mu_h) / mean, log(mean), k == 0u);
        textureStore(first_order, texel.xy, k, vec4<f32>(value, 0.0));
    }
    if invocation == 0u {
        let downward = max(irradiance(mu_h), vec3<f32>(DARK));
        textureStore(first_order, texel.xy, IRRADIANCE_LAYER, vec4<f32>(log(downward), 0.0));
    }
}
