#define_import_path welkin::tables
// Reading the tables that belong to a medium: optical depth to the top, and multiply scattered light.
//
// Definitions: AIR (there is any); SOURCE_FUNCTION (multiply scattered light is tabulated as a source function, not as
// the field's spherical harmonics); LAYERS (some constituent's density is a layer); HALF_TABLES (most tables are half
// floats).

#import welkin::atmosphere::{
    atmosphere, constituent_of_layer, layer_bounds_m, CONSTITUENT_SLOTS, LAYER_COUNT, SCATTERER_COUNT
}
#import welkin::geometry
#import welkin::mapping
#import welkin::march::LocalDirections
#ifdef SOURCE_FUNCTION
#import welkin::source_grid::{FIRST_HARMONIC_TILE, IRRADIANCE_TILE, MEAN_TILE}
#import welkin::source_table::{moment_uv, tabulated_source}
#endif
#import welkin::spherical_harmonics::{COEFFICIENT_COUNT, DEGREE_COUNT, degree_of, harmonics}

@group(0) @binding(3) var table_sampler: sampler;
// Optical depth from an altitude along a direction to the top, one component per band; without that of layers.
@group(0) @binding(4) var optical_depth_table: texture_2d<f32>;

// chi_l of each scatterer: 2 pi int p P_l dc, row by row.
@group(0) @binding(5) var<storage, read> legendre_moments: array<f32>;

#ifdef LAYERS
// Length of a ray's part below a shell, m.
fn below_shell_m(altitude_m: f32, mu: f32, shell_m: f32) -> f32 {
    if shell_m <= 0.0 {
        return 0.0;
    }
    let cuts_m = geometry::shell_crossings_m(atmosphere.radius_m, altitude_m, mu, shell_m);
    return cuts_m.y - cuts_m.x;
}

// tau of the layers, which have a closed form and whose kinks no table could hold: the table leaves them out.
fn optical_depth_of_layers(altitude_m: f32, mu: f32) -> vec3<f32> {
    var tau = vec3<f32>(0.0);
    for (var layer = 0u; layer < LAYER_COUNT; layer++) {
        let bounds_m = min(layer_bounds_m(layer), vec2<f32>(atmosphere.top_m));
        let length_m = below_shell_m(altitude_m, mu, bounds_m.y) - below_shell_m(altitude_m, mu, bounds_m.x);
        tau += max(length_m, 0.0) * atmosphere.constituents[constituent_of_layer(layer)].extinction_per_m;
    }
    return tau;
}
#endif

// A table that stays in 32-bit floats also where the others are half floats: some devices can only filter the latter.
fn sample_exactly(table: texture_2d<f32>, uv: vec2<f32>) -> vec3<f32> {
#ifdef HALF_TABLES
    let last = vec2<f32>(textureDimensions(table) - 1u);
    let place = clamp(uv * (last + 1.0) - 0.5, vec2<f32>(0.0), last);
    let low = vec2<u32>(place);
    let high = min(low + 1u, vec2<u32>(last));
    let share = place - vec2<f32>(low);
    let bottom = mix(textureLoad(table, low, 0), textureLoad(table, vec2<u32>(high.x, low.y), 0), share.x);
    let top = mix(textureLoad(table, vec2<u32>(low.x, high.y), 0), textureLoad(table, high, 0), share.x);
    return mix(bottom, top, share.y).rgb;
#else
    return textureSampleLevel(table, table_sampler, uv, 0.0).rgb;
#endif
}

// tau from a point to the top along a direction above the horizon.
fn optical_depth_to_top(altitude_m: f32, mu: f32) -> vec3<f32> {
    let unit = mapping::optical_depth_to_unit(altitude_m, mu, atmosphere.radius_m, atmosphere.top_m);
    let uv = mapping::inset(unit, vec2<f32>(textureDimensions(optical_depth_table)));
    let tau = textureSampleLevel(optical_depth_table, table_sampler, uv, 0.0).rgb;
#ifdef LAYERS
    return tau + optical_depth_of_layers(altitude_m, mu);
#else
    return tau;
#endif
}

// Tables of multiply scattered light are of two kinds: welkin::source_table, or they hold, for unit irradiance of the
// light and at each (altitude, mu_s), the spherical-harmonic coefficients of the radiance seen looking along a direction:
// layer 0 is ln I_00, layers (l, m) are I_lm / I_00, and the last is ln of the diffuse irradiance on a horizontal plane.
// The logarithm makes interpolation exact where light falls exponentially: with altitude and into the night.
const IRRADIANCE_LAYER: u32 = COEFFICIENT_COUNT;

