#define_import_path welkin::field_radiance
// The radiance that arrives at a point along a ray, order by order; for unit irradiance of the light.

#import welkin::atmosphere::{atmosphere, densities, phase_per_sr, PI, SCATTERER_COUNT, SCATTERER_SLOTS}
#import welkin::geometry::horizon_mu
#import welkin::loops::counted
#import welkin::march::{
    air_ray, cut_at_shadow, ground_mu_s, leg_advance, leg_finish, leg_is_empty, leg_of, local_directions, AirRay,
    LEG_COUNT, NODE_COUNT
}
#import welkin::tables::{
    diffuse_ground_irradiance, direct_ground_irradiance, multiply_scattered_source, optical_depth_to_top
}

// The ray from a table's texel along (mu, cos_phi), where azimuth 0 points to the light.
fn ray_from(altitude_m: f32, mu_s: f32, mu: f32, cos_phi: f32, hits_ground: bool) -> AirRay {
    let sines = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 0.0));
    let nu = clamp(mu * mu_s + sines * cos_phi, -1.0, 1.0);
    return air_ray(altitude_m, mu, mu_s, nu, hits_ground);
}

// Light scattered once, or reflected once by the ground; with what each scatterer's phase function is along the ray.
fn first_order_radiance(uncut: AirRay, hits_ground: bool, phases_per_sr: array<f32, SCATTERER_SLOTS>) -> vec3<f32> {
    var phase = phases_per_sr;
    let ray = cut_at_shadow(uncut);
    var tau = vec3<f32>(0.0);
    var radiance = vec3<f32>(0.0);
    for (var i = 0u; i < counted(LEG_COUNT); i++) {
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
                source += density[c] * phase[c] * atmosphere.constituents[c].scattering_per_m;
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

// The phase functions at the angle between a ray and the light.
fn phases_along(ray: AirRay) -> array<f32, SCATTERER_SLOTS> {
    var phases_per_sr: array<f32, SCATTERER_SLOTS>;
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        phases_per_sr[c] = phase_per_sr(c, ray.nu);
    }
    return phases_per_sr;
}

// Light of one order more than a table of multiply scattered light holds.
fn next_order_radiance(table: texture_2d_array<f32>, ray: AirRay, hits_ground: bool) -> vec3<f32> {
    var tau = vec3<f32>(0.0);
    var radiance = vec3<f32>(0.0);
    for (var i = 0u; i < counted(LEG_COUNT); i++) {
        var leg = leg_of(ray, i);
        if leg_is_empty(leg) {
            continue;
        }
        for (var n = 0u; n < NODE_COUNT; n++) {
            let node = leg_advance(&leg, ray, n, &tau);
            let local = local_directions(ray, node);
            let density = densities(node.altitude_m);
            let source = multiply_scattered_source(table, node.altitude_m, local, density);
            radiance += node.weight_m * exp(-tau) * source;
        }
        leg_finish(&leg, ray, &tau);
    }
    if hits_ground {
        let irradiance = diffuse_ground_irradiance(table, ground_mu_s(ray));
        radiance += exp(-tau) * atmosphere.ground_albedo / PI * irradiance;
    }
    return radiance;
}
