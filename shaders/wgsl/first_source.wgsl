// Pass: the source function of light scattered once, or reflected once by the ground, at every altitude and sun.
//
// One workgroup per (altitude, mu_s), one invocation per direction; for unit irradiance of the light.

#import welkin::atmosphere::atmosphere
#import welkin::convolution::{
    field, harmonic_of_field, keep_direction, keep_moment, positive, LOGARITHM_COUNT, MOMENT_COUNT
}
#import welkin::field_radiance::{first_order_radiance, ray_from}
#import welkin::geometry::horizon_mu
#import welkin::glow::phases_towards
#import welkin::mapping
#import welkin::source_grid::{
    direction_of, moment_texel, DIRECTION_COUNT, FIRST_HARMONIC_TILE, HARMONIC_COUNT, TILE_SIZE
}

const INVOCATION_COUNT: u32 = #{GRID_INVOCATION_COUNT}u;

#ifdef HALF_TABLES
@group(0) @binding(6) var first_source: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(6) var first_source: texture_storage_2d_array<rgba32float, write>;
#endif

// Below this, light is dark; it keeps logarithms finite.
const DARK: f32 = 1e-30;

fn store(texel: vec2<u32>, layer: u32, value: vec3<f32>) {
    textureStore(first_source, texel, layer, vec4<f32>(log(max(value, vec3<f32>(DARK))), 0.0));
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
        field[i] = first_order_radiance(ray, direction.hits_ground, phases_towards(i, mu_h, here.mu));
    }
    workgroupBarrier();
    if invocation < MOMENT_COUNT {
        keep_moment(invocation);
    }
    workgroupBarrier();
    for (var i = invocation; i < LOGARITHM_COUNT; i += INVOCATION_COUNT) {
        var found = positive(i, texel.xy);
        for (var layer = 0u; layer < found.layer_count; layer++) {
            store(found.texel, layer, found.values[layer]);
        }
    }
    if invocation < HARMONIC_COUNT {
        let place = moment_texel(FIRST_HARMONIC_TILE + invocation, texel.xy);
        textureStore(first_source, place, 0u, vec4<f32>(harmonic_of_field(invocation + 1u), 0.0));
    }
}