// Radiance sent into the view direction per metre, 1/m per unit irradiance: sum_c b_c int p_c I dw'.
fn multiply_scattered_source(
    table: texture_2d_array<f32>,
    altitude_m: f32,
    local: LocalDirections,
    density: array<f32, CONSTITUENT_SLOTS>,
) -> vec3<f32> {
#ifdef SOURCE_FUNCTION
    return tabulated_source(table, table_sampler, altitude_m, local, density);
#else
    let unit = mapping::multiple_scattering_to_unit(altitude_m, local.mu_s, atmosphere.top_m, atmosphere.sun_warp);
    let uv = mapping::inset(unit, vec2<f32>(textureDimensions(table)));
    var y = harmonics(local.mu, local.cos_phi);
    var scattering = scattering_by_degree(density);
    var relative = scattering[0] * y[0];
    for (var k = 1u; k < COEFFICIENT_COUNT; k++) {
        let coefficient = textureSampleLevel(table, table_sampler, uv, k, 0.0).rgb;
        relative += scattering[degree_of(k)] * y[k] * coefficient;
    }
    return max(relative, vec3<f32>(0.0)) * exp(textureSampleLevel(table, table_sampler, uv, 0, 0.0).rgb);
#endif
}

// sum_c b_c chi_l,c at the given densities, 1/m, for each degree l.
fn scattering_by_degree(density: array<f32, CONSTITUENT_SLOTS>) -> array<vec3<f32>, DEGREE_COUNT> {
    var scattering: array<vec3<f32>, DEGREE_COUNT>;
    for (var i = 0u; i < SCATTERER_COUNT; i++) {
        let b = density[i] * atmosphere.constituents[i].scattering_per_m;
        for (var l = 0u; l < DEGREE_COUNT; l++) {
            scattering[l] += legendre_moments[i * DEGREE_COUNT + l] * b;
        }
    }
    return scattering;
}

// Diffuse irradiance on horizontal ground per unit irradiance of the light.
fn diffuse_ground_irradiance(table: texture_2d_array<f32>, mu_s: f32) -> vec3<f32> {
#ifdef SOURCE_FUNCTION
    let uv = moment_uv(IRRADIANCE_TILE, vec2<f32>(textureDimensions(table)), 0.0, mu_s);
    return exp(textureSampleLevel(table, table_sampler, uv, 0, 0.0).rgb);
#else
    let unit = mapping::multiple_scattering_to_unit(0.0, mu_s, atmosphere.top_m, atmosphere.sun_warp);
    let uv = mapping::inset(unit, vec2<f32>(textureDimensions(table)));
    return exp(textureSampleLevel(table, table_sampler, uv, IRRADIANCE_LAYER, 0.0).rgb);
#endif
}

// The field's mean radiance over all directions per unit irradiance of the light, and I_10 / I_00: how much more of it
// comes from above than from below.
struct MeanField {
    radiance: vec3<f32>,
    tilt: vec3<f32>,
}

fn mean_field(table: texture_2d_array<f32>, altitude_m: f32, mu_s: f32) -> MeanField {
    let size = vec2<f32>(textureDimensions(table));
    var field: MeanField;
#ifdef SOURCE_FUNCTION
    let uv = moment_uv(MEAN_TILE, size, altitude_m, mu_s);
    let tilt_uv = moment_uv(FIRST_HARMONIC_TILE, size, altitude_m, mu_s);
    field.radiance = exp(textureSampleLevel(table, table_sampler, uv, 0, 0.0).rgb);
    field.tilt = textureSampleLevel(table, table_sampler, tilt_uv, 0, 0.0).rgb;
#else
    let unit = mapping::multiple_scattering_to_unit(altitude_m, mu_s, atmosphere.top_m, atmosphere.sun_warp);
    let uv = mapping::inset(unit, size);
    // Y_00: the mean of I_00 Y_00.
    field.radiance = 0.282094792 * exp(textureSampleLevel(table, table_sampler, uv, 0, 0.0).rgb);
#if DEGREE_COUNT >= 3
    field.tilt = textureSampleLevel(table, table_sampler, uv, 1, 0.0).rgb;
#endif
#endif
    return field;
}

// Direct irradiance on horizontal ground per unit irradiance of the light.
fn direct_ground_irradiance(mu_s: f32) -> vec3<f32> {
    if mu_s <= 0.0 {
        return vec3<f32>(0.0);
    }
#ifdef AIR
    return mu_s * exp(-optical_depth_to_top(0.0, mu_s));
#else
    return vec3<f32>(mu_s);
#endif
}
