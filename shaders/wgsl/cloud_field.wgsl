#define_import_path welkin::cloud_field
// From noise to the density of a layer of clouds: the chain that defines the field, as in welkin_lut::cloud.
//
// Legend
//   map        point of Lambert's equal-area map around the local frame's origin: east, north, m
//   u, v       the map's coordinates along a layer's stretch and across it, m
//   height     share of the layer's thickness, from its base;  up_m: the same in m
//   tiles      coordinates in which a tile of noise repeats after 1
// Interpolation is written out: a device's own filter has too few bits for the field to be the same everywhere.
//
// Definitions: CLOUD_LAYER_COUNT; CLOUD_ANVIL (some layer has one).

const CLOUD_LAYER_COUNT: u32 = #{CLOUD_LAYER_COUNT}u;
// WGSL has no empty arrays.
const CLOUD_LAYER_SLOTS: u32 = max(CLOUD_LAYER_COUNT, 1u);

// welkin_lut::cloud::CloudParameters says what each is.
struct CloudLayer {
    gradient: vec4<f32>,
    shape_per_m: vec3<f32>,
    base_m: f32,
    shape_offset: vec3<f32>,
    thickness_m: f32,
    erosion_offset: vec3<f32>,
    erosion_per_m: f32,
    weather_offset: vec2<f32>,
    along: vec2<f32>,
    weather_per_m: f32,
    sheet: f32,
    coverage_from: f32,
    coverage_slope: f32,
    anvil_from: f32,
    reach: f32,
    erosion: f32,
    curl_m: f32,
    edge: f32,
    water_at_base: f32,
    extinction_per_m: f32,
    padding: f32,
}

@group(1) @binding(0) var<storage, read> cloud_layers: array<CloudLayer, CLOUD_LAYER_SLOTS>;
@group(1) @binding(1) var cloud_shape_volume: texture_3d<f32>;
@group(1) @binding(2) var cloud_erosion_volume: texture_3d<f32>;
@group(1) @binding(3) var cloud_weather_map: texture_2d<f32>;
@group(1) @binding(4) var cloud_curl_map: texture_2d<f32>;

const SHAPE_TEXELS: i32 = 128;
const EROSION_TEXELS: i32 = 32;
const WEATHER_TEXELS: i32 = 512;
const CURL_TEXELS: i32 = 128;
// Tiles of the curl map along a tile of the weather map.
const CURL_TILES: f32 = 16.0;

struct Column {
    coverage: f32,
    anvil: f32,
    reach: f32,
}

// The map's coordinates of a point (east, north, up from the origin) above a sphere.
fn to_map(radius_m: f32, p: vec3<f32>) -> vec2<f32> {
    let up = radius_m + p.z;
    let r = length(vec3<f32>(p.xy, up));
    return p.xy * (radius_m * sqrt(2.0 / max(r * (r + up), 1e-20)));
}

fn along_and_across(layer: u32, map: vec2<f32>) -> vec2<f32> {
    let along = cloud_layers[layer].along;
    return vec2<f32>(dot(along, map), along.x * map.y - along.y * map.x);
}

// Interpolates two slices of quads of a volume.
fn volume(noise: texture_3d<f32>, texels: i32, tiles: vec3<f32>) -> f32 {
    let texel = fract(tiles) * f32(texels) - 0.5;
    let low = floor(texel);
    let share = texel - low;
    let first = vec3<i32>(low) & vec3<i32>(texels - 1);
    let near = textureLoad(noise, first, 0);
    let far = textureLoad(noise, vec3<i32>(first.xy, (first.z + 1) & (texels - 1)), 0);
    let quad = mix(near, far, share.z);
    let row = mix(quad.xz, quad.yw, share.x);
    return mix(row.x, row.y, share.y);
}

fn weather_at(layer: u32, uv: vec2<f32>) -> vec4<f32> {
    let tiles = uv * cloud_layers[layer].weather_per_m + cloud_layers[layer].weather_offset;
    let texel = fract(tiles) * f32(WEATHER_TEXELS) - 0.5;
    let low = floor(texel);
    let share = texel - low;
    let first = vec2<i32>(low) & vec2<i32>(WEATHER_TEXELS - 1);
    let next = (first + 1) & vec2<i32>(WEATHER_TEXELS - 1);
    let near = mix(
        textureLoad(cloud_weather_map, first, 0), textureLoad(cloud_weather_map, vec2<i32>(next.x, first.y), 0), share.x
    );
    let far = mix(
        textureLoad(cloud_weather_map, vec2<i32>(first.x, next.y), 0), textureLoad(cloud_weather_map, next, 0), share.x
    );
    return mix(near, far, share.y);
}

