// Pass: light scattered once, or reflected once by the ground, as spherical harmonics at every altitude and sun.
//
// One workgroup per texel, one invocation per direction; for unit irradiance of the light.

#import welkin::atmosphere::atmosphere
#import welkin::directions::{direction_of, field, irradiance, keep_ring_sums, project, DIRECTION_COUNT, INVOCATION_COUNT}
#import welkin::field_radiance::{first_order_radiance, phases_along, ray_from}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::tables::IRRADIANCE_LAYER

#ifdef HALF_TABLES
@group(0) @binding(6) var first_order: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(6) var first_order: texture_storage_2d_array<rgba32float, write>;
#endif

// Below this, light is dark; it keeps logarithms finite.
const DARK: f32 = 1e-30;

@compute @workgroup_size(#{INVOCATION_COUNT})
fn main(@builtin(workgroup_id) texel: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let size = vec2<f32>(textureDimensions(first_order));
    let unit = mapping::unit_from_texel(texel.xy, size);
    let here = mapping::multiple_scattering_from_unit(unit, atmosphere.top_m, atmosphere.sun_warp);
    let mu_s = here.mu;
    let mu_h = horizon_mu(atmosphere.radius_m, here.altitude_m);
    for (var i = invocation; i < DIRECTION_COUNT; i += INVOCATION_COUNT) {
        let direction = direction_of(i, mu_h);
        let ray = ray_from(here.altitude_m, mu_s, direction.mu, direction.cos_phi, direction.hits_ground);
        field[i] = first_order_radiance(ray, direction.hits_ground, phases_along(ray));
    }
    workgroupBarrier();
    keep_ring_sums(invocation, mu_h);
    workgroupBarrier();
    let mean = max(project(0u, mu_h), vec3<f32>(DARK));
    for (var layer = invocation; layer <= IRRADIANCE_LAYER; layer += INVOCATION_COUNT) {
        var value = log(mean);
        if layer == IRRADIANCE_LAYER {
            value = log(max(irradiance(mu_h), vec3<f32>(DARK)));
        } else if layer > 0u {
            value = project(layer, mu_h) / mean;
        }
        textureStore(first_order, texel.xy, layer, vec4<f32>(value, 0.0));
    }
}
