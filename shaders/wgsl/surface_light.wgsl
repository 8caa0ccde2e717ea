#define_import_path welkin::surface_light
// Light that arrives on a surface of any slope, for unit irradiance of the light.
//
// The sky and the ground around are the field of the multiple-scattering table: its spherical harmonics up to degree 2,
// convolved with the cosine (Ramamoorthi & Hanrahan 2001, equation 8), which keeps 99 % of what any field does to a
// Lambertian surface. The result is scaled so that a horizontal surface receives what the table says.
//
// Definitions: MULTIPLE_SCATTERING, AIR, SOURCE_FUNCTION.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::sky::multiple_scattering_table
#import welkin::spherical_harmonics::{degree_of, harmonics, COEFFICIENT_COUNT}
#import welkin::tables::{optical_depth_to_top, table_sampler}
#ifdef SOURCE_FUNCTION
#import welkin::source_grid::{FIRST_HARMONIC_TILE, IRRADIANCE_TILE}
#import welkin::source_table::moment_uv
#else
#import welkin::tables::IRRADIANCE_LAYER
#endif

// Transmittance of the air between a point and a light, times the share of the light's disc above the horizon.
fn light_transmittance(altitude_m: f32, mu_s: f32, radius_rad: f32) -> vec3<f32> {
    let mu_h = horizon_mu(atmosphere.radius_m, altitude_m);
    // Near the horizon cosines differ as angles do; the disc is taken for a strip of its width.
    let above = clamp(0.5 + 0.5 * (mu_s - mu_h) / radius_rad, 0.0, 1.0);
    if above == 0.0 {
        return vec3<f32>(0.0);
    }
#ifdef AIR
    return above * exp(-optical_depth_to_top(altitude_m, max(mu_s, mu_h)));
#else
    return vec3<f32>(above);
#endif
}

#ifdef MULTIPLE_SCATTERING
// How a Lambertian surface weighs each degree of the harmonics.
const TRANSFER: array<f32, 3> = array<f32, 3>(PI, 2.0943951, 0.78539816);

// Where the table holds the field's k-th harmonic over its mean: coordinates and layer.
struct Place {
    uv: vec2<f32>,
    layer: u32,
}

fn place_of_harmonic(k: u32, altitude_m: f32, mu_s: f32) -> Place {
    let size = vec2<f32>(textureDimensions(multiple_scattering_table));
#ifdef SOURCE_FUNCTION
    return Place(moment_uv(FIRST_HARMONIC_TILE + k - 1u, size, altitude_m, mu_s), 0u);
#else
    let unit = mapping::multiple_scattering_to_unit(altitude_m, mu_s, atmosphere.top_m, atmosphere.sun_warp);
    return Place(mapping::inset(unit, size), k);
#endif
}

// Irradiance of the harmonics up to degree 2 over their mean, on a surface whose normal has the zenith cosine mu.
fn relative_irradiance(altitude_m: f32, mu_s: f32, mu: f32, cos_phi: f32) -> vec3<f32> {
    var transfer = TRANSFER;
    var y = harmonics(mu, cos_phi);
    var sum = vec3<f32>(transfer[0] * y[0]);
    for (var k = 1u; k < min(COEFFICIENT_COUNT, 6u); k++) {
        let place = place_of_harmonic(k, altitude_m, mu_s);
        let coefficient = textureSampleLevel(multiple_scattering_table, table_sampler, place.uv, place.layer, 0.0).rgb;
        sum += transfer[degree_of(k)] * y[k] * coefficient;
    }
    return max(sum, vec3<f32>(0.0));
}

fn horizontal_irradiance(altitude_m: f32, mu_s: f32) -> vec3<f32> {
    let size = vec2<f32>(textureDimensions(multiple_scattering_table));
#ifdef SOURCE_FUNCTION
    let place = Place(moment_uv(IRRADIANCE_TILE, size, altitude_m, mu_s), 0u);
#else
    let unit = mapping::multiple_scattering_to_unit(altitude_m, mu_s, atmosphere.top_m, atmosphere.sun_warp);
    let place = Place(mapping::inset(unit, size), IRRADIANCE_LAYER);
#endif
    return exp(textureSampleLevel(multiple_scattering_table, table_sampler, place.uv, place.layer, 0.0).rgb);
}
#endif

// Diffuse irradiance at an altitude under a light of zenith cosine mu_s, on a surface whose normal has the zenith
// cosine mu and the azimuth phi from the light.
fn diffuse_irradiance(altitude_m: f32, mu_s: f32, mu: f32, cos_phi: f32) -> vec3<f32> {
    var irradiance = vec3<f32>(0.0);
#ifdef MULTIPLE_SCATTERING
    let flat = max(relative_irradiance(altitude_m, mu_s, 1.0, 0.0), vec3<f32>(1e-6));
    let tilted = relative_irradiance(altitude_m, mu_s, mu, cos_phi) / flat;
    irradiance = horizontal_irradiance(altitude_m, mu_s) * tilted;
#endif
    return irradiance;
}