// The flow of the curl map, each component in [-1, 1].
fn flow_at(layer: u32, uv: vec2<f32>) -> vec2<f32> {
    let tiles = (uv * cloud_layers[layer].weather_per_m + cloud_layers[layer].weather_offset) * CURL_TILES;
    let texel = fract(tiles) * f32(CURL_TEXELS) - 0.5;
    let low = floor(texel);
    let share = texel - low;
    let first = vec2<i32>(low) & vec2<i32>(CURL_TEXELS - 1);
    let near = textureLoad(cloud_curl_map, first, 0);
    let far = textureLoad(cloud_curl_map, vec2<i32>(first.x, (first.y + 1) & (CURL_TEXELS - 1)), 0);
    let pair = mix(near, far, share.y);
    return 2.0 * mix(pair.xy, pair.zw, share.x) - 1.0;
}

fn column_of(layer: u32, weather: vec4<f32>) -> Column {
    let value = mix(weather.x, weather.y, cloud_layers[layer].sheet);
    let slope = cloud_layers[layer].coverage_slope;
    var column: Column;
    column.coverage = saturate((value - cloud_layers[layer].coverage_from) * slope);
#ifdef CLOUD_ANVIL
    column.anvil = saturate((value - cloud_layers[layer].anvil_from) * slope) * weather.w;
#endif
    column.reach = mix(cloud_layers[layer].reach, 1.0, column.coverage * (0.5 + 0.5 * weather.z));
    return column;
}

fn column_gradient(layer: u32, share: f32) -> f32 {
    let g = cloud_layers[layer].gradient;
    return min(saturate((share - g.x) * g.y), saturate((g.z - share) * g.w));
}

fn anvil_gradient(height: f32) -> f32 {
    return min(saturate((height - 0.76) / 0.08), saturate((1.0 - height) / 0.07));
}

fn erosion_at(layer: u32, place: vec3<f32>, height: f32) -> f32 {
    let shift_m = cloud_layers[layer].curl_m * (1.0 - height) * flow_at(layer, place.xy);
    let at = vec3<f32>(place.xy + shift_m, place.z) * cloud_layers[layer].erosion_per_m;
    let billows = volume(cloud_erosion_volume, EROSION_TEXELS, at + cloud_layers[layer].erosion_offset);
    let wisps = 1.0 - saturate(8.0 * height);
    return 1.0 - billows + (2.0 * billows - 1.0) * wisps;
}

// What there is of a layer before it is eroded; where this is not above 0 the layer is empty.
fn layer_body(layer: u32, map: vec2<f32>, altitude_m: f32) -> f32 {
    let up_m = altitude_m - cloud_layers[layer].base_m;
    let height = up_m / cloud_layers[layer].thickness_m;
    if !(height >= 0.0 && height <= 1.0) {
        return 0.0;
    }
    let uv = along_and_across(layer, map);
    let column = column_of(layer, weather_at(layer, uv));
    let gradient = column_gradient(layer, height / column.reach);
    var present = column.coverage * gradient;
#ifdef CLOUD_ANVIL
    let anvil = anvil_gradient(height);
    present += column.anvil * anvil;
#endif
    if present <= 0.0 {
        return 0.0;
    }
    let tiles = vec3<f32>(uv, up_m) * cloud_layers[layer].shape_per_m + cloud_layers[layer].shape_offset;
    let shape = volume(cloud_shape_volume, SHAPE_TEXELS, tiles);
    var body = shape * gradient + column.coverage - 1.0;
#ifdef CLOUD_ANVIL
    body = max(body, shape * anvil + column.anvil - 1.0);
#endif
    return body;
}

// What erosion leaves of a body above 0, as a density relative to the layer's extinction, in [0, 1].
fn eroded(layer: u32, map: vec2<f32>, altitude_m: f32, body: f32) -> f32 {
    let up_m = altitude_m - cloud_layers[layer].base_m;
    let height = up_m / cloud_layers[layer].thickness_m;
    let place = vec3<f32>(along_and_across(layer, map), up_m);
    let eaten = cloud_layers[layer].erosion * erosion_at(layer, place, height);
    let density = saturate(cloud_layers[layer].edge * max((body - eaten) / (1.0 - eaten), 0.0));
    return density * mix(cloud_layers[layer].water_at_base, 1.0, height);
}

// Density of a layer relative to its extinction, in [0, 1].
fn layer_density(layer: u32, map: vec2<f32>, altitude_m: f32) -> f32 {
    let body = layer_body(layer, map, altitude_m);
    if body <= 0.0 {
        return 0.0;
    }
    return eroded(layer, map, altitude_m, body);
}
