#define_import_path welkin::cloud_source
// Light that a cloud's droplets send towards the observer.
//
// Legend
//   term     one summand of the directional lights' part: P_k(nu) int sigma e^(-a_k (tau_light + tau_view)) ds. Single
//            scattering has one with a = 1, octaves and bands several: only the numbers differ
//   nu       cosine of the angle between view direction and light
//
// Definitions: CLOUD_NEAR_SAMPLES, looked at between a sample and where cached depths take over; CLOUD_TERM_COUNT; CLOUD_ORDINATES (light scattered many times is
// solved for), of the light ORDINATES_LIGHT.

#import welkin::cloud_daylight::{cloud_light_image, light_in_air, surroundings}
#import welkin::cloud_field::{cloud_layers, layer_density, CLOUD_LAYER_COUNT, CLOUD_LAYER_SLOTS}
#import welkin::cloud_grid::{cell_m, grid_sample, level_of, local_direction, Part}
#import welkin::cloud_matter::{cloud_matter, similar_share, CloudMatter}
#import welkin::loops::counted
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::ordinates_light::{depth_to_sun, levels_at, scattered_light, texel_width_m}
#import welkin::phase::{lobe_per_sr, PhaseLobe}
#import welkin::tables::table_sampler

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

// What droplets send, and of the light behind the step the share that they scatter by small angles only, where what is behind
// is left to who asks: air that a view ray rises through.
struct CloudLight {
    radiance: vec3<f32>,
    passed: f32,
}

// Light behind the step that droplets scatter by small angles only, as a share: e^(-q tau) - e^(-tau).
fn nearly_straight(sample: Sample, matter: CloudMatter) -> f32 {
    let before = exp(-matter.similarity * sample.before) - exp(-sample.before);
    let after = sample.before + sample.step;
    return exp(-matter.similarity * after) - exp(-after) - before;
}

const NEAR_SAMPLES: u32 = #{CLOUD_NEAR_SAMPLES}u;
// Where the grid of depths takes over, in its cells: closer, it cannot tell a cloud's edge from its core. The stretches of
// the samples grow with the distance: what dims most lies close, and in wide cells equal stretches would step over it.
const NEAR_CELLS: f32 = 2.5;
#ifdef CLOUD_ORDINATES
// The same for the light of the ordinates, whose texels hold a depth of their own.
const NEAR_TEXELS: f32 = 5.0;
#endif

// Of what a layer has within a distance towards a light.
fn depth_nearby(sample: Sample, toward: vec3<f32>, near_m: f32) -> f32 {
    var depth = 0.0;
    for (var i = 0u; i < counted(NEAR_SAMPLES); i++) {
        let edges = vec2<f32>(f32(i), f32(i + 1u)) / f32(NEAR_SAMPLES);
        let from_to_m = near_m * edges * edges;
        let t_m = 0.5 * (from_to_m.x + from_to_m.y);
        let density = layer_density(sample.layer, sample.map + toward.xy * t_m, sample.altitude_m + toward.z * t_m);
        depth += density * (from_to_m.y - from_to_m.x);
    }
    return depth * cloud_layers[sample.layer].extinction_per_m;
}

// Of what lies beyond the distance: from the grid of depths.
fn depth_beyond(sample: Sample, toward: vec3<f32>, near_m: f32, light: u32) -> f32 {
    let layer = sample.layer;
    let map = sample.map + toward.xy * near_m;
    let height = sample.height + toward.z * near_m / cloud_layers[layer].thickness_m;
    let far = grid_sample(cloud_light_image, table_sampler, Part(light, LIGHT_COUNT), layer, map, height).x;
#if CLOUD_LAYER_COUNT > 1
    return far;
#else
    return select(0.0, far, height <= 1.0);
#endif
}

// Optical depth of clouds from a sample to a light. The grid of depths holds means over its cells, which are too dark behind
// lumps and at the edges of shadows: for the light that has one, the ordinates' depth is taken, with all layers' matter taken
// for this one's. From `takeover_m` on, cached depths count; nearer, the field itself is looked at.
fn depth_to_light(sample: Sample, light: u32, takeover_m: f32) -> f32 {
    let toward = local_direction(sample.map, observer.lights[light].direction);
    let near_m = select(0.0, takeover_m, NEAR_SAMPLES > 0u);
    let near = depth_nearby(sample, toward, near_m);
#ifdef CLOUD_ORDINATES
    if light == ORDINATES_LIGHT {
        let similar = depth_to_sun(vec3<f32>(sample.map, sample.altitude_m) + near_m * toward, table_sampler);
        return near + similar / similar_share(cloud_matter[sample.layer]);
    }
#endif
    return near + depth_beyond(sample, toward, near_m, light);
}

// Light of a step, before the air in front of it.
fn step_light(sample: Sample, view: vec3<f32>, phase: ptr<function, array<f32, PHASE_COUNT>>) -> CloudLight {
    let matter = cloud_matter[sample.layer];
    let takeover_m = NEAR_CELLS * cell_m(level_of(sample.map));
    var radiance = vec3<f32>(0.0);
    var passed = 0.0;
#ifdef CLOUD_ORDINATES
    let rises = dot(view, sample.up) > 0.0;
    let straight = nearly_straight(sample, matter);
    passed = select(0.0, dot(matter.albedo, vec3<f32>(1.0 / 3.0)) * straight, rises);
    let place_m = vec3<f32>(sample.map, sample.altitude_m);
    let levels = levels_at(place_m);
    let to_sun = depth_to_light(sample, ORDINATES_LIGHT, NEAR_TEXELS * texel_width_m(levels));
    let local_view = vec3<f32>(view.xy, dot(view, sample.up));
    let solved = scattered_light(levels, place_m, local_view, exp(-matter.similarity * to_sun), table_sampler);
#endif
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let mu_s = dot(sample.up, observer.lights[light].direction);
#ifdef CLOUD_ORDINATES
        var to_light = to_sun;
        if light != ORDINATES_LIGHT {
            to_light = depth_to_light(sample, light, takeover_m);
        }
#else
        let to_light = depth_to_light(sample, light, takeover_m);
#endif
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
        // The sky is bright at the horizon, and brighter at the sun: it is taken from where it is known for every view.
        radiance += select(straight, 0.0, rises) * around.below;
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
    return CloudLight(matter.albedo * radiance, passed);
}
