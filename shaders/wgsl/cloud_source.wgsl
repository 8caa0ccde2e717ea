#define_import_path welkin::cloud_source
// Light that a cloud's droplets send towards the observer.
//
// Legend
//   term     one summand of the directional lights' part: P_k(nu) int sigma e^(-a_k (tau_light + tau_view)) ds. Single
//            scattering has one with a = 1, octaves and bands several: only the numbers differ
//   nu       cosine of the angle between view direction and light
//
// Definitions: CLOUD_NEAR_SAMPLES, looked at between a sample and where the grid of depths takes over; CLOUD_TERM_COUNT; CLOUD_ORDINATES (light scattered many times is
// solved for), of the light ORDINATES_LIGHT.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::cloud_field::{cloud_layers, layer_density, CLOUD_LAYER_COUNT, CLOUD_LAYER_SLOTS}
#import welkin::cloud_grid::{cell_m, grid_sample, level_of, local_direction, Part}
#import welkin::cloud_matter::{cloud_matter, CloudMatter}
#import welkin::geometry::horizon_mu
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::ordinates_light::scattered_light
#import welkin::phase::{lobe_per_sr, PhaseLobe}
#import welkin::sky::multiple_scattering_table
#import welkin::tables::{mean_field, optical_depth_to_top, table_sampler}

const TERM_COUNT: u32 = #{CLOUD_TERM_COUNT}u;
const TERM_LOBES: u32 = 4u;
#ifdef CLOUD_ORDINATES
const ORDINATES_LIGHT: u32 = #{ORDINATES_LIGHT}u;
#endif

struct CloudTerm {
    // a_k.
    attenuation: f32,
    padding_a: f32,
    padding_b: f32,
    padding_c: f32,
    // P_k; scales may be negative.
    lobes: array<PhaseLobe, TERM_LOBES>,
}

// Layer by layer.
@group(1) @binding(7) var<storage, read> cloud_terms: array<CloudTerm>;
// Optical depths to each light, to the layer's top and to its base.
@group(1) @binding(9) var cloud_light_image: texture_3d<f32>;

const PHASE_COUNT: u32 = CLOUD_LAYER_SLOTS * LIGHT_COUNT * TERM_COUNT;

// P_k of every layer, light and term for a view direction: they do not change along a ray.
fn phases(view: vec3<f32>) -> array<f32, PHASE_COUNT> {
    var all: array<f32, PHASE_COUNT>;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        for (var light = 0u; light < LIGHT_COUNT; light++) {
            let nu = clamp(dot(view, observer.lights[light].direction), -1.0, 1.0);
            for (var k = 0u; k < TERM_COUNT; k++) {
                var sum = 0.0;
                for (var i = 0u; i < TERM_LOBES; i++) {
                    sum += lobe_per_sr(cloud_terms[layer * TERM_COUNT + k].lobes[i], nu);
                }
                all[(layer * LIGHT_COUNT + light) * TERM_COUNT + k] = sum;
            }
        }
    }
    return all;
}

// A sample of a layer on a ray.
struct Sample {
    layer: u32,
    map: vec2<f32>,
    height: f32,
    altitude_m: f32,
    // Unit vector from the planet's centre.
    up: vec3<f32>,
    // Optical depth of clouds from the observer to the sample's step, and of the step.
    before: f32,
    step: f32,
}

// int e^(-a tau) dtau over the step.
fn seen(sample: Sample, attenuation: f32) -> f32 {
    let a = max(attenuation, 1e-4);
    return exp(-a * sample.before) * (1.0 - exp(-a * sample.step)) / a;
}

// Irradiance of a light above the clouds at a point: attenuated by the air, hidden by the planet.
fn light_in_air(light: u32, altitude_m: f32, mu_s: f32) -> vec3<f32> {
    if mu_s < horizon_mu(atmosphere.radius_m, altitude_m) {
        return vec3<f32>(0.0);
    }
#ifdef AIR
    return observer.lights[light].irradiance * exp(-optical_depth_to_top(altitude_m, mu_s));
#else
    return observer.lights[light].irradiance;
#endif
}

