// Pass: the froxels, for every direction and light: two marches along each ray fill all of its slices, one those of
// multiply scattered light, the other those of light scattered once.
//
// A slice is integrated by two Gauss nodes, and cut where the whole ray is: at its lowest point and at the planet's
// shadow. What is stored is explained in welkin::aerial.
//
// Definitions: SLICE_COUNT.

#import welkin::aerial::{lit_share, lit_way, opacity_ratio, LitWay}
#import welkin::atmosphere::{atmosphere, densities, extinction_without_tents_at, SCATTERER_COUNT}
#import welkin::mapping
#import welkin::march::{
    altitude_at, cut_at_shadow, leg_end_m, local_directions, tents_between, view_ray, AirRay, LEG_COUNT, Node
}
#import welkin::observer::{light_mu_s, observer, LIGHT_COUNT}
#import welkin::sky::{multiple_scattering_table, LAYER_COUNT, MULTIPLE_LAYER, SINGLE_LAYER}
#import welkin::tables::{multiply_scattered_source, optical_depth_to_top}

@group(0) @binding(30) var froxel_light_image: texture_storage_3d<rgba16float, write>;

const SLICE_COUNT: u32 = #{SLICE_COUNT}u;
// Below this, light is dark.
const DARK: f32 = 1e-30;
// The range of ratios that are kept.
const SMALLEST: f32 = 1e-6;
const LARGEST: f32 = 1e4;
// Gauss-Legendre nodes on [0, 1], of equal weight.
const NODES: array<f32, 2> = array<f32, 2>(0.21132486540518712, 0.7886751345948129);

// Where a march stands, and what it has gathered: light as in the layers of the sky view.
struct March {
    distance_m: f32,
    // Without tents.
    extinction_per_m: vec3<f32>,
    tau: vec3<f32>,
    light: array<vec3<f32>, LAYER_COUNT>,
}

// Which layers of the sky view a march gathers: multiply scattered light, or light scattered once, whose slices differ.
const MULTIPLE: u32 = 0u;
const SINGLE: u32 = 1u;

// What a point sends towards the observer per metre, layer by layer.
fn sources(ray: AirRay, node: Node, dark: bool, kind: u32) -> array<vec3<f32>, LAYER_COUNT> {
    var source: array<vec3<f32>, LAYER_COUNT>;
    let local = local_directions(ray, node);
    var density = densities(node.altitude_m);
    if kind == SINGLE {
        if !dark {
            let lit = exp(-optical_depth_to_top(node.altitude_m, local.mu_s));
            for (var c = 0u; c < SCATTERER_COUNT; c++) {
                source[SINGLE_LAYER + c] = density[c] * atmosphere.constituents[c].scattering_per_m * lit;
            }
        }
        return source;
    }
#ifdef MULTIPLE_SCATTERING
    source[MULTIPLE_LAYER] = multiply_scattered_source(multiple_scattering_table, node.altitude_m, local, density);
#endif
    return source;
}

// Extinction without tents at a point of a stretch whose middle lies elsewhere: at its end a layer may end too, so a little inside.
fn extinction_within(ray: AirRay, at_m: f32, middle_m: f32) -> vec3<f32> {
#ifdef LAYERS
    return extinction_without_tents_at(altitude_at(ray, mix(at_m, middle_m, 1e-3)));
#else
    return extinction_without_tents_at(altitude_at(ray, at_m));
#endif
}

// Moves on and adds the optical depth of the way, by Simpson's rule.
fn move_to(march: ptr<function, March>, ray: AirRay, distance_m: f32) {
    let step_m = distance_m - (*march).distance_m;
    let middle_m = distance_m - 0.5 * step_m;
    let middle_altitude_m = altitude_at(ray, middle_m);
    let middle = extinction_without_tents_at(middle_altitude_m);
    let end = extinction_within(ray, distance_m, middle_m);
    (*march).tau += step_m / 6.0 * ((*march).extinction_per_m + 4.0 * middle + end);
    (*march).extinction_per_m = end;
    let ends_m = vec2<f32>((*march).distance_m, distance_m);
    let altitudes_m = vec2<f32>(altitude_at(ray, ends_m.x), altitude_at(ray, ends_m.y));
    (*march).tau += tents_between(ray, ends_m, step_m, altitudes_m, middle_altitude_m);
    (*march).distance_m = distance_m;
}

fn is_dark(ray: AirRay, distance_m: f32) -> bool {
    return distance_m > ray.shadow_m.x && distance_m < ray.shadow_m.y;
}

// Adds a stretch without kinks.
fn march_to(march: ptr<function, March>, ray: AirRay, end_m: f32, kind: u32) {
    let start_m = (*march).distance_m;
    let length_m = end_m - start_m;
    if length_m <= 0.0 {
        return;
    }
    let dark = is_dark(ray, start_m + 0.5 * length_m);
#ifdef LAYERS
    (*march).extinction_per_m = extinction_within(ray, start_m, start_m + 0.5 * length_m);
#endif
    var nodes = NODES;
    for (var n = 0u; n < 2u; n++) {
        let at_m = start_m + nodes[n] * length_m;
        move_to(march, ray, at_m);
        var source = sources(ray, Node(at_m, altitude_at(ray, at_m), 0.5 * length_m), dark, kind);
        let weight_m = 0.5 * length_m * exp(-(*march).tau);
        for (var k = 0u; k < LAYER_COUNT; k++) {
            (*march).light[k] += weight_m * source[k];
        }
    }
    move_to(march, ray, end_m);
}

