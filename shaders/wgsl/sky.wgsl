#define_import_path welkin::sky
// The sky in one direction, from the sky-view table.
//
// The table's layers, for each light and each half of the view sphere: optical depth along the ray, multiply
// scattered radiance, then for each scatterer its single scattering without the phase function. All for unit
// irradiance of the light.

#import welkin::atmosphere::{atmosphere, phase_per_sr, PI, SCATTERER_COUNT}
#import welkin::mapping
#import welkin::march::{ground_mu_s, view_ray}
#import welkin::observer::{light_mu_s, observer}
#import welkin::tables::{diffuse_ground_irradiance, direct_ground_irradiance, table_sampler}

const OPTICAL_DEPTH_LAYER: u32 = 0u;
const MULTIPLE_LAYER: u32 = 1u;
const SINGLE_LAYER: u32 = 2u;
const LAYER_COUNT: u32 = SINGLE_LAYER + SCATTERER_COUNT;

// The first layer of a light's half sphere.
fn layer_of(light: u32, below_horizon: bool) -> u32 {
    return LAYER_COUNT * (2u * light + u32(below_horizon));
}

// A direction as the sky-view table knows it.
struct SkyDirection {
    zenith_rad: f32,
    // From the light's azimuth, in [0, pi].
    azimuth_rad: f32,
    // Cosine of the angle to the light.
    nu: f32,
    below_horizon: bool,
}

struct SkySample {
    // Radiance of the air along the ray, 1/sr: per unit irradiance of the light.
    radiance: vec3<f32>,
    transmittance: vec3<f32>,
}

fn sky_sample(table: texture_2d_array<f32>, light: u32, direction: SkyDirection) -> SkySample {
    let unit = mapping::sky_view_to_unit(
        direction.zenith_rad, direction.azimuth_rad, direction.below_horizon, observer.range
    );
    let uv = mapping::inset(unit, vec2<f32>(textureDimensions(table)));
    let first = layer_of(light, direction.below_horizon);
    var sample: SkySample;
    sample.transmittance = exp(-textureSampleLevel(table, table_sampler, uv, first + OPTICAL_DEPTH_LAYER, 0.0).rgb);
    sample.radiance = textureSampleLevel(table, table_sampler, uv, first + MULTIPLE_LAYER, 0.0).rgb;
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        let single = textureSampleLevel(table, table_sampler, uv, first + SINGLE_LAYER + c, 0.0).rgb;
        sample.radiance += phase_per_sr(c, direction.nu) * single;
    }
    return sample;
}

// Radiance that leaves the ground where a view ray meets it, 1/sr: per unit irradiance of the light.
fn ground_radiance(table: texture_2d_array<f32>, light: u32, direction: SkyDirection) -> vec3<f32> {
    let mu_s = light_mu_s(light);
    let ray = view_ray(observer.altitude_m, cos(direction.zenith_rad), mu_s, direction.nu, true);
    let ground_mu_s = ground_mu_s(ray);
    let irradiance = direct_ground_irradiance(ground_mu_s) + diffuse_ground_irradiance(table, ground_mu_s);
    return atmosphere.ground_albedo / PI * irradiance;
}