// The diffuse field of the air at an altitude: radiance from above and from below, each as the mean of its half.
struct Surroundings {
    above: vec3<f32>,
    below: vec3<f32>,
}

fn surroundings(altitude_m: f32, mu_s: f32, irradiance: vec3<f32>) -> Surroundings {
    var around: Surroundings;
#ifdef MULTIPLE_SCATTERING
    let field = mean_field(multiple_scattering_table, altitude_m, mu_s);
    // Over a half sphere the first zonal harmonic's mean is half its value at the pole: √3 / 2 in units of the mean.
    let tilt = 0.866025404 * field.tilt;
    around.above = irradiance * field.radiance * max(1.0 + tilt, vec3<f32>(0.0));
    around.below = irradiance * field.radiance * max(1.0 - tilt, vec3<f32>(0.0));
#endif
    return around;
}

// Light of the air behind the step that droplets scatter by small angles only, as a share: e^(-q tau) - e^(-tau).
fn nearly_straight(sample: Sample, matter: CloudMatter) -> f32 {
    let before = exp(-matter.similarity * sample.before) - exp(-sample.before);
    let after = sample.before + sample.step;
    return exp(-matter.similarity * after) - exp(-after) - before;
}

const NEAR_SAMPLES: u32 = #{CLOUD_NEAR_SAMPLES}u;
// Where the grid takes over, in its cells: closer, it cannot tell a cloud's edge from its core.
const NEAR_CELLS: f32 = 1.25;

// Optical depth of clouds from a sample to a light.
fn depth_to_light(sample: Sample, light: u32) -> f32 {
    let layer = sample.layer;
    let toward = local_direction(sample.map, observer.lights[light].direction);
    let near_m = select(0.0, NEAR_CELLS * cell_m(level_of(sample.map)), NEAR_SAMPLES > 0u);
    var near = 0.0;
    for (var i = 0u; i < NEAR_SAMPLES; i++) {
        let t_m = near_m * (f32(i) + 0.5) / f32(NEAR_SAMPLES);
        near += layer_density(layer, sample.map + toward.xy * t_m, sample.altitude_m + toward.z * t_m);
    }
    near *= cloud_layers[layer].extinction_per_m * near_m / max(f32(NEAR_SAMPLES), 1.0);
    let height = sample.height + toward.z * near_m / cloud_layers[layer].thickness_m;
    let map = sample.map + toward.xy * near_m;
    let far = grid_sample(cloud_light_image, table_sampler, Part(light, LIGHT_COUNT), layer, map, height).x;
#if CLOUD_LAYER_COUNT > 1
    return near + far;
#else
    return near + select(0.0, far, height <= 1.0);
#endif
}

// What clouds leave of the light above them at a point of the air or the ground.
struct Daylight {
    // Of the first light's beam, what passes straight or nearly so.
    straight: f32,
    // Of the beam's flux through a horizontal plane, all that passes, in any direction.
    through: f32,
    // Of the sky's light.
    diffuse: f32,
}

// By two streams in the similar medium (Joseph, Wiscombe & Weinman 1976): of a beam with cosine mu
// ((2/3 + mu) + (2/3 - mu) e^(-q tau)) / (4/3 + (1 - g) mu tau), of diffuse light 1 / (1 + 3/4 (1 - g) tau).
fn daylight(map: vec2<f32>, altitude_m: f32) -> Daylight {
    let toward = local_direction(map, observer.lights[0].direction);
    let mu = max(toward.z, 0.0);
    var day = Daylight(1.0, 1.0, 1.0);
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let up_m = altitude_m - cloud_layers[layer].base_m;
        if up_m > cloud_layers[layer].thickness_m {
            continue;
        }
        // Below the base the light is followed up to it.
        let along_m = max(-up_m, 0.0) / max(toward.z, 0.02);
        let height = max(up_m, 0.0) / cloud_layers[layer].thickness_m;
        let part = Part(0u, LIGHT_COUNT);
        let beam = grid_sample(cloud_light_image, table_sampler, part, layer, map + toward.xy * along_m, height).x;
        let above = grid_sample(cloud_light_image, table_sampler, part, layer, map, height).y;
        let matter = cloud_matter[layer];
        let straight = exp(-matter.similarity * beam);
        let through = (2.0 / 3.0 + mu + (2.0 / 3.0 - mu) * straight) / (4.0 / 3.0 + matter.backward * mu * beam);
        day.straight = min(day.straight, straight);
        day.through = min(day.through, max(through, straight));
        day.diffuse = min(day.diffuse, 1.0 / (1.0 + 0.75 * matter.backward * above));
    }
    return day;
}

