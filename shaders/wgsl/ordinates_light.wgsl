#define_import_path welkin::ordinates_light
// The light that the passes `ordinates_*` have found in clouds, for view rays.
//
//   let light = scattered_light(levels_at(place_m), place_m, view, beam, linear_sampler);
//   radiance += (light.x * sun_irradiance + light.y * sky_radiance) * albedo * q * int c e^(-q tau) ds
//
// with beam = e^(-q tau_sun), q = 1 - f of the droplets, c the true extinction and tau the true optical depth along the view so far. The sun's
// light that was scattered by small angles only is not part of it: add the bands of passes::ordinates::coefficients.
//
// Light of the sky behind the clouds that droplets scatter by small angles only is neither: of a smooth radiance L behind them,
// they let L e^(-q tau) pass in place of L e^(-tau).
//
// Cells are wide and clouds' lit sides are not: a view ray knows its own depth to the sun, d, and the texels theirs, D. Light
// falls into clouds about as 1 / (1 + a d), so that it is (1 + a D) / (1 + a d) times the texels' where both are scattered.
//
// What wide cells lack, light that leaves sharp edges too easily, grows with their width. The next level, twice as wide, tells
// how much it is: light is to its light there as cells of no width would be to this level (Richardson's extrapolation, of
// logarithms, so that light stays positive).
//
// Beyond a few texels D itself serves a view ray for d: `depth_to_sun`. Texels have the extinction with which lumps let light
// through between them: they dim less than their mean extinction would.
//
// Legend and definitions: those of welkin::ordinates_grid.

#import welkin::ordinates_grid::{coordinates, highest_m, level_of, ordinates, weight_of, LEVEL_COUNT, REFINEMENT}

@group(2) @binding(1) var ordinates_sunlight: texture_3d<f32>;
@group(2) @binding(2) var ordinates_skylight: texture_3d<f32>;
@group(2) @binding(3) var ordinates_beam: texture_3d<f32>;
@group(2) @binding(4) var ordinates_extinction: texture_3d<f32>;
@group(2) @binding(5) var ordinates_depth: texture_3d<f32>;

// Share of a level's half width within which it counts alone; outside it gives way to the next.
const INNER: f32 = 0.85;

// The light differs from the texels' by no more than this factor.
const MOST: f32 = 4.0;

// Nor do cells of no width from a level's by more than this one.
const MOST_REFINED: f32 = 2.0;

const FOUR_PI: f32 = 12.5663706143592;

// b' / c' (I0 - g' view . I1) of sun and sky, not negative. Light travels along the directions of I1, views against it.
// The texels hold what is linear inside an opaque cloud; ordinates_moments.wgsl says how the beam is a part of it.
fn scattered_from(level: u32, place_m: vec3<f32>, view: vec3<f32>, beam: f32, linear: sampler) -> vec2<f32> {
    let at = coordinates(place_m, level, vec3<f32>(textureDimensions(ordinates_sunlight)), f32(REFINEMENT));
    let weight = weight_of(textureSampleLevel(ordinates_extinction, linear, at, 0.0).x);
    let falling = textureSampleLevel(ordinates_beam, linear, at, 0.0) / weight;
    let in_beam = 3.0 * beam * ordinates.albedo / FOUR_PI * vec4<f32>(falling.xyz, -falling.w);
    let depth = textureSampleLevel(ordinates_depth, linear, at, 0.0).x;
    let own_depth = -log(max(beam, 1e-30));
    let nearer = clamp((1.0 + ordinates.falloff * depth) / (1.0 + ordinates.falloff * own_depth), 1.0 / MOST, MOST);
    let sun = nearer * textureSampleLevel(ordinates_sunlight, linear, at, 0.0) / weight + in_beam;
    let sky = textureSampleLevel(ordinates_skylight, linear, at, 0.0) / weight;
    let along = vec2<f32>(dot(view, sun.xyz), dot(view, sky.xyz));
    return max(vec2<f32>(sun.w, sky.w) - ordinates.reduced_cosine * along, vec2<f32>(0.0));
}

// Which levels count at a place: one, and with the share `outward` the next. Beyond the outermost level that level's edge is
// repeated.
struct Levels {
    inner: u32,
    outward: f32,
}

fn levels_at(place_m: vec3<f32>) -> Levels {
    let level = min(level_of(place_m), LEVEL_COUNT - 1u);
    let box = ordinates.levels[level];
    let half_m = 0.5 * vec2<f32>(box.size.xy) * box.cell_m.xy;
    let from_middle = abs(place_m.xy - box.lowest_m.xy - half_m) / half_m;
    let outward = saturate((max(from_middle.x, from_middle.y) - INNER) / (1.0 - INNER));
    return Levels(level, select(outward, 0.0, level + 1u == LEVEL_COUNT));
}

// The same as cells of no width would have it; of the outermost level, which no other is wider than, its own.
fn refined_from(level: u32, place_m: vec3<f32>, view: vec3<f32>, beam: f32, linear: sampler) -> vec2<f32> {
    let light = scattered_from(level, place_m, view, beam, linear);
    if level + 1u == LEVEL_COUNT {
        return light;
    }
    let wider = scattered_from(level + 1u, place_m, view, beam, linear);
    let ratio = light / max(wider, vec2<f32>(1e-20));
    return light * clamp(ratio, vec2<f32>(1.0 / MOST_REFINED), vec2<f32>(MOST_REFINED));
}

// Light of the sun per unit irradiance (1/sr) and of a sky of radiance 1 that the similar medium scatters into a view
// ray, per unit of its scattering.
fn scattered_light(levels: Levels, place_m: vec3<f32>, view: vec3<f32>, beam: f32, linear: sampler) -> vec2<f32> {
    let light = refined_from(levels.inner, place_m, view, beam, linear);
    if levels.outward <= 0.0 {
        return light;
    }
    return mix(light, refined_from(levels.inner + 1u, place_m, view, beam, linear), levels.outward);
}

// Width of the texels of levels, m.
fn texel_width_m(levels: Levels) -> f32 {
    // Each level's are twice as wide as those of the one inside it.
    return ordinates.levels[levels.inner].cell_m.x / f32(REFINEMENT) * (1.0 + levels.outward);
}

fn depth_from(level: u32, place_m: vec3<f32>, linear: sampler) -> f32 {
    let at = coordinates(place_m, level, vec3<f32>(textureDimensions(ordinates_depth)), f32(REFINEMENT));
    return textureSampleLevel(ordinates_depth, linear, at, 0.0).x;
}

// Optical depth of the similar medium from a place to the sun. Above and below all clouds there is none.
fn depth_to_sun(place_m: vec3<f32>, linear: sampler) -> f32 {
    let levels = levels_at(place_m);
    if place_m.z > highest_m(levels.inner).z || place_m.z < ordinates.levels[levels.inner].lowest_m.z {
        return 0.0;
    }
    let depth = depth_from(levels.inner, place_m, linear);
    if levels.outward <= 0.0 {
        return depth;
    }
    return mix(depth, depth_from(levels.inner + 1u, place_m, linear), levels.outward);
}
