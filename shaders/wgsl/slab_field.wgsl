#define_import_path welkin::slab_field
// Diffuse light in a layer that is wide and even, such as fog, over ground that reflects: tables over the optical depths above and
// below a place, as welkin_lut::slab_field solves for them.
//
// Legend
//   depth      optical depth of the similar medium, which scatters light from its line
//   table      of one bank of fog and one source of light, a beam or the sky: per flux of 1 through a horizontal plane above
//
// Definitions: LIGHT_COUNT.

#import welkin::observer::LIGHT_COUNT

// Bank by bank the lights' tables, then the sky's. In each, for depths above and depths below, which come faster: mean radiance,
// net flux upwards and along; then for depths above alone the flux downwards on the ground.
@group(1) @binding(67) var<storage, read> slab_fields: array<vec4<f32>>;

// welkin_lut::slab_field has the same numbers.
const DEPTHS: u32 = 24u;
const NEAR_DEPTH: f32 = 0.05;
// ln(1 + 60 / 0.05), from the first node to the last.
const LOG_DEPTHS: f32 = 7.09090982;
const OF_PAIR: u32 = 3u;
const TABLE: u32 = (OF_PAIR * DEPTHS + 1u) * DEPTHS;

// Sine of the elevation as which a lower light counts.
const LOWEST_SUN: f32 = 0.02;

struct SlabLight {
    mean_radiance: vec3<f32>,
    // Net flux upwards.
    upward: vec3<f32>,
    // Net flux along the layer, in the direction in which the beam goes.
    along: vec3<f32>,
}

// Where a table is looked up: its nodes above and below, as whole and part.
struct SlabSpot {
    above: f32,
    below: f32,
}

fn node_of(depth: f32) -> f32 {
    return min(log(1.0 + max(depth, 0.0) / NEAR_DEPTH) / LOG_DEPTHS, 1.0) * f32(DEPTHS - 1u);
}

fn slab_spot(above: f32, below: f32) -> SlabSpot {
    return SlabSpot(node_of(above), node_of(below));
}

// The table of a light in a bank of fog; LIGHT_COUNT in its place stands for the sky.
fn slab_table(bank: u32, light: u32) -> u32 {
    return (bank * (LIGHT_COUNT + 1u) + light) * TABLE;
}

fn between_below(first: u32, t: f32) -> SlabLight {
    return SlabLight(
        mix(slab_fields[first].rgb, slab_fields[first + OF_PAIR].rgb, t),
        mix(slab_fields[first + 1u].rgb, slab_fields[first + OF_PAIR + 1u].rgb, t),
        mix(slab_fields[first + 2u].rgb, slab_fields[first + OF_PAIR + 2u].rgb, t),
    );
}

fn slab_light(table: u32, spot: SlabSpot) -> SlabLight {
    let above = min(u32(spot.above), DEPTHS - 2u);
    let below = min(u32(spot.below), DEPTHS - 2u);
    let first = table + OF_PAIR * (above * DEPTHS + below);
    let near = between_below(first, spot.below - f32(below));
    let far = between_below(first + OF_PAIR * DEPTHS, spot.below - f32(below));
    let t = spot.above - f32(above);
    return SlabLight(
        mix(near.mean_radiance, far.mean_radiance, t),
        mix(near.upward, far.upward, t),
        mix(near.along, far.along, t),
    );
}

// Diffuse flux downwards on the ground below a depth.
fn slab_on_ground(table: u32, spot: SlabSpot) -> vec3<f32> {
    let above = min(u32(spot.above), DEPTHS - 2u);
    let first = table + OF_PAIR * DEPTHS * DEPTHS + above;
    return mix(slab_fields[first].rgb, slab_fields[first + 1u].rgb, spot.above - f32(above));
}
