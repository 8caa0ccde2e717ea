#define_import_path welkin::slab_field
// Diffuse light in a layer that is wide and even, such as fog, over ground that reflects: tables over the optical depths above and
// below a place, as welkin_lut::slab_field solves for them.
//
// Legend
//   depth      optical depth of the similar medium, which scatters light from its line
//   table      of one bank of fog and one source of light, a beam or the sky: per flux of 1 through a horizontal plane above
//   way        the direction in which light goes: its elevation, and its azimuth from the beam's
//
// Definitions: LIGHT_COUNT.

#import welkin::observer::LIGHT_COUNT

// Bank by bank the lights' tables, then the sky's. In each, for depths above, depths below, elevations and azimuths, ever faster, what
// matter scatters; then for depths above alone the flux downwards on the ground, and for depths below alone the mean radiance upwards.
@group(1) @binding(67) var<storage, read> slab_fields: array<vec4<f32>>;

// welkin_lut::slab_field has the same numbers.
const DEPTHS: u32 = 24u;
const NEAR_DEPTH: f32 = 0.05;
// ln(1 + 60 / 0.05), from the first node to the last.
const LOG_DEPTHS: f32 = 7.09090982;
const ELEVATIONS: u32 = 17u;
const AZIMUTHS: u32 = 13u;
const PAIRS: u32 = DEPTHS * DEPTHS;
const BEAM_TABLE: u32 = PAIRS * ELEVATIONS * AZIMUTHS + 2u * DEPTHS;
const SKY_TABLE: u32 = PAIRS * ELEVATIONS + 2u * DEPTHS;
const PI: f32 = 3.14159265;

// Sine of the elevation as which a lower light counts.
const LOWEST_SUN: f32 = 0.02;

// Where a table is looked up: its nodes above and below, as whole and part.
struct SlabSpot {
    above: f32,
    below: f32,
}

// The same of a way.
struct SlabWay {
    elevation: f32,
    azimuth: f32,
}

fn node_of(depth: f32) -> f32 {
    return min(log(1.0 + max(depth, 0.0) / NEAR_DEPTH) / LOG_DEPTHS, 1.0) * f32(DEPTHS - 1u);
}

fn slab_spot(above: f32, below: f32) -> SlabSpot {
    return SlabSpot(node_of(above), node_of(below));
}

// Of light that goes up with this sine, at an azimuth of this cosine.
fn slab_way(upward: f32, cos_azimuth: f32) -> SlabWay {
    return SlabWay(
        (asin(clamp(upward, -1.0, 1.0)) / PI + 0.5) * f32(ELEVATIONS - 1u),
        acos(clamp(cos_azimuth, -1.0, 1.0)) / PI * f32(AZIMUTHS - 1u),
    );
}

fn bank_of(bank: u32) -> u32 {
    return bank * (LIGHT_COUNT * BEAM_TABLE + SKY_TABLE);
}

// Where the table of a light in a bank of fog begins.
fn beam_table(bank: u32, light: u32) -> u32 {
    return bank_of(bank) + light * BEAM_TABLE;
}

fn sky_table(bank: u32) -> u32 {
    return bank_of(bank) + LIGHT_COUNT * BEAM_TABLE;
}

// Between two texels so far apart.
fn between_texels(first: u32, apart: u32, t: f32) -> vec3<f32> {
    return mix(slab_fields[first].rgb, slab_fields[first + apart].rgb, t);
}

// Of the texels of a pair of depths, of which rows of elevations are so long.
fn along_way(first: u32, way: SlabWay, row: u32) -> vec3<f32> {
    let elevation = min(u32(way.elevation), ELEVATIONS - 2u);
    let azimuth = min(u32(way.azimuth), AZIMUTHS - 2u);
    let low = first + elevation * row;
    if row == 1u {
        return between_texels(low, row, way.elevation - f32(elevation));
    }
    return mix(
        between_texels(low + azimuth, 1u, way.azimuth - f32(azimuth)),
        between_texels(low + azimuth + row, 1u, way.azimuth - f32(azimuth)),
        way.elevation - f32(elevation)
    );
}

fn scattered_by_slab(table: u32, spot: SlabSpot, way: SlabWay, row: u32) -> vec3<f32> {
    let above = min(u32(spot.above), DEPTHS - 2u);
    let below = min(u32(spot.below), DEPTHS - 2u);
    let pair = ELEVATIONS * row;
    let first = table + (above * DEPTHS + below) * pair;
    let near = mix(along_way(first, way, row), along_way(first + pair, way, row), spot.below - f32(below));
    let next = first + DEPTHS * pair;
    let far = mix(along_way(next, way, row), along_way(next + pair, way, row), spot.below - f32(below));
    return mix(near, far, spot.above - f32(above));
}

// Radiance over the similar medium's scattering coefficient, of light of a beam and of the sky that was turned away before.
fn scattered_of_beam(table: u32, spot: SlabSpot, way: SlabWay) -> vec3<f32> {
    return scattered_by_slab(table, spot, way, AZIMUTHS);
}

fn scattered_of_sky(table: u32, spot: SlabSpot, way: SlabWay) -> vec3<f32> {
    return scattered_by_slab(table, spot, way, 1u);
}

// Diffuse flux downwards on the ground below a depth; `row` as above.
fn slab_on_ground(table: u32, spot: SlabSpot, row: u32) -> vec3<f32> {
    let above = min(u32(spot.above), DEPTHS - 2u);
    return between_texels(table + PAIRS * ELEVATIONS * row + above, 1u, spot.above - f32(above));
}

// Mean radiance upwards above a depth.
fn slab_above(table: u32, spot: SlabSpot, row: u32) -> vec3<f32> {
    let below = min(u32(spot.below), DEPTHS - 2u);
    return between_texels(table + PAIRS * ELEVATIONS * row + DEPTHS + below, 1u, spot.below - f32(below));
}
