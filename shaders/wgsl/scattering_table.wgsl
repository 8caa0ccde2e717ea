// Pass: scattered light for every altitude, sun and direction, as engines read it (welkin::pack::scattering_table).
//
// The integrals are the sky view's; phase functions and the length of air are left out for the same reasons. Not part
// of a frame: packs, and engines that bake at run time, dispatch it.

#import welkin::atmosphere::{atmosphere, SCATTERER_COUNT}
#import welkin::geometry::{horizon_mu, precise_acos}
#import welkin::mapping
#import welkin::march::{air_length_m, cut_at_shadow, table_altitude_m, view_ray}
#import welkin::view_integrals::integrate

struct ScatteringLayout {
    // Tiles along x.
    azimuth_count: u32,
    // Columns of a tile.
    sun_count: u32,
    // Slices of a block.
    altitude_count: u32,
    padding: u32,
}

@group(0) @binding(2) var<uniform> scattering_layout: ScatteringLayout;
@group(0) @binding(6) var multiple_scattering_table: texture_2d_array<f32>;
@group(0) @binding(7) var scattering_table: texture_storage_3d<rgba32float, write>;

const LAYER_COUNT: u32 = 1u + SCATTERER_COUNT;

// Light per metre below which all is night: over the longest ray a hundredth of the natural night sky. A floor much lower
// would stand so far from lit texels, in logarithms, that a filter's rounding between them were seen.
const NIGHT: f32 = 1e-16;

fn logarithm(light: vec3<f32>) -> vec3<f32> {
    return log(max(light, vec3<f32>(NIGHT)));
}

// x, y: as in the table; z: (half of the view sphere, altitude).
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = textureDimensions(scattering_table);
    let altitudes = scattering_layout.altitude_count;
    if texel.x >= size.x || texel.y >= size.y || texel.z >= 2u * altitudes {
        return;
    }
    let suns = scattering_layout.sun_count;
    let slice = texel.z % altitudes;
    let below_horizon = texel.z >= altitudes;
    let unit = mapping::unit_from_texel(vec2<u32>(texel.x % suns, slice), vec2<f32>(vec2<u32>(suns, altitudes)));
    let light = mapping::multiple_scattering_from_unit(unit, atmosphere.top_m, atmosphere.sun_warp);
    let altitude_m = table_altitude_m(light.altitude_m);
    let mu_s = light.mu;
    let tile = vec2<u32>(texel.x / suns, texel.y);
    let view_unit = mapping::unit_from_texel(tile, vec2<f32>(vec2<u32>(scattering_layout.azimuth_count, size.y)));
    let range = mapping::SkyViewRange(precise_acos(horizon_mu(atmosphere.radius_m, altitude_m)), 0.0, 1.0, 1.0);
    let view = mapping::sky_view_from_unit(view_unit, below_horizon, range);
    let mu = cos(view.zenith_rad);
    let sines = sin(view.zenith_rad) * sqrt(max(1.0 - mu_s * mu_s, 0.0));
    let nu = clamp(mu * mu_s + sines * cos(view.azimuth_rad), -1.0, 1.0);
    let ray = cut_at_shadow(view_ray(altitude_m, mu, mu_s, nu, below_horizon));
#ifdef MULTIPLE_SCATTERING
    var sum = integrate(ray, multiple_scattering_table);
#else
    var sum = integrate(ray);
#endif
    let per_m = 1.0 / max(air_length_m(altitude_m, mu, below_horizon), 1e-3);
    let block = u32(below_horizon) * LAYER_COUNT;
    let place = vec3<u32>(texel.xy, block * altitudes + slice);
    textureStore(scattering_table, place, vec4<f32>(logarithm(sum.multiple * per_m), 1.0));
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        let above = vec3<u32>(0u, 0u, (1u + c) * altitudes);
        textureStore(scattering_table, place + above, vec4<f32>(logarithm(sum.single[c] * per_m), 1.0));
    }
}
