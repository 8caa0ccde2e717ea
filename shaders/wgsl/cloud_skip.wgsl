#define_import_path welkin::cloud_skip
// How far from a point a layer of clouds is certainly empty: welkin_lut::cloud::CloudBounds on the device.

#import welkin::cloud_field::{along_and_across, cloud_layers, column_of}

@group(1) @binding(5) var cloud_shape_bounds: texture_3d<f32>;
@group(1) @binding(6) var cloud_weather_bounds: texture_2d<f32>;

const SHAPE_BLOCKS: f32 = 16.0;
const WEATHER_BLOCKS: f32 = 64.0;
// What a step may use of a block's length: rounding, and the map's stretching of lengths.
const MARGIN: f32 = 0.85;
// Height at which anvils begin.
const ANVIL_FROM: f32 = 0.76;

// A distance, m, in every direction within which a layer is empty; 0 where it need not be.
fn empty_m(layer: u32, map: vec2<f32>, altitude_m: f32) -> f32 {
    let uv = along_and_across(layer, map);
    let weather_tiles = fract(uv * cloud_layers[layer].weather_per_m + cloud_layers[layer].weather_offset);
    let column = column_of(layer, textureLoad(cloud_weather_bounds, vec2<u32>(weather_tiles * WEATHER_BLOCKS), 0));
    let weather_m = MARGIN / (cloud_layers[layer].weather_per_m * WEATHER_BLOCKS);
    if column.coverage + column.anvil <= 0.0 {
        return weather_m;
    }
    let shape_per_m = cloud_layers[layer].shape_per_m;
    let finest = max(max(shape_per_m.x, shape_per_m.y), shape_per_m.z) * SHAPE_BLOCKS;
    let reach_m = min(MARGIN / finest, weather_m);
    let up_m = altitude_m - cloud_layers[layer].base_m;
    let inside = (up_m - reach_m) <= column.reach * cloud_layers[layer].gradient.z * cloud_layers[layer].thickness_m;
    let place = fract(vec3<f32>(uv, up_m) * shape_per_m + cloud_layers[layer].shape_offset);
    let shape = textureLoad(cloud_shape_bounds, vec3<u32>(place * SHAPE_BLOCKS), 0).x;
    var body = select(0.0, shape + column.coverage - 1.0, inside);
#ifdef CLOUD_ANVIL
    if up_m + reach_m >= ANVIL_FROM * cloud_layers[layer].thickness_m {
        body = max(body, shape + column.anvil - 1.0);
    }
#endif
    return select(0.0, reach_m, body <= 0.0);
}
