// Pass: multiply scattered light as a geometric series of isotropic orders, at every altitude and sun.
//
// Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", CGF 39, section 5.5: light of
// the second order L_2 is the mean over directions of light that was scattered once, isotropically, or reflected by the
// ground (his eq. 5); every later order is the one before times f, the mean share of unit light from everywhere around
// that scatters towards the point (eqs. 7 and 8); so all of them are L_2 / (1 - f) (eqs. 9 and 10). Diffuse irradiance, which
// he leaves out, is that of the same light: first order plus the series' light scattered once more towards the point.
//
// One workgroup per texel, one invocation per direction; for unit irradiance of the light. The result is laid out as
// spherical harmonics of degree 0.

#import welkin::atmosphere::{atmosphere, densities, PI, SCATTERER_COUNT}
#import welkin::directions::{
    direction_of, field, irradiance, project, AZIMUTH_COUNT, COSINE_COUNT, DIRECTION_COUNT, INVOCATION_COUNT
}
#import welkin::field_radiance::ray_from
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::march::{
    cut_at_shadow, ground_mu_s, leg_advance, leg_finish, leg_is_empty, leg_of, local_directions, AirRay, LEG_COUNT,
    NODE_COUNT
}
#import welkin::tables::{direct_ground_irradiance, optical_depth_to_top, IRRADIANCE_LAYER}

#ifdef HALF_TABLES
@group(0) @binding(6) var isotropic_series: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(6) var isotropic_series: texture_storage_2d_array<rgba32float, write>;
#endif

// Below this, light is dark; it keeps logarithms finite.
const DARK: f32 = 1e-30;

struct Along {
    // Light scattered once by isotropic air, or reflected by the ground.
    radiance: vec3<f32>,
    // What unit radiance from everywhere becomes.
    transfer: vec3<f32>,
}

fn isotropic_along(ray: AirRay, hits_ground: bool) -> Along {
    var sum: Along;
    var tau = vec3<f32>(0.0);
    for (var i = 0u; i < LEG_COUNT; i++) {
        var leg = leg_of(ray, i);
        if leg_is_empty(leg) {
            continue;
        }
        for (var n = 0u; n < NODE_COUNT; n++) {
            let node = leg_advance(&leg, ray, n, &tau);
            var density = densities(node.altitude_m);
            var scattering = vec3<f32>(0.0);
            for (var c = 0u; c < SCATTERER_COUNT; c++) {
                scattering += density[c] * atmosphere.constituents[c].scattering_per_m;
            }
            let transfer = node.weight_m * scattering * exp(-tau);
            sum.transfer += transfer;
            if !leg.dark {
                let mu_s = local_directions(ray, node).mu_s;
                sum.radiance += transfer * exp(-optical_depth_to_top(node.altitude_m, mu_s)) / (4.0 * PI);
            }
        }
        leg_finish(&leg, ray, &tau);
    }
    if hits_ground {
        sum.radiance += exp(-tau) * atmosphere.ground_albedo / PI * direct_ground_irradiance(ground_mu_s(ray));
    }
    return sum;
}

@compute @workgroup_size(#{INVOCATION_COUNT})
fn main(@builtin(workgroup_id) texel: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let size = vec2<f32>(textureDimensions(isotropic_series));
    let unit = mapping::unit_from_texel(texel.xy, size);
    let here = mapping::multiple_scattering_from_unit(unit, atmosphere.top_m, atmosphere.sun_warp);
    let mu_h = horizon_mu(atmosphere.radius_m, here.altitude_m);
    for (var i = invocation; i < DIRECTION_COUNT; i += INVOCATION_COUNT) {
        let direction = direction_of(i, mu_h);
        let ray = ray_from(here.altitude_m, here.mu, direction.mu, direction.cos_phi, direction.hits_ground);
        field[i] = isotropic_along(cut_at_shadow(ray), direction.hits_ground).radiance;
    }
    workgroupBarrier();
    var second_order = vec3<f32>(0.0);
    var first_irradiance = vec3<f32>(0.0);
    if invocation == 0u {
        second_order = project(0u, mu_h);
        first_irradiance = irradiance(mu_h);
    }
    workgroupBarrier();
    // Unit light from everywhere is the same at every azimuth: one ray for each cosine.
    for (var j = invocation; j < COSINE_COUNT; j += INVOCATION_COUNT) {
        let direction = direction_of(j * AZIMUTH_COUNT, mu_h);
        let ray = ray_from(here.altitude_m, here.mu, direction.mu, direction.cos_phi, direction.hits_ground);
        let transfer = isotropic_along(ray, direction.hits_ground).transfer;
        for (var k = 0u; k < AZIMUTH_COUNT; k++) {
            field[j * AZIMUTH_COUNT + k] = transfer;
        }
    }
    workgroupBarrier();
    if invocation == 0u {
        // Coefficients of Y_00: a mean over directions is one of them times Y_00.
        let y = sqrt(0.25 / PI);
        let series = second_order / (1.0 - y * project(0u, mu_h));
        let downward = first_irradiance + y * series * irradiance(mu_h);
        let texels = array<vec3<f32>, 2>(log(max(series, vec3<f32>(DARK))), log(max(downward, vec3<f32>(DARK))));
        textureStore(isotropic_series, texel.xy, 0u, vec4<f32>(texels[0], 0.0));
        textureStore(isotropic_series, texel.xy, IRRADIANCE_LAYER, vec4<f32>(texels[1], 0.0));
    }
}