// Part over whole; of nothing, nothing.
fn ratio(part: vec3<f32>, whole: vec3<f32>) -> vec3<f32> {
    let none = whole <= vec3<f32>(DARK);
    return select(part / select(whole, vec3<f32>(1.0), none), vec3<f32>(0.0), none);
}

// x, y: direction, of each light and each half of the view sphere.
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(froxel_light_image);
    if any(id.xy >= size.xy) {
        return;
    }
    let columns = vec2<u32>(size.x / LIGHT_COUNT, size.y / 2u);
    let light = id.x / columns.x;
    let below_horizon = id.y >= columns.y;
    let unit = mapping::unit_from_texel(id.xy % columns, vec2<f32>(columns));
    let view = mapping::sky_view_from_unit(unit, below_horizon, observer.view);
    let mu = cos(view.zenith_rad);
    let mu_s = light_mu_s(light);
    let sines = sin(view.zenith_rad) * sqrt(max(1.0 - mu_s * mu_s, 0.0));
    let nu = clamp(mu * mu_s + sines * cos(view.azimuth_rad), -1.0, 1.0);
    let ray = cut_at_shadow(view_ray(observer.altitude_m, mu, mu_s, nu, below_horizon));
    fill(id.xy, ray, MULTIPLE);
    fill(id.xy, ray, SINGLE);
}

// Where a slice lies on a ray, m. At the ray's start light and what is expected of it vanish: the first slice holds their
// ratio after a metre, or a thousandth of the way.
fn slice_distance_m(slice: u32, slices: mapping::Slices, way: LitWay, kind: u32) -> f32 {
    let nearest_m = min(1.0, 1e-3 * slices.length_m);
    let along_m = max(mapping::slice_distance_m(f32(slice) / f32(SLICE_COUNT - 1u), slices), nearest_m);
    if kind == MULTIPLE {
        return along_m;
    }
    return way.start_m + along_m;
}

// How much of the light before a slice one expects by its opacity alone, over that of the whole ray.
fn expected_share(tau: vec3<f32>, whole: vec3<f32>, at_m: f32, length_m: f32, way: LitWay, kind: u32) -> vec3<f32> {
    let share = opacity_ratio(tau, whole, at_m / length_m);
    if kind == MULTIPLE {
        return share;
    }
    return share * lit_share(at_m, length_m, way);
}

// Marches along a ray and stores all slices of the layers of one kind.
fn fill(place: vec2<u32>, ray: AirRay, kind: u32) {
    // A ray that only touches the air has a length yet, so that its neighbours have something to interpolate with.
    let length_m = max(ray.length_m, 1e-3);
    let way = lit_way(ray);
    var slices = mapping::slices_of(length_m, ray.tangent_m);
    if kind == SINGLE {
        slices = way.slices;
    }
    var march: March;
    march.extinction_per_m = extinction_without_tents_at(ray.altitude_m);
    var light_before: array<array<vec3<f32>, LAYER_COUNT>, SLICE_COUNT>;
    var expected: array<vec3<f32>, SLICE_COUNT>;
    var tau_before: array<vec3<f32>, SLICE_COUNT>;
    for (var slice = 0u; slice < SLICE_COUNT; slice++) {
        let end_m = slice_distance_m(slice, slices, way, kind);
        for (var cut = 0u; cut < LEG_COUNT; cut++) {
            march_to(&march, ray, min(leg_end_m(ray, cut), end_m), kind);
        }
        light_before[slice] = march.light;
        tau_before[slice] = march.tau;
    }
    // The rest of the ray, where the planet's shadow ends it.
    march_to(&march, ray, ray.length_m, kind);
    for (var slice = 0u; slice < SLICE_COUNT; slice++) {
        let at_m = slice_distance_m(slice, slices, way, kind);
        expected[slice] = expected_share(tau_before[slice], march.tau, at_m, length_m, way, kind);
    }
    let first_layer = select(MULTIPLE_LAYER, SINGLE_LAYER, kind == SINGLE);
    let last_layer = select(MULTIPLE_LAYER + 1u, LAYER_COUNT, kind == SINGLE);
    for (var slice = 0u; slice < SLICE_COUNT; slice++) {
        let over_expected = ratio(vec3<f32>(1.0), expected[slice]);
        for (var k = first_layer; k < last_layer; k++) {
            let relative = ratio(light_before[slice][k], march.light[k]) * over_expected;
            let value = log(clamp(relative, vec3<f32>(SMALLEST), vec3<f32>(LARGEST)));
            textureStore(froxel_light_image, vec3<u32>(place, k * SLICE_COUNT + slice), vec4<f32>(value, 0.0));
        }
    }
}
