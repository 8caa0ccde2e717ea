#define_import_path welkin::cloud_way
// Optical depth of clouds along a straight way from a place of the map, as lamps are seen.
//
// Definitions: LOCAL_LIGHT_SAMPLES.

#import welkin::atmosphere::atmosphere
#import welkin::cloud_field::{cloud_layers, layer_density, CLOUD_LAYER_COUNT}

// Clouds change from place to place as no volume does: points on the way, for each that an uneven volume gets.
const SAMPLES: u32 = 6u * #{LOCAL_LIGHT_SAMPLES}u;

// Distances between which a way that climbs with this slope lies between two altitudes, m. That the ground curves away within it is
// left out.
fn span_m(altitude_m: f32, slope: f32, way_m: f32, base_m: f32, top_m: f32) -> vec2<f32> {
    let steep = select(slope, 1e-6, abs(slope) < 1e-6);
    let at_base_m = (base_m - altitude_m) / steep;
    let at_top_m = (top_m - altitude_m) / steep;
    return clamp(vec2<f32>(min(at_base_m, at_top_m), max(at_base_m, at_top_m)), vec2<f32>(0.0), vec2<f32>(way_m));
}

// `local` is the direction as east, north and up of the way's start.
fn cloud_depth(map: vec2<f32>, altitude_m: f32, local: vec3<f32>, way_m: f32) -> f32 {
    var depth = 0.0;
    // The mean slope of a way above ground that curves away.
    let slope = local.z + 0.5 * way_m / atmosphere.radius_m;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let base_m = cloud_layers[layer].base_m;
        let span = span_m(altitude_m, slope, way_m, base_m, base_m + cloud_layers[layer].thickness_m);
        let step_m = (span.y - span.x) / f32(SAMPLES);
        if step_m <= 0.0 {
            continue;
        }
        var density = 0.0;
        for (var i = 0u; i < SAMPLES; i++) {
            let t_m = span.x + step_m * (f32(i) + 0.5);
            density += layer_density(layer, map + local.xy * t_m, altitude_m + slope * t_m);
        }
        depth += cloud_layers[layer].extinction_per_m * density * step_m;
    }
    return depth;
}