// The first light's fluxes through a horizontal plane in clear air: its beam, the sky's light from above and what comes
// from below, over the sum of the last two.
struct ClearFluxes {
    beam: vec3<f32>,
    sky: vec3<f32>,
    below: vec3<f32>,
}

fn clear_fluxes(altitude_m: f32, mu_s: f32) -> ClearFluxes {
    let around = surroundings(altitude_m, mu_s, observer.lights[0].irradiance);
    let diffuse = max(PI * (around.above + around.below), vec3<f32>(1e-20));
    let beam = max(mu_s, 0.0) * light_in_air(0u, altitude_m, mu_s);
    return ClearFluxes(beam / diffuse, PI * around.above / diffuse, PI * around.below / diffuse);
}

// Diffuse light relative to that in clear air: what is left of the sky's, what clouds make of the beam, and the ground's,
// which follows both.
fn diffuse_share(day: Daylight, clear: ClearFluxes) -> vec3<f32> {
    let on_ground = (day.through * clear.beam + day.diffuse * clear.sky) / max(clear.beam + clear.sky, vec3<f32>(1e-20));
    return day.diffuse * clear.sky + (day.through - day.straight) * clear.beam + on_ground * clear.below;
}

// Radiance that a step adds, before the air in front of it.
fn step_radiance(
    sample: Sample, view: vec3<f32>, phase: ptr<function, array<f32, PHASE_COUNT>>
) -> vec3<f32> {
    let matter = cloud_matter[sample.layer];
    var radiance = vec3<f32>(0.0);
#ifdef CLOUD_ORDINATES
    let local_view = vec3<f32>(view.xy, dot(view, sample.up));
    let solved = scattered_light(vec3<f32>(sample.map, sample.altitude_m), local_view, table_sampler);
#endif
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let mu_s = dot(sample.up, observer.lights[light].direction);
        let to_light = depth_to_light(sample, light);
        var directional = 0.0;
        for (var k = 0u; k < TERM_COUNT; k++) {
            let a = cloud_terms[sample.layer * TERM_COUNT + k].attenuation;
            let p = (*phase)[(sample.layer * LIGHT_COUNT + light) * TERM_COUNT + k];
            directional += p * exp(-a * to_light) * seen(sample, a);
        }
        let around = surroundings(sample.altitude_m, mu_s, observer.lights[light].irradiance);
#ifdef CLOUD_ORDINATES
        let weight = matter.similarity * seen(sample, matter.similarity);
        if light == ORDINATES_LIGHT {
            directional += weight * solved.x;
        }
        radiance += weight * solved.y * around.above;
        radiance += nearly_straight(sample, matter) * select(around.below, around.above, dot(view, sample.up) > 0.0);
#else
        let depths = grid_sample(
            cloud_light_image, table_sampler, Part(light, LIGHT_COUNT), sample.layer, sample.map, sample.height
        );
        // Diffuse light through a layer of conservative scatterers, by two streams: 1 / (1 + 3/4 (1 - g) tau).
        let through = 1.0 / (1.0 + 0.75 * matter.backward * depths.yz);
        radiance += 0.5 * seen(sample, 1.0) * (around.above * through.x + around.below * through.y);
#endif
        radiance += directional * light_in_air(light, sample.altitude_m, mu_s);
    }
    return matter.albedo * radiance;
}
