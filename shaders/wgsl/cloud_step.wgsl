#define_import_path welkin::cloud_step
// A march's step through clouds: all layers at a point.

#import welkin::cloud_field::{cloud_layers, eroded, layer_body, layer_density, CLOUD_LAYER_COUNT, CLOUD_LAYER_SLOTS}
#import welkin::cloud_skip::gap_m
#import welkin::cloud_source::{step_light, CloudLight, Sample, PHASE_COUNT}

fn is_inside(layer: u32, altitude: f32) -> bool {
    let up_m = altitude - cloud_layers[layer].base_m;
    return up_m >= 0.0 && up_m <= cloud_layers[layer].thickness_m;
}

fn is_in_clouds(altitude: f32) -> bool {
    var inside = false;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        inside = inside || is_inside(layer, altitude);
    }
    return inside;
}

fn layer_extinction(layer: u32, map: vec2<f32>, altitude: f32) -> f32 {
    return cloud_layers[layer].extinction_per_m * layer_density(layer, map, altitude);
}

// A distance along a ray from a point, m, in which it meets nothing of the layers that hold an altitude `within`: at a boundary the
// point's own may be rounded to the wrong side.
fn gap_of_layers_m(map: vec2<f32>, altitude: f32, rise: f32, within: f32) -> f32 {
    var least_m = 1e30;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if is_inside(layer, within) {
            least_m = min(least_m, gap_m(layer, map, altitude, rise));
        }
    }
    return least_m;
}

// What there is of each layer at a point before erosion.
fn bodies_at(map: vec2<f32>, altitude: f32) -> array<f32, CLOUD_LAYER_SLOTS> {
    var bodies: array<f32, CLOUD_LAYER_SLOTS>;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        bodies[layer] = layer_body(layer, map, altitude);
    }
    return bodies;
}

fn is_any_above_zero(bodies: ptr<function, array<f32, CLOUD_LAYER_SLOTS>>) -> bool {
    var is_any = false;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        is_any = is_any || (*bodies)[layer] > 0.0;
    }
    return is_any;
}

// What erosion leaves of them.
fn extinction_of(bodies: ptr<function, array<f32, CLOUD_LAYER_SLOTS>>, map: vec2<f32>, altitude: f32) -> f32 {
    var extinction = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let body = (*bodies)[layer];
        if body > 0.0 {
            extinction += cloud_layers[layer].extinction_per_m * eroded(layer, map, altitude, body);
        }
    }
    return extinction;
}

fn cloud_extinction(map: vec2<f32>, altitude: f32) -> f32 {
    var extinction = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if is_inside(layer, altitude) {
            extinction += layer_extinction(layer, map, altitude);
        }
    }
    return extinction;
}

// Where a step looks, and what clouds hide before it and in it, as optical depths.
struct CloudStep {
    map: vec2<f32>,
    altitude_m: f32,
    // Unit vector from the planet's centre.
    up: vec3<f32>,
    extinction: f32,
    before: f32,
    within: f32,
}

// Light of the clouds in a step, before the air.
fn from_clouds(step: CloudStep, view: vec3<f32>, phase: ptr<function, array<f32, PHASE_COUNT>>) -> CloudLight {
    var sample: Sample;
    sample.map = step.map;
    sample.altitude_m = step.altitude_m;
    sample.up = step.up;
    sample.before = step.before;
    sample.step = step.within;
    var light: CloudLight;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if is_inside(layer, step.altitude_m) {
            sample.layer = layer;
            sample.height = (step.altitude_m - cloud_layers[layer].base_m) / cloud_layers[layer].thickness_m;
#if CLOUD_LAYER_COUNT > 1
            let share = layer_extinction(layer, step.map, step.altitude_m) / step.extinction;
            let part = step_light(sample, view, phase);
            light.radiance += share * part.radiance;
            light.passed += share * part.passed;
#else
            light = step_light(sample, view, phase);
#endif
        }
    }
    return light;
}
