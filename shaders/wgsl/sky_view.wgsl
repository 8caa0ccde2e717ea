// Pass: the integrals that the sky seen from one point is made of, for every direction and light.
//
// Phase functions depend on a pixel's angle from the light alone, so they are left out here and applied exactly, per
// pixel, by welkin::sky: what remains is smooth, and a small table is enough even around the sun. So are the length of
// air that a ray passes, whose kink at the horizontal and zero at the air's limb no table could hold, and the planet's
// shadow on it: see welkin::shade.

#import welkin::atmosphere::SCATTERER_COUNT
#import welkin::disc::{beam_count, beam_mu_s, beam_weight}
#import welkin::mapping
#import welkin::march::{air_length_m, cut_at_shadow, table_altitude_m, view_ray}
#import welkin::observer::{light_mu_s, observer}
#import welkin::shade::ln_lit_share
#import welkin::sky::{layer_of, LN_SCALE, multiple_scattering_table, MULTIPLE_LAYER, SINGLE_LAYER}
#import welkin::view_integrals::{integrate, logarithm, Integrals, DARK}

#ifdef HALF_TABLES
@group(0) @binding(8) var sky_view_image: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(8) var sky_view_image: texture_storage_2d_array<rgba32float, write>;
#endif

// Cosine of the angle between a view and a light.
fn nu_of(view: mapping::ZenithAzimuth, mu_s: f32) -> f32 {
    let sines = sin(view.zenith_rad) * sqrt(max(1.0 - mu_s * mu_s, 0.0));
    return clamp(cos(view.zenith_rad) * mu_s + sines * cos(view.azimuth_rad), -1.0, 1.0);
}

// x, y: direction; z: which half of the view sphere, of which light.
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = textureDimensions(sky_view_image);
    if any(texel.xy >= size) {
        return;
    }
    let light = texel.z / 2u;
    let below_horizon = texel.z % 2u == 1u;
    let unit = mapping::unit_from_texel(texel.xy, vec2<f32>(size));
    let view = mapping::sky_view_from_unit(unit, below_horizon, observer.view);
    let mu = cos(view.zenith_rad);
    let altitude_m = table_altitude_m(observer.altitude_m);
    var sum: Integrals;
    for (var beam = 0u; beam < beam_count(light); beam++) {
        let mu_s = beam_mu_s(light, beam, light_mu_s(light));
        let ray = cut_at_shadow(view_ray(altitude_m, mu, mu_s, nu_of(view, mu_s), below_horizon));
#ifdef MULTIPLE_SCATTERING
        var part = integrate(ray, multiple_scattering_table);
#else
        var part = integrate(ray);
#endif
        let weight = beam_weight(light, beam);
        sum.multiple += weight * part.multiple;
        for (var c = 0u; c < SCATTERER_COUNT; c++) {
            sum.single[c] += weight * part.single[c];
        }
    }
    let per_m = 1.0 / max(air_length_m(altitude_m, mu, below_horizon), 1e-3);
    let first = layer_of(light, below_horizon);
    let multiple = logarithm(sum.multiple * per_m) + LN_SCALE;
    textureStore(sky_view_image, texel.xy, first + MULTIPLE_LAYER, vec4<f32>(multiple, 0.0));
    let to_middle = view_ray(altitude_m, mu, light_mu_s(light), nu_of(view, light_mu_s(light)), below_horizon);
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        // Where all is dark the share says nothing.
        let is_lit = sum.single[c] * per_m > vec3<f32>(DARK);
        let share = select(vec3<f32>(0.0), vec3<f32>(ln_lit_share(light, to_middle, c)), is_lit);
        let single = logarithm(sum.single[c] * per_m) + LN_SCALE - share;
        textureStore(sky_view_image, texel.xy, first + SINGLE_LAYER + c, vec4<f32>(single, 0.0));
    }
}
